"""Spectra, colour spaces and metering: known facts."""

import math

import numpy as np
import pytest

import etendue
from etendue import colour, colour_space, metering, spectrum


def test_efficacies() -> None:
    # A 2856 K filament: 16.4 lm/W of all its radiation, 155.8 of what lies within 380-780 nm (Frostbite's table 6 mixes the two).
    assert spectrum.blackbody_efficacy(2856.0) == pytest.approx(16.4, abs=0.1)
    assert spectrum.blackbody_efficacy(2856.0, spectrum.VISIBLE) == pytest.approx(155.8, abs=0.1)
    assert spectrum.Spectrum(np.ones(471)).efficacy() == pytest.approx(182.0, abs=0.05)
    # Planck's law and Stefan and Boltzmann's are one.
    wavelength = np.geomspace(1e-7, 1e-3, 200001)
    total = np.trapezoid(spectrum.planck_radiance(wavelength, 5772.0), wavelength)
    assert total == pytest.approx(spectrum.blackbody_radiance(5772.0), rel=1e-5)
    nanometres = np.arange(360, 831.0)
    radiance = spectrum.planck_radiance(nanometres * 1e-9, 2856.0) * 1e-9
    assert spectrum.Spectrum(radiance).tristimulus().y == pytest.approx(spectrum.blackbody_luminance(2856.0), rel=1e-12)


def test_presets() -> None:
    for name, preset in spectrum.temperature_presets().items():
        assert spectrum.temperature_preset(name) == preset
        assert preset.low_kelvin <= preset.high_kelvin
        assert preset.source
    assert {p.of_electricity for p in spectrum.efficacy_presets()} == {True, False}
    with pytest.raises(etendue.Error) as caught:
        spectrum.temperature_preset("candel")
    assert caught.value.code == "PRESET_UNKNOWN"


def test_bad_spectra() -> None:
    for values in [[1.0], [1.0, -1.0], [1.0, math.nan]]:
        with pytest.raises(etendue.Error) as caught:
            spectrum.Spectrum(values).efficacy()
        assert caught.value.code == "SPECTRUM_INVALID"


def test_spaces() -> None:
    for name in colour_space.colour_spaces():
        space = colour_space.colour_space(name)
        white = colour_space.rgb_to_xyz(name) @ np.ones(3)
        assert white[:2] / white.sum() == pytest.approx(space.white, abs=1e-14)
        assert colour_space.xyz_to_rgb(name) @ colour_space.rgb_to_xyz(name) == pytest.approx(np.eye(3), abs=1e-14)
        assert colour_space.conversion(name, "acescg", "bradford") @ np.ones(3) == pytest.approx(np.ones(3), abs=1e-14)
    warm = colour.planckian(2700.0)
    assert colour_space.to_space(warm, "rec709").rgb == pytest.approx(colour.to_rgb(warm), rel=1e-4)
    assert colour_space.to_space(warm, "rec709", adaptation="cat02", observer_white=warm).rgb == pytest.approx((1, 1, 1), abs=1e-12)
    assert not colour_space.to_space(colour.planckian(1500.0), "rec709").in_gamut
    assert colour_space.white_balance(warm, "rec709", "bradford") @ colour.to_rgb(warm) == pytest.approx(np.ones(3), abs=1e-3)
    with pytest.raises(etendue.Error) as caught:
        colour_space.conversion("rec790", "acescg", "none")
    assert caught.value.code == "COLOUR_SPACE_UNKNOWN"


def test_metering() -> None:
    rng = np.random.default_rng(1)
    pixels = np.exp2(rng.normal(8, 3, (64, 64))).astype(np.float32)
    assert metering.log_average(pixels).mean == pytest.approx(np.exp2(np.log2(pixels.astype(np.float64)).mean()), rel=1e-6)
    histogram = metering.MeterHistogram()
    histogram.add(pixels)
    ordered = np.sort(np.log2(pixels.astype(np.float64)).ravel())
    trimmed = ordered[410:3686]  # a tenth of 4096 on either side, to half a pixel
    assert abs(math.log2(histogram.mean()) - trimmed.mean()) <= 0.0057 + 1e-3
    histogram.add(np.array([np.nan, np.inf, -1], np.float32))
    assert histogram.counts == metering.MeterCounts(averaged=4097, nan=1, infinite=1, negative=1)
    # One time constant makes 63 % of a step, in one step or in two.
    once = metering.adapted_ev100(10, 15, 0.4)
    assert once == pytest.approx(15 - 5 / math.e)
    assert metering.adapted_ev100(metering.adapted_ev100(10, 15, 0.1), 15, 0.3) == pytest.approx(once)
    with pytest.raises(etendue.Error) as caught:
        metering.log_average(np.array([np.nan]))
    assert caught.value.code == "NOTHING_METERED"
