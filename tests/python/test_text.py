"""Text as people write it, and the formulas behind results."""

import math

import numpy as np
import pytest

import etendue
from etendue import Point, Sphere, camera, colour, convert, explain, parse, quantity


def test_kinds() -> None:
    assert parse("1200 lm") == quantity("1200 lm")
    assert parse("60 W at 15 lm/W") == etendue.WrittenQuantity(quantity("60 W"), None, quantity("15 lm/W"))
    assert parse("T2.8 180 deg @ 24 fps ND 0.9") == camera.CameraSettings(
        t_stop=2.8, shutter_angle_rad=math.pi, frames_per_s=24, nd_density=0.9
    )
    assert parse("3000 K Duv -0.003") == colour.ColourTemperature(3000, -0.003)
    assert parse("xy .3127 .329") == colour.Chromaticity(0.3127, 0.329)
    assert parse("#ffffff") == colour.Rgb(1, 1, 1)
    warmer = parse("3200 K + 137 mired")
    assert isinstance(warmer, etendue.Quantity)
    assert warmer.si == colour.shifted_by_mired(3200.0, 137.0)


def test_what_stands_beside_a_quantity_is_used() -> None:
    assert convert("15 klx @ 2 m", "cd", shape=Point()) == 60000
    assert convert("15 klx @ 2 m", "lx", shape=Point(), distance=4) == 3750
    assert convert("60 W at 15 lm/W", "lm") == 900
    assert convert("f/16 1/125 ISO100", "EV") == math.log2(256 * 125)
    assert convert("f/16 1/125", "EV_S") == math.log2(256 * 125)


def test_a_number_is_rounded_once_on_its_way() -> None:
    assert convert("6 ft", "cm") == 182.88
    assert convert(6.0, "cm", unit="ft") == 182.88


def test_clamping_is_asked_for_and_told() -> None:
    with pytest.warns(etendue.ClampedWarning, match="200000 K counts as 100000 K"):
        assert parse("200000 K", clamp=True) == quantity("100000 K")
    with pytest.warns(etendue.ClampedWarning):
        assert parse("90 K Duv 0.01", clamp=True) == colour.ColourTemperature(100, 0.01)
    assert colour.clamped_temperature(90.0) == (100.0, True)
    kelvin, clamped = colour.clamped_temperature(np.array([90.0, 5600.0, 2e5]))
    assert kelvin.tolist() == [100, 5600, 100000]
    assert clamped.tolist() == [True, False, True]


def test_an_efficacy_may_be_a_policy_by_name() -> None:
    assert convert("1 W", "lm", efficacy="CIE D65") == 204.8
    assert convert("1 W", "lm", efficacy="2856 K") == etendue.spectrum.blackbody_efficacy(2856.0)
    assert convert("1 W", "lm", efficacy="2856 K visible") == pytest.approx(155.8, abs=0.1)
    assert any("CIE D65" in note for note in explain("1 W", "lm", efficacy="CIE D65").notes)


def test_units_are_listed() -> None:
    by_symbol = {unit.symbol: unit for unit in etendue.units()}
    assert by_symbol["lm"].dimension == "luminous flux"
    for unit in etendue.units():
        for prefix in ["", *unit.prefixes]:
            assert quantity(1, prefix + unit.symbol).dimension == unit.dimension


def test_the_formula_gives_the_result() -> None:
    explanation = explain("1500 lm", "nit", shape=Sphere("15 cm"))
    names = {symbol.name: symbol.value for symbol in explanation.symbols}
    result, _, formula = explanation.formula.partition(" = ")
    assert result == "luminance"
    value = eval(formula.replace("^", "**"), {"pi": math.pi}, names)
    assert value == pytest.approx(convert("1500 lm", "nit", shape=Sphere("15 cm")), rel=1e-14)
    assert explanation.formula in str(explanation)
    assert explanation.notes
    assert "log2" in explain(camera.CameraSettings(f_number=16, shutter_s=1 / 125, iso=100)).formula


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("1/0 s", "CAMERA_SETTING_INVALID"),
        ("f/0 1/60", "CAMERA_SETTING_INVALID"),
        ("f/8 f/9 1/60", "CAMERA_SETTING_AMBIGUOUS"),
        ("5 lm @ 2 m", "DIMENSION_MISMATCH"),
        ("15 klx @ 2", "UNIT_MISSING"),
        ("#ff", "COLOUR_INVALID"),
        ("5 lm 6", "TEXT_UNEXPECTED"),
    ],
)
def test_bad_text(text: str, code: str) -> None:
    with pytest.raises(etendue.Error) as caught:
        parse(text)
    assert caught.value.code == code, caught.value
