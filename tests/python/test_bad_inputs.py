"""Inputs that others clamp, invert or turn into NaN: each is an error that names the field, the value and what is legal."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import etendue
from etendue import Mesh, Point, Rect, Sphere, Spot, camera, colour, convert, dialect, false_colour, hdri, pixel, quantity


def _usd_rect() -> Any:
    return dialect.emission("usd", dialect.StatedLight(Rect(1, 1), 1, dialect.Form("nit")))


CASES: list[tuple[str, Callable[[], Any], str, str, str]] = [
    ("NaN kelvin", lambda: colour.planckian(math.nan), "TEMPERATURE_OUT_OF_RANGE", "kelvin", "nan"),
    ("0 K", lambda: colour.planckian(0.0), "TEMPERATURE_OUT_OF_RANGE", "kelvin", "100"),
    ("-100 K", lambda: colour.planckian(-100.0), "TEMPERATURE_OUT_OF_RANGE", "kelvin", "-100"),
    ("beyond the fit of others and of ours", lambda: colour.planckian(200000.0), "TEMPERATURE_OUT_OF_RANGE", "kelvin", "100000"),
    ("-100 K as text", lambda: etendue.parse("-100 K"), "TEMPERATURE_OUT_OF_RANGE", "kelvin", "between 100 K and 100000 K, found -100"),
    ("-100 K with a Duv", lambda: etendue.parse("-100 K Duv 0"), "TEMPERATURE_OUT_OF_RANGE", "kelvin", "found -100 K"),
    ("0 K with a Duv", lambda: etendue.parse("0 K Duv 0"), "TEMPERATURE_OUT_OF_RANGE", "kelvin", "found 0 K"),
    ("200000 K as text", lambda: etendue.parse("200000 K"), "TEMPERATURE_OUT_OF_RANGE", "kelvin", "found 200000 K"),
    ("0 K in mired", lambda: convert(0.0, "mired", unit="K"), "TEMPERATURE_OUT_OF_RANGE", "value", "100"),
    ("-100 K in mired", lambda: convert("-100 K", "mired"), "TEMPERATURE_OUT_OF_RANGE", "kelvin", "100"),
    ("-100 K clamped", lambda: etendue.parse("-100 K", clamp=True), "TEMPERATURE_OUT_OF_RANGE", "kelvin", "-100"),
    ("xy NaN", lambda: colour.to_colour_temperature((math.nan, 0.3)), "NOT_NEAR_LOCUS", "xy", "nan"),
    ("xy of black", lambda: colour.to_colour_temperature((0.0, 0.0)), "NOT_NEAR_LOCUS", "xy", "0.05"),
    ("McCamy's pole", lambda: colour.to_colour_temperature((0.332, 0.1858)), "NOT_NEAR_LOCUS", "xy", "0.05"),
    ("far off", lambda: colour.to_colour_temperature((0.8, 0.1)), "NOT_NEAR_LOCUS", "xy", "0.05"),
    ("a spot of no angle", lambda: convert("60 lm", "cd", shape=Spot("0 deg", "0 deg")), "SIZE_MISSING", "outer", "infinite"),
    ("a negative angle", lambda: convert("60 lm", "cd", shape=Spot("0 deg", "-5 deg")), "NUMBER_INVALID", "outer", "-5"),
    ("beyond a full turn", lambda: convert("60 lm", "cd", shape=Spot("0 deg", "200 deg")), "NUMBER_INVALID", "outer", "180"),
    ("degrees taken for radians", lambda: convert("60 lm", "cd", shape=Spot("0 rad", "45 rad")), "NUMBER_INVALID", "outer", "180"),
    ("an angle without its unit", lambda: convert("60 lm", "cd", shape=Spot(0, 45)), "UNIT_MISSING", "inner", "deg"),  # type: ignore[arg-type]
    ("inner beyond outer", lambda: convert("60 lm", "cd", shape=Spot("30 deg", "20 deg")), "NUMBER_INVALID", "inner", "20"),
    ("lm to nit without a size", lambda: convert("60 lm", "nit"), "SHAPE_MISSING", "shape", "shape"),
    ("lm to nit of area 0", lambda: convert("60 lm", "nit", shape=Rect(0, 1)), "SIZE_MISSING", "width", "greater than zero"),
    ("lm to nit of a mesh of area 0", lambda: convert("60 lm", "nit", shape=Mesh(0)), "SIZE_MISSING", "area_m2", "greater than zero"),
    ("lux without a distance", lambda: convert("60 lx", "cd", shape=Point()), "DISTANCE_MISSING", "distance", "distance"),
    ("lux within the lamp", lambda: convert("6 lx", "cd", shape=Sphere(2), distance=1), "NUMBER_INVALID", "distance", "greater than 2"),
    ("nit on a point", lambda: convert("60 nit", "lm", shape=Point()), "UNIT_UNSUITABLE", "shape", "no surface"),
    ("watts without efficacy", lambda: convert("60 W", "lm"), "EFFICACY_MISSING", "efficacy", "lm/W"),
    ("an efficacy of 0", lambda: convert("60 W", "lm", efficacy="0 lm/W"), "NUMBER_INVALID", "efficacy", "above 0"),
    ("an efficacy that is a range", lambda: convert("60 W", "lm", efficacy="incandescent"), "EFFICACY_AMBIGUOUS", "efficacy", "13.7"),
    ("an efficacy of nobody", lambda: convert("60 W", "lm", efficacy="CIE D66"), "PRESET_UNKNOWN", "efficacy", "CIE D65"),
    ("EV of no luminance", lambda: convert("0 nit", "EV"), "LUMINANCE_NOT_POSITIVE", "value", "above 0"),
    ("EV of no luminance", lambda: camera.ev100_of_luminance(-1.0), "LUMINANCE_NOT_POSITIVE", "luminance_cd_m2", "-1"),
    ("a negative flux", lambda: convert("-5 lm", "cd", shape=Point()), "NUMBER_INVALID", "value", "not negative"),
    ("f/0", lambda: camera.ev_s(camera.CameraSettings(f_number=0, shutter_s=1)), "CAMERA_SETTING_INVALID", "f_number", "above 0"),
    ("1/0 s", lambda: camera.ev_s(camera.CameraSettings(f_number=8, shutter_s=math.inf)), "CAMERA_SETTING_INVALID", "shutter_s", "above 0"),
    ("ISO 0", lambda: camera.ev100(camera.CameraSettings(f_number=8, shutter_s=1, iso=0)), "CAMERA_SETTING_INVALID", "iso", "above 0"),
    ("f/0 as text", lambda: etendue.parse("f/0 1/60 s"), "CAMERA_SETTING_INVALID", "f_number", "above 0"),
    ("1/0 s as text", lambda: etendue.parse("f/2 1/0 s"), "CAMERA_SETTING_INVALID", "shutter_s", "above 0"),
    ("ISO 0 as text", lambda: etendue.parse("f/2 ISO 0"), "CAMERA_SETTING_INVALID", "iso", "above 0"),
    ("USD without metersPerUnit", lambda: _usd_rect(), "METRES_PER_UNIT_MISSING", "metres_per_unit", "metersPerUnit"),
    ("a range of 0", lambda: pixel.pack_rgbm(np.ones((1, 3)), 0), "RANGE_INVALID", "range", "above 0"),
    (
        "a panorama that is black",
        lambda: hdri.factor_for_illuminance(np.zeros((4, 8, 3)), "1 klx"),
        "CALIBRATION_IMPOSSIBLE",
        "texels",
        "black",
    ),
    ("no lux measured", lambda: hdri.factor_for_illuminance(np.ones((4, 8, 3)), "0 lx"), "CALIBRATION_IMPOSSIBLE", "measured", "above 0"),
    ("a scale of nothing", lambda: false_colour.false_colours([1.0], 5, 5), "SCALE_INVALID", "scale", "least < greatest"),
    ("unknown unit", lambda: quantity("5 nt"), "UNIT_UNKNOWN", "", "nit"),
    ("spelt out", lambda: quantity("5 lumenz"), "UNIT_UNKNOWN", "", "lm"),
    ("spelt out", lambda: convert("5 lx", "lumen/m2"), "UNIT_UNKNOWN", "to", "lx"),
    ("a number of some locale", lambda: quantity("1.200,5 lm"), "NUMBER_INVALID", "", "point"),
]


@pytest.mark.parametrize(("what", "call", "code", "field", "says"), CASES, ids=[case[0] for case in CASES])
def test_it_is_refused(what: str, call: Callable[[], Any], code: str, field: str, says: str) -> None:
    with pytest.raises(etendue.Error) as caught:
        call()
    assert caught.value.code == code, caught.value
    assert caught.value.field == field, caught.value
    assert says in f"{caught.value.text} {caught.value.hint}", caught.value


def test_beyond_the_fits_of_others_is_exact() -> None:
    # 500 K and 50000 K, which others clamp: the spectrum's own sum, so that what comes back is the temperature.
    for kelvin in [501.0, 50000.0]:
        assert colour.to_colour_temperature(colour.planckian(kelvin)).kelvin == pytest.approx(kelvin, rel=1e-9)


def test_equal_half_angles_are_a_hard_edge() -> None:
    hard = convert("60 lm", "cd", shape=Spot("20 deg", "20 deg"))
    assert hard == pytest.approx(60 / (2 * math.pi * (1 - math.cos(math.radians(20)))), rel=1e-12)


def test_an_array_says_which_element() -> None:
    with pytest.raises(etendue.Error, match=r"element 1, 0: .*found nan"):
        convert(np.array([[1.0, 2.0], [math.nan, 4.0]]), "cd", unit="lm", shape=Point())
