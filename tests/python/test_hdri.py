"""Panoramas: an even sky, a sun that is cut out, and false colours."""

import math
from typing import Any

import numpy as np
import pytest

import etendue
from etendue import false_colour, hdri


def even(luminance: float) -> Any:
    return np.full((64, 128, 3), luminance, np.float32)


def with_sun(luminance: float) -> Any:
    texels = even(100)
    texels[15:17, 30:32] = luminance
    return texels


def test_an_even_sky_of_l_gives_pi_l() -> None:
    assert hdri.illuminance(even(100)) == pytest.approx((100 * math.pi,) * 3, rel=1e-9)
    assert hdri.luminance(even(100), (0.3, 1, -2)) == pytest.approx((100, 100, 100))


def test_a_measurement_calibrates() -> None:
    texels = with_sun(300)
    factor = hdri.factor_for_illuminance(texels, "32 klx")
    assert etendue.colour.luminance_of(hdri.illuminance(texels * np.float32(factor))) == pytest.approx(32000, rel=1e-6)
    assert hdri.factor_for_luminance(even(0.5), "3.5 kcd/m2", (0, 0, 1)) == pytest.approx(7000)


def test_the_sun_and_the_rest_are_what_was_there() -> None:
    texels = with_sun(1e6)
    before = texels.copy()
    sun, rest = hdri.cut_sun(texels, "8 deg")
    assert np.array_equal(texels, before), "the panorama that was given is not painted over"
    assert rest.max() == pytest.approx(100, rel=1e-3)
    assert sun.at_maximum == 4
    ground = sun.illuminance_lx * sun.direction[1] + hdri.illuminance(rest).g
    assert ground == pytest.approx(hdri.illuminance(texels).g, rel=1e-5)
    # E = L pi sin^2(a) of its disk.
    assert sun.luminance.g * math.pi * math.sin(sun.diameter_rad / 2) ** 2 == pytest.approx(sun.illuminance_lx, rel=1e-12)


def test_false_colours_are_ordered_by_their_luminance() -> None:
    colours, counts = false_colour.false_colours(np.linspace(0, 16, 50), 0, 16)
    assert colours.shape == (50, 3)
    assert colours.dtype == np.float32
    assert np.all(np.diff(etendue.colour.luminance_of(colours.astype(np.float64))) > 0)
    assert counts == (0, 0, 0)
    assert false_colour.false_colour(0.5) == pytest.approx(tuple(false_colour.false_colours([8.0], 0, 16)[0][0]))
    outside, counts = false_colour.false_colours([-1.0, 17.0, math.nan], 0, 16)
    assert outside.tolist() == [[0, 0, 0], [1, 1, 1], [1, 0, 1]]
    assert counts == (1, 1, 1)
    banded, _ = false_colour.false_colours(np.geomspace(1, 1000, 300), 1, 1000, logarithmic=True, bands=3)
    assert len(np.unique(banded, axis=0)) == 3


def test_a_panorama_has_rows_columns_and_channels() -> None:
    with pytest.raises(etendue.Error, match="height x width x 3") as caught:
        hdri.illuminance(np.ones((4, 8)))
    assert caught.value.field == "texels"
