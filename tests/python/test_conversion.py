"""Conversions by shape: known facts, every shape there and back, arrays."""

import math
from typing import Any

import numpy as np
import pytest

import etendue
from etendue import Disk, Distant, Environment, Frustum, Line, Mesh, Photometric, Point, Polygon, Rect, Sphere, Spot, Tube, convert

SQUARE = Polygon([(0, 0), (0.3, 0), (0.3, 0.3), (0, 0.3)])


def test_known_facts() -> None:
    # 1500 lm / (pi 4 pi .15^2), printed as 1688 in Frostbite's table 12.
    assert convert("1500 lm", "nit", shape=Sphere("15 cm")) == pytest.approx(1688.69, abs=5e-3)
    assert convert("800 lm", "cd", shape=Point()) == pytest.approx(800 / (4 * math.pi), rel=1e-15)
    # A 60 degree cone: 1000 lm / (2 pi (1 - cos 30 deg)) = 1188 cd; by the flux that its squared falloff really has, 3564.
    spot = Spot("0 deg", "30 deg")
    assert convert("1000 lm", "cd", shape=spot, spot_flux="cone") == pytest.approx(1188, abs=0.5)
    assert convert("1000 lm", "cd", shape=spot) == pytest.approx(3 * convert("1000 lm", "cd", shape=spot, spot_flux="cone"), rel=1e-14)
    assert convert("1000 lm", "cd", shape=spot, spot_flux="frostbite_pi") == pytest.approx(1000 / math.pi, rel=1e-15)
    # The 1.2 m tube of 13 mm: 3178.6 cd/m2 as a capsule.
    assert convert("1000 lm", "nit", shape=Tube("1.2 m", "13 mm")) == pytest.approx(3178.6, abs=0.05)
    # A sun of pi lux on a white diffuser gives 1 cd/m2: its exitance over pi.
    assert convert(f"{math.pi!r} lm/m2", "nit") == 1
    assert convert("15 EV", "nit") == 4096
    assert convert("15 EV", "lx") == 2.5 * 2**15
    assert convert("60 W", "lm", efficacy="15 lm/W") == 900
    assert convert("1 ft", "in") == pytest.approx(12, rel=1e-15)


SHAPES: list[tuple[Any, list[str]]] = [
    (Point(), ["lm", "cd", "lx"]),
    (Spot("20 deg", "35 deg"), ["lm", "cd", "lx"]),
    (Frustum("60 deg", "40 deg"), ["lm", "cd", "lx"]),
    (Photometric("2.9 sr"), ["lm", "cd", "lx"]),
    (Sphere("15 cm"), ["lm", "cd", "nit", "lx", "lm/m2", "EV"]),
    (Disk("15 cm"), ["lm", "cd", "nit", "lx", "lm/m2", "EV"]),
    (Rect("60 cm", 1.2), ["lm", "cd", "nit", "lx", "lm/m2", "EV"]),
    (SQUARE, ["lm", "cd", "nit", "lx", "lm/m2", "EV"]),
    (Tube("1.2 m", "13 mm"), ["lm", "cd", "nit", "lx", "lm/m2", "EV"]),
    (Tube("1.2 m", "13 mm", caps="flat"), ["lm", "nit", "lm/m2", "EV"]),
    (Mesh(0.8), ["lm", "nit", "lm/m2", "EV"]),
    (Line("1.2 m"), ["lm", "cd", "lx"]),
    (Distant("0.533 deg"), ["nit", "lx", "EV"]),
    (Environment(), ["nit", "lx", "EV"]),
]


@pytest.mark.parametrize(("shape", "units"), SHAPES)
def test_each_shape_there_and_back(shape: Any, units: list[str]) -> None:
    values = np.geomspace(0.1, 1e5, 25)
    for unit in units:
        if unit == "EV":
            continue
        for other in units:
            there = convert(values, other, unit=unit, shape=shape, distance=3)
            back = convert(there, unit, unit=other, shape=shape, distance=3)
            # Both factors are rounded once; an exposure value has lost what its logarithm of up to 30 has.
            assert np.allclose(back, values, rtol=1e-14 if "EV" in (unit, other) else 4.5e-16, atol=0), (unit, other)
            assert there[7] == convert(float(values[7]), other, unit=unit, shape=shape, distance=3)


def test_a_polygon_is_the_rectangle_that_it_is() -> None:
    for unit in ["cd", "nit", "lm/m2"]:
        assert convert("700 lm", unit, shape=SQUARE) == pytest.approx(convert("700 lm", unit, shape=Rect(0.3, 0.3)), rel=1e-14)


def test_both_sides() -> None:
    one = convert("700 lm", "nit", shape=Disk(0.1))
    assert convert("700 lm", "nit", shape=Disk(0.1), two_sided=True) == pytest.approx(one / 2, rel=1e-15)


def test_luminance_says_the_size_out_of_the_flux() -> None:
    # Frostbite's eq 38, 39: of equal luminance, a sphere twice as wide at twice the distance gives the same illuminance.
    near = convert("1000 nit", "lx", shape=Sphere(0.1), distance=2)
    assert convert("1000 nit", "lx", shape=Sphere(0.2), distance=4) == pytest.approx(near, rel=1e-15)


def test_illuminance_at_another_distance() -> None:
    assert convert("100 lx", "lx", shape=Point(), given_distance=2, distance=4) == pytest.approx(25, rel=1e-15)
    # Near a disk it is not I / d^2 but pi L r^2 / (r^2 + d^2).
    assert convert("1 nit", "lx", shape=Disk(1), distance=1) == pytest.approx(math.pi / 2, rel=1e-15)


def test_float32() -> None:
    found = convert(np.array([100, 200], np.float32), "nit", unit="lm", shape=Sphere(0.15))
    assert found.dtype == np.float32
    assert found[1] == np.float32(convert("200 lm", "nit", shape=Sphere(0.15)))


def test_what_is_no_choice() -> None:
    with pytest.raises(etendue.Error, match="cone") as caught:
        convert("1000 lm", "cd", shape=Spot("0 deg", "30 deg"), spot_flux="conical")
    assert caught.value.code == "NAME_UNKNOWN"
