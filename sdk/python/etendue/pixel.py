"""Packed HDR pixel formats: what a texture or a file stores, bit for bit, and what it could not store.

Pixels are arrays of float32 or float64 with 3 channels (half: any shape) in linear light; each is rounded once to what the format holds.
Stored instead of what does not fit: 0 for NaN and, where a format has no sign, for negative numbers; the largest finite number for what is
larger. The counts of these come with the codes. What is read is float32.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._arrays import as_array
from .errors import Error


class PackCounts(NamedTuple):
    """How many channels a format could not hold."""

    nan: int
    negative: int
    overflow: int


def _packed(kernel: Callable[..., Any], pixels: ArrayLike, channels: int, *extra: float) -> Any:
    array = as_array(pixels, "pixels")
    if channels > 1 and (array.ndim == 0 or array.shape[-1] != channels):
        raise Error("SHAPE_MISMATCH", f"expected pixels of {channels} channels in the last extent, found {array.shape}", field="pixels")
    codes, counts = kernel(np.ascontiguousarray(array), *extra)
    return codes, PackCounts(*counts)


def _unpacked(kernel: Callable[..., Any], codes: Any, dtype: type, *extra: float) -> Any:
    array = np.asarray(codes)
    if array.dtype != dtype or (dtype is np.uint8 and (array.ndim == 0 or array.shape[-1] != 4)):
        expected = "bytes, 4 in the last extent" if dtype is np.uint8 else np.dtype(dtype).name
        raise Error("SHAPE_MISMATCH", f"expected codes of {expected}, found {array.dtype.name} of shape {array.shape}", field="codes")
    return kernel(np.ascontiguousarray(array), *extra)


def pack_half(pixels: ArrayLike) -> tuple[NDArray[np.uint16], PackCounts]:
    """IEEE 754 binary16, to nearest, ties to even; up to 65504. The codes viewed as float16 are the numbers."""
    return _packed(_core.pack_half, pixels, 1)  # type: ignore[no-any-return]


def unpack_half(codes: NDArray[np.uint16]) -> NDArray[np.float32]:
    """Half to float32, exactly."""
    return _unpacked(_core.unpack_half, codes, np.uint16)  # type: ignore[no-any-return]


def pack_r11g11b10f(pixels: ArrayLike) -> tuple[NDArray[np.uint32], PackCounts]:
    """Unsigned floats of 11, 11 and 10 bits, red lowest, to nearest, ties to even; up to 65024, 65024, 64512."""
    return _packed(_core.pack_r11g11b10f, pixels, 3)  # type: ignore[no-any-return]


def unpack_r11g11b10f(codes: NDArray[np.uint32]) -> NDArray[np.float32]:
    """R11G11B10F to float32, exactly."""
    return _unpacked(_core.unpack_r11g11b10f, codes, np.uint32)  # type: ignore[no-any-return]


def pack_rgb9e5(pixels: ArrayLike) -> tuple[NDArray[np.uint32], PackCounts]:
    """Nine bits a channel and a shared exponent of five, rounded as EXT_texture_shared_exponent says; up to 65408."""
    return _packed(_core.pack_rgb9e5, pixels, 3)  # type: ignore[no-any-return]


def unpack_rgb9e5(codes: NDArray[np.uint32]) -> NDArray[np.float32]:
    """RGB9E5 to float32, exactly."""
    return _unpacked(_core.unpack_rgb9e5, codes, np.uint32)  # type: ignore[no-any-return]


def pack_rgbe(pixels: ArrayLike) -> tuple[NDArray[np.uint8], PackCounts]:
    """Radiance's RGBE, four bytes: written by flooring, read with a half added."""
    return _packed(_core.pack_rgbe, pixels, 3)  # type: ignore[no-any-return]


def unpack_rgbe(codes: NDArray[np.uint8]) -> NDArray[np.float32]:
    """RGBE to float32, exactly."""
    return _unpacked(_core.unpack_rgbe, codes, np.uint8)  # type: ignore[no-any-return]


def pack_rgbm(pixels: ArrayLike, range: float) -> tuple[NDArray[np.uint8], PackCounts]:
    """Four bytes whose last multiplies: rgb = range m rgb8, up to range.

    Error: RANGE_INVALID unless it is positive and finite.
    """
    return _packed(_core.pack_rgbm, pixels, 3, float(range))  # type: ignore[no-any-return]


def unpack_rgbm(codes: NDArray[np.uint8], range: float) -> NDArray[np.float32]:
    """RGBM to float32. Error: RANGE_INVALID."""
    return _unpacked(_core.unpack_rgbm, codes, np.uint8, float(range))  # type: ignore[no-any-return]


def pack_rgbd(pixels: ArrayLike, range: float) -> tuple[NDArray[np.uint8], PackCounts]:
    """Four bytes whose last divides: rgb = range / d rgb8, with more levels in the dark than RGBM. Error: RANGE_INVALID."""
    return _packed(_core.pack_rgbd, pixels, 3, float(range))  # type: ignore[no-any-return]


def unpack_rgbd(codes: NDArray[np.uint8], range: float) -> NDArray[np.float32]:
    """RGBD to float32. Error: RANGE_INVALID."""
    return _unpacked(_core.unpack_rgbd, codes, np.uint8, float(range))  # type: ignore[no-any-return]


def pack_logluv(pixels: ArrayLike) -> tuple[NDArray[np.uint32], PackCounts]:
    """TIFF's LogLuv of 32 bits: the logarithm of the luminance and (u', v'); it holds every visible colour."""
    return _packed(_core.pack_logluv, pixels, 3)  # type: ignore[no-any-return]


def unpack_logluv(codes: NDArray[np.uint32]) -> NDArray[np.float32]:
    """LogLuv to float32."""
    return _unpacked(_core.unpack_logluv, codes, np.uint32)  # type: ignore[no-any-return]


def pack_rgb10a2(pixels: ArrayLike) -> tuple[NDArray[np.uint32], PackCounts]:
    """Unsigned normalised, ten bits a channel, red lowest, with an alpha of 1."""
    return _packed(_core.pack_rgb10a2, pixels, 3)  # type: ignore[no-any-return]


def unpack_rgb10a2(codes: NDArray[np.uint32]) -> NDArray[np.float32]:
    """10-10-10-2 to float32, without its alpha."""
    return _unpacked(_core.unpack_rgb10a2, codes, np.uint32)  # type: ignore[no-any-return]
