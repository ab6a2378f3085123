"""Other programs' lights: known facts, there and back, losses, and what is refused."""

import math
from typing import Any

import pytest

import etendue
from etendue import Disk, Distant, Point, Rect, Sphere, Spot
from etendue.dialect import Form, StatedLight, dialects, emission, interoperability_spread, translate, units_of


def test_known_facts() -> None:
    # Frostbite divides a spot's lumens by pi, whatever its angle.
    lamp = StatedLight(Spot("0 deg", "30 deg"), 1000, Form("lm"))
    assert emission("frostbite", lamp).rgb.g == pytest.approx(1000 / math.pi, rel=1e-12)
    # Blender's watts are radiant, over all directions; light needs an efficacy.
    watts = emission("blender", StatedLight(Point(), 100, Form("W", efficacy="683 lm/W")))
    assert watts.kind == "intensity"
    assert watts.rgb.g == pytest.approx(100 * 683 / (4 * math.pi), rel=1e-12)
    # A normalised UsdLux sphere of centimetres: intensity over its area in stage units.
    sphere = StatedLight(Sphere(10.0), 5, Form(normalize=True, metres_per_unit=0.01))
    assert emission("usd", sphere).rgb.g == pytest.approx(5 / (4 * math.pi * 10**2), rel=1e-12)
    # UsdLux' distant light by default: 50000 nit over .53 degrees are 3.36 lx.
    sun = emission("usd", StatedLight(Distant("0.53 deg"), 50000, Form()))
    assert sun.rgb.g * math.pi * math.sin(math.radians(0.265)) ** 2 == pytest.approx(3.36, abs=5e-3)


@pytest.mark.parametrize("dialect", [d.name for d in dialects()])
@pytest.mark.parametrize("shape", [Point(), Spot("20 deg", "40 deg"), Sphere(0.2), Disk(0.3), Rect(0.4, 0.7), Distant("0.53 deg")])
def test_there_and_back(dialect: str, shape: Any) -> None:
    for unit in units_of(dialect, shape):
        usd = dialect == "usd"
        form = Form(unit, normalize=usd, metres_per_unit=1.0 if usd else None, efficacy="120 lm/W" if unit.startswith("W") else None)
        light = StatedLight(shape, 7.25, form)
        given = emission(dialect, light)
        again, _ = translate(light, dialect, dialect, form)
        back = emission(dialect, again)
        assert back.kind == given.kind
        assert back.rgb == pytest.approx(given.rgb, rel=1e-6), (dialect, unit)


def test_one_lamp_in_ten_programs() -> None:
    candelas = [row.candela for row in interoperability_spread("1000 lm", "0 deg", "30 deg")]
    assert len(candelas) >= 10
    assert max(candelas) / min(candelas) == pytest.approx(45, abs=0.5)


@pytest.mark.parametrize(
    ("dialect", "light", "code"),
    [
        ("maya", StatedLight(Point(), 1), "DIALECT_UNKNOWN"),
        ("usd", StatedLight(Sphere(10.0), 5, Form(normalize=True)), "METRES_PER_UNIT_MISSING"),
        ("blender", StatedLight(Point(), 100, Form("W")), "EFFICACY_MISSING"),
        ("filament", StatedLight(Point(), 1, Form("W")), "UNIT_UNSUITABLE"),
        ("gltf_spec", StatedLight(Rect(1, 1), 1), "DIALECT_HAS_NO_SUCH_LIGHT"),
        ("frostbite", StatedLight(Point(), math.nan), "NUMBER_INVALID"),
    ],
)
def test_bad_lights(dialect: str, light: StatedLight, code: str) -> None:
    with pytest.raises(etendue.Error) as caught:
        emission(dialect, light)
    assert caught.value.code == code, caught.value
