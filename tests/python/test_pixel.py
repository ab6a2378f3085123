"""Packed pixels: against NumPy's own half, there and back, and counts of what did not fit."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import etendue
from etendue import pixel

RANGE = 64.0
FORMATS: list[tuple[Callable[..., Any], Callable[..., Any], float]] = [
    # The largest error of a channel, of the brightest one.
    (pixel.pack_r11g11b10f, pixel.unpack_r11g11b10f, 1.0 / 64),
    (pixel.pack_rgb9e5, pixel.unpack_rgb9e5, 1.0 / 512),
    (pixel.pack_rgbe, pixel.unpack_rgbe, 1.0 / 256),
    (lambda p: pixel.pack_rgbm(p, RANGE), lambda c: pixel.unpack_rgbm(c, RANGE), 1.0 / 100),
    (lambda p: pixel.pack_rgbd(p, RANGE), lambda c: pixel.unpack_rgbd(c, RANGE), 1.0 / 100),
    # u', v' in steps of 1/410, of which Rec.709's channels make up to 8 times as much.
    (pixel.pack_logluv, pixel.unpack_logluv, 8.0 / 410),
]


def pixels(dtype: Any) -> Any:
    return np.random.default_rng(7).uniform(0.3, 1, (6, 11, 3)).astype(dtype)


@pytest.mark.parametrize(("pack", "unpack", "error"), FORMATS)
def test_there_and_back(pack: Callable[..., Any], unpack: Callable[..., Any], error: float) -> None:
    for dtype in [np.float32, np.float64]:
        given = pixels(dtype)
        codes, lost = pack(given)
        assert lost == (0, 0, 0)
        back = unpack(codes)
        assert back.shape == given.shape
        assert back.dtype == np.float32
        assert np.max(np.abs(back - given)) <= error
        again, _ = pack(back)
        assert codes.shape == again.shape


def test_ten_bits() -> None:
    codes, lost = pixel.pack_rgb10a2(np.array([[1.0, 0.5, 0.0], [2.0, -1.0, 0.0]]))
    assert codes.tolist() == [3 << 30 | 512 << 10 | 1023, 3 << 30 | 1023]
    assert lost == pixel.PackCounts(nan=0, negative=1, overflow=1)


def test_half_is_numpys() -> None:
    every = np.arange(65536, dtype=np.uint16)
    finite = every[np.isfinite(every.view(np.float16))]
    assert np.array_equal(pixel.unpack_half(finite), finite.view(np.float16).astype(np.float32))
    numbers = np.random.default_rng(3).uniform(-70000, 70000, 10001)
    numbers = numbers[np.abs(numbers) < 65504]
    for dtype in [np.float32, np.float64]:
        codes, lost = pixel.pack_half(numbers.astype(dtype))
        assert np.array_equal(codes, numbers.astype(dtype).astype(np.float16).view(np.uint16))
        assert lost == (0, 0, 0)


def test_what_does_not_fit_is_counted() -> None:
    codes, lost = pixel.pack_rgb9e5(np.array([[np.nan, -1, 1e6], [1, 2, np.inf]], np.float32))
    assert lost == pixel.PackCounts(nan=1, negative=1, overflow=2)
    assert pixel.unpack_rgb9e5(codes).tolist()[0] == [0, 0, 65408]
    assert pixel.pack_half(np.array([1e9, -1e9, np.nan]))[1] == pixel.PackCounts(nan=1, negative=0, overflow=2)


def test_double_is_rounded_once() -> None:
    # Just above the tie between two halves; as a float it is the tie itself, and would be rounded to even.
    above = 1 + 2.0**-11 + 2.0**-40
    assert pixel.pack_half(np.array([above]))[0][0] == pixel.pack_half(np.array([1 + 2.0**-10]))[0][0]


def test_what_is_refused() -> None:
    for dtype in [np.float32, np.float64]:
        with pytest.raises(etendue.Error) as caught:
            pixel.pack_rgbm(pixels(dtype), 0)
        assert caught.value.code == "RANGE_INVALID"
    with pytest.raises(etendue.Error, match=r"3 channels .*\(4, 2\)"):
        pixel.pack_rgbe(np.zeros((4, 2)))
    with pytest.raises(etendue.Error, match="codes of uint32, found uint16"):
        pixel.unpack_rgb9e5(np.zeros(4, np.uint16))
