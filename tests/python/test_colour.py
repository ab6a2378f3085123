"""Colour temperature: known values, arrays, and what is refused."""

import math
from typing import Any

import numpy as np
import pytest

import etendue
from etendue import colour


def test_known_values() -> None:
    # CIE illuminant A is a Planckian radiator of 2848 K with c2 = 1.435e-2: with today's c2, at 2855.496 K.
    assert colour.planckian(2855.496) == pytest.approx((0.44758, 0.40745), abs=2e-5)
    assert colour.to_colour_temperature((0.3127, 0.3290)).kelvin == pytest.approx(6504, abs=0.5)
    assert colour.to_rgb((0.3127, 0.3290)) == pytest.approx((1, 1, 1), abs=1e-12)
    assert colour.planckian(math.inf) == pytest.approx((0.2399, 0.2341), abs=5e-4)


def test_there_and_back() -> None:
    kelvin, duv = np.meshgrid(np.geomspace(1000, 40000, 23), np.linspace(-0.02, 0.02, 7))
    found = colour.to_colour_temperature(colour.to_chromaticity(kelvin, duv))
    assert found.shape == (7, 23, 2)
    assert np.max(np.abs(found[..., 0] - kelvin)) <= 1e-3
    assert np.max(np.abs(found[..., 1] - duv)) <= 1e-9


def test_shapes() -> None:
    assert colour.planckian(np.full((2, 3), 3000.0)).shape == (2, 3, 2)
    assert colour.planckian(np.empty(0)).shape == (0, 2)
    assert colour.to_rgb(np.zeros((4, 5, 2))).shape == (4, 5, 3)
    assert colour.luminance_of(np.ones((4, 3))).shape == (4,)
    # What broadcasts, what is not contiguous and what is of whole numbers is as good.
    whole: Any = np.arange(1000, 5000, 500)[::2]
    assert np.array_equal(colour.mired_of(whole), 1e6 / whole)
    assert colour.to_chromaticity(np.full((2, 1), 3000.0), np.zeros(3)).shape == (2, 3, 2)


def test_shapes_that_do_not_fit() -> None:
    with pytest.raises(etendue.Error, match=r"kelvin \(3,\), duv \(4,\)") as caught:
        colour.to_chromaticity(np.full(3, 3000.0), np.zeros(4))
    assert caught.value.code == "SHAPE_MISMATCH"
    with pytest.raises(etendue.Error, match=r"2 numbers in its last extent, found shape \(5, 3\)"):
        colour.to_rgb(np.zeros((5, 3)))
    with pytest.raises(etendue.Error, match="expected numbers for kelvin"):
        colour.planckian(np.array(["3000"]))


def test_the_first_bad_element_is_named() -> None:
    kelvin = np.full((3, 4), 3000.0)
    kelvin[2, 1] = -5
    with pytest.raises(etendue.Error, match="element 2, 1: ") as caught:
        colour.planckian(kelvin)
    assert caught.value.index == (2, 1)
    assert caught.value.code == "TEMPERATURE_OUT_OF_RANGE"
