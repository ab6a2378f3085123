"""Text as people write it, and the formulas behind results."""

import math

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
