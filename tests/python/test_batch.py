"""Batches: within what they state of the double functions, whatever the number of elements; what has no answer is NaN and counted."""

import numpy as np
import pytest

import etendue
from etendue import batch, camera, colour


def test_exposure() -> None:
    ev = np.linspace(-12, 22, 4097).astype(np.float32)
    luminance, none = batch.luminance_of_ev100(ev)
    assert none == 0
    assert luminance.dtype == np.float32
    exact = camera.luminance_of_ev100(ev.astype(np.float64))
    assert np.max(np.abs(np.log2(luminance / exact))) <= 3e-7
    back, none = batch.ev100_of_luminance(luminance)
    assert none == 0
    assert np.max(np.abs(back - camera.ev100_of_luminance(luminance.astype(np.float64)))) <= 2e-7 + np.spacing(np.float32(22)) / 2


def test_temperatures() -> None:
    kelvin = np.geomspace(800, 100000, 1001).astype(np.float32)[1:-1]
    xy, none = batch.planckian(kelvin)
    assert none == 0
    u, v = (colour.to_uv1960(a.astype(np.float64)) for a in (xy, colour.planckian(kelvin.astype(np.float64))))
    assert np.max(np.hypot(u[:, 0] - v[:, 0], 1.5 * (u[:, 1] - v[:, 1]))) <= 6e-7
    rgb, _ = batch.planckian_rgb(kelvin)
    exact = colour.to_rgb(colour.planckian(kelvin.astype(np.float64)))
    assert np.max(np.abs(rgb - exact).max(axis=1) / exact.max(axis=1)) <= 6e-6


def test_correlated_temperatures() -> None:
    kelvin, duv = np.meshgrid(np.geomspace(1000, 40000, 41), np.linspace(-0.02, 0.02, 9))
    xy = colour.to_chromaticity(kelvin, duv)
    found, none = batch.to_colour_temperature(xy)
    assert none == 0
    assert np.max(np.abs(found[..., 0] - kelvin)) <= 1e-4
    rough, _ = batch.fit_colour_temperature(xy)
    assert np.nanmax(np.abs(rough / kelvin - 1)) <= 0.0032


def test_srgb() -> None:
    encoded = np.linspace(0, 1, 256)
    assert np.max(np.abs(batch.linear_to_srgb(batch.srgb_to_linear(encoded)) - encoded)) <= 1e-6


def test_what_has_no_answer() -> None:
    ev, none = batch.ev100_of_luminance(np.array([4096, 0, -1, np.inf], np.float32))
    assert none == 3
    assert ev[0] == 15
    assert np.all(np.isnan(ev[1:]))
    assert batch.planckian(np.array([[100.0, 3000.0]]))[1] == 1
    assert batch.to_colour_temperature(np.array([[0.3, 0.6]]))[1] == 1
    with pytest.raises(etendue.Error, match="2 numbers"):
        batch.to_colour_temperature(np.zeros(3))
