"""Disney parameters of two colours."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from etendue import Error, material_fit


def rms_excess(values: material_fit.TwoColours, diffuse: NDArray[np.float64], f0: NDArray[np.float64]) -> float:
    six = np.concatenate([np.subtract(values.diffuse, diffuse), np.subtract(values.f0, f0)])
    return math.sqrt(float(np.mean(six**2)))


def test_a_dielectric_and_a_metal_come_back() -> None:
    for base, metal, reflectance in [((0.5, 0.3, 0.1), 0.0, 0.5), ((0.9, 0.6, 0.3), 1.0, 0.5), ((0.5, 0.3, 0.1), 0.25, 0.75)]:
        pair = material_fit.two_colours(base, metal, reflectance)
        found = material_fit.fit(pair.diffuse, pair.f0)
        assert found.residual < 1e-18
        assert found.metal == pytest.approx(metal, abs=1e-7)
        assert found.base_colour == pytest.approx(base, abs=1e-7)
        assert found.metal_low <= found.metal <= found.metal_high


def test_no_grid_is_better_and_arrays_come_near() -> None:
    random = np.random.default_rng(1)
    diffuse, f0 = random.random((5, 4, 3)), random.random((5, 4, 3))
    base, metal, reflectance = material_fit.fit_many(diffuse, f0)
    assert base.shape == (5, 4, 3) and metal.shape == reflectance.shape == (5, 4)
    m, r = np.meshgrid(np.linspace(0, 1, 101), np.linspace(0, 1, 51))
    for index in np.ndindex(5, 4):
        d, f = diffuse[index], f0[index]
        k = 0.16 * r**2 * (1 - m)
        sums = np.zeros_like(m)
        for c in range(3):
            b = np.clip(((1 - m) * d[c] + m * (f[c] - k)) / ((1 - m) ** 2 + m**2), 0, 1)
            sums += ((1 - m) * b - d[c]) ** 2 + (k + m * b - f[c]) ** 2
        found = material_fit.fit(d, f)
        assert found.residual <= sums.min() + 1e-14
        near = material_fit.two_colours(base[index], float(metal[index]), float(reflectance[index]))
        assert rms_excess(near, d, f) - math.sqrt(found.residual / 6) < 1 / 510
        assert material_fit.fit(d, f, core=True).residual >= found.residual - 1e-14


def test_stored_values_are_no_worse_than_rounding() -> None:
    def encoded(x: float) -> float:
        return 12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055

    def decoded(x: float) -> float:
        return x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4

    random = np.random.default_rng(2)
    for _ in range(50):
        d, f = random.random(3), random.random(3)
        best = material_fit.fit(d, f)
        base = tuple(decoded(round(encoded(x) * 255) / 255) for x in best.base_colour)
        plain = material_fit.two_colours(base, round(best.metal * 255) / 255, round(best.reflectance * 255) / 255)
        stored = material_fit.fit_stored(d, f)
        assert math.sqrt(stored.residual / 6) <= rms_excess(plain, d, f) + 1e-12
        assert stored.metal == stored.metal_code / 255
        assert material_fit.fit_stored(d, f, metal_low=1).metal_code == 255


def test_what_is_wrong_is_said() -> None:
    for wrong in (
        lambda: material_fit.fit((1.0, 2.0), (0.0, 0.0, 0.0)),
        lambda: material_fit.fit_stored((0, 0, 0), (0, 0, 0), bits=17),
        lambda: material_fit.fit_many(np.zeros((2, 3)), np.zeros((3, 3))),
        lambda: material_fit.fit_many(np.zeros(4), np.zeros(4)),
    ):
        with pytest.raises(Error):
            wrong()
