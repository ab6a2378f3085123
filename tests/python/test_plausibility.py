"""Doubts about colours of surfaces."""

import numpy as np
import pytest

from etendue import Error, plausibility


def test_real_surfaces_are_in_order() -> None:
    for base, metal in [((0.5, 0.3, 0.1), 0.0), ((0.8, 0.8, 0.8), 0.0), ((1.0, 0.766, 0.336), 1.0), ((0.55, 0.556, 0.554), 1.0)]:
        assert plausibility.doubts_of_disney(base, metal) == ()


def test_each_doubt_is_found_worst_first() -> None:
    grey = (0.04, 0.04, 0.04)
    assert plausibility.doubts((0.005, 0.005, 0.005), grey, 0) == ("dark_albedo",)
    assert plausibility.doubts((0.5, 0.5, 0.5), (0.01, 0.01, 0.01), 0) == ("low_f0",)
    assert plausibility.doubts((0.5, 0.5, 0.5), (0.2, 0.2, 0.2), 0) == ("high_f0",)
    assert plausibility.doubts((1.0, 1.0, 1.0), grey, 0) == ("gains_energy", "bright_albedo")
    assert plausibility.doubts_of_disney((0.9, 0.9, 0.9), 0.5) == ("half_metal",)
    assert plausibility.doubts_of_disney((0.3, 0.3, 0.3), 1) == ("dim_metal",)


def test_ranges_can_be_others() -> None:
    ranges = plausibility.RANGES._replace(metal_f0_least=0.2)
    assert plausibility.doubts_of_disney((0.3, 0.3, 0.3), 1, ranges=ranges) == ()
    # Without a mask, black with an f0 of .3 can be a metal.
    assert plausibility.doubts((0, 0, 0), (0.3, 0.3, 0.3)) == ("dim_metal",)


def test_arrays_are_judged_one_by_one() -> None:
    random = np.random.default_rng(3)
    diffuse, f0 = random.random((4, 5, 3), np.float32), 0.2 * random.random((4, 5, 3), np.float32)
    metal = np.where(random.random((4, 5)) < 0.5, 0.0, 1.0).astype(np.float32)
    found = plausibility.flags(diffuse, f0, metal)
    assert found.shape == (4, 5) and found.dtype == np.uint8
    for index in np.ndindex(4, 5):
        assert plausibility.names(int(found[index])) == plausibility.doubts(diffuse[index], f0[index], float(metal[index]))
    energy = plausibility.DOUBTS[0]
    assert energy.name == "gains_energy"
    assert np.array_equal((found & energy.bit) != 0, np.max(diffuse + f0, axis=-1) > 1 + 1 / 255)
    assert plausibility.flags(np.zeros((0, 3)), np.zeros((0, 3))).shape == (0,)


def test_what_is_wrong_is_said() -> None:
    for wrong, field in (
        (lambda: plausibility.flags(np.zeros(4), np.zeros(4)), "diffuse"),
        (lambda: plausibility.flags(np.zeros((2, 3)), np.zeros((3, 3))), "f0"),
        (lambda: plausibility.flags(np.zeros((2, 3)), np.zeros((2, 3)), np.zeros(3)), "metal"),
        (lambda: plausibility.doubts(np.zeros((2, 3)), np.zeros((2, 3))), "diffuse"),
    ):
        with pytest.raises(Error) as caught:
            wrong()
        assert caught.value.field == field
