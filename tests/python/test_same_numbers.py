"""The Python module gives the C++ library's numbers, bit for bit, for numbers and for arrays."""

import os
import subprocess
from collections import defaultdict
from typing import Any

import numpy as np
import pytest

import etendue
from etendue import camera, colour

# How each function of tests/python/values.cpp is called here, with all its arguments in arrays.
ROWWISE = {"to_rgb", "to_colour_temperature", "chromaticity_of_rgb"}
SHAPES: dict[str, etendue.Shape] = {
    "point": etendue.Point(),
    "spot": etendue.Spot("17 deg", "31.4 deg"),
    "frustum": etendue.Frustum("60 deg", "41 deg"),
    "sphere": etendue.Sphere("15 cm"),
    "disk": etendue.Disk("37 cm"),
    "rect": etendue.Rect(0.6, "1.3 m"),
    "tube": etendue.Tube("120 cm", "13 mm", caps="flat"),
    "line": etendue.Line("1.7 m"),
    "distant": etendue.Distant("0.533 deg"),
    "environment": etendue.Environment(),
}


def function(name: str) -> Any:
    if name.startswith("convert:"):
        _, shape, given, wanted = name.split(":")
        return lambda x: etendue.convert(x, wanted, unit=given, shape=SHAPES[shape], distance=3)
    name, _, calibration = name.partition(":")
    f = getattr(colour, name, None) or getattr(camera, name)
    if calibration:
        return lambda *arguments: f(*arguments, calibration)
    return (lambda *arguments: f(arguments)) if name in ROWWISE else f


def rows(results: Any) -> list[tuple[float, ...]]:
    return [tuple(r) if isinstance(r, tuple) else (r,) for r in results]


@pytest.fixture(scope="module")
def lines() -> dict[str, list[tuple[list[str], list[float]]]]:
    program = os.environ.get("ETENDUE_PYTHON_VALUES")
    if not program:
        pytest.skip("ETENDUE_PYTHON_VALUES does not name the program of tests/python/values.cpp")
    of_name = defaultdict(list)
    for line in subprocess.run([program], stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines():
        call, _, results = line.partition(" = ")
        name, *arguments = call.split()
        of_name[name].append((arguments, [float.fromhex(x) for x in results.split()]))
    return dict(of_name)


def test_numbers(lines: dict[str, list[tuple[list[str], list[float]]]]) -> None:
    checked = 0
    for name, calls in lines.items():
        for arguments, expected in calls:
            if name == "quantity":
                found = rows([etendue.quantity(" ".join(arguments)).si])
            else:
                found = rows([function(name)(*map(float.fromhex, arguments))])
            assert found == [tuple(expected)], (name, arguments)
            checked += 1
    assert checked > 1000


def test_arrays(lines: dict[str, list[tuple[list[str], list[float]]]]) -> None:
    for name, calls in lines.items():
        if name == "quantity":
            continue
        arguments = np.array([[float.fromhex(x) for x in a] for a, _ in calls])
        expected = np.array([r for _, r in calls])
        if name in ROWWISE:
            found = getattr(colour, name)(arguments)
        else:
            found = function(name)(*(np.ascontiguousarray(column) for column in arguments.T))
        assert found.dtype == np.float64
        assert np.array_equal(found.reshape(expected.shape), expected), name


def test_float32_is_the_double_rounded_once() -> None:
    kelvin = np.geomspace(600, 90000, 300).astype(np.float32)
    single, double = colour.planckian(kelvin), colour.planckian(kelvin.astype(np.float64))
    assert single.dtype == np.float32
    assert np.array_equal(single, double.astype(np.float32))
