"""Quantities: text, units, arithmetic that has a meaning and none that has not."""

import math
import operator
from collections.abc import Callable
from typing import Any

import pytest

import etendue
from etendue import Quantity, quantity


def refused(code: str, call: Callable[[], object]) -> etendue.Error:
    with pytest.raises(etendue.Error) as caught:
        call()
    assert caught.value.code == code, caught.value
    return caught.value


def test_text_is_read_and_written() -> None:
    assert quantity("1.5 klx") == Quantity(1500, "illuminance")
    assert quantity(1500, "lx") == quantity("1.5 klx")
    assert str(quantity("60 cm")) == "0.6 m"
    q = quantity("47.3 fc")
    assert eval(repr(q), {"quantity": quantity}) == q


def test_units_of_one_dimension() -> None:
    assert quantity("60 cm").in_unit("cm") == 60
    assert quantity("1 ft").in_unit("in") == pytest.approx(12, rel=1e-15)
    assert quantity("180 deg").in_unit("rad") == math.pi
    assert quantity("4000 K").in_unit("mired") == 250
    error = refused("DIMENSION_MISMATCH", lambda: quantity("1500 lm").in_unit("nit"))
    assert "luminous flux" in error.text
    assert "luminance" in error.text
    assert "convert" in error.hint


def test_arithmetic_with_a_meaning() -> None:
    assert quantity("800 lm") + quantity("1 klm") == quantity("1800 lm")
    assert 3 * quantity("2 m") / 4 == quantity("1.5 m")
    assert quantity("2 m") / quantity("50 cm") == 4
    assert quantity("60 W") * quantity("15 lm/W") == quantity("900 lm")
    assert quantity("900 lm") / quantity("60 W") == quantity("15 lm/W")
    assert quantity("100 cd") * quantity("2 sr") == quantity("200 lm")
    assert quantity("15 EV") + quantity("1.5 stop") == quantity("16.5 EV")
    assert quantity("15 EV") - quantity("12 EV") == quantity("3 stop")
    assert -quantity("1 stop") < quantity("0 stop") <= quantity("0 stop")


@pytest.mark.parametrize(
    ("left", "verb", "right"),
    [
        ("5 cd", operator.add, "5 lm"),
        ("5 nit", operator.sub, "5 lx"),
        ("5 lm", operator.lt, "5 W"),
        ("5 lm", operator.mul, "5 lm"),
        ("15 EV", operator.add, "15 EV"),
        ("1 lm", operator.truediv, "2 m"),
    ],
)
def test_arithmetic_without(left: str, verb: Callable[[Any, Any], object], right: str) -> None:
    error = refused("DIMENSION_MISMATCH", lambda: verb(quantity(left), quantity(right)))
    assert quantity(left).dimension in error.text
    assert quantity(right).dimension in error.text


def test_an_exposure_value_is_no_factor() -> None:
    refused("DIMENSION_MISMATCH", lambda: 2 * quantity("15 EV"))
    refused("DIMENSION_MISMATCH", lambda: quantity("15 EV") / quantity("5 EV"))


def test_bad_text() -> None:
    for text in ["1500 nt", "5 lumenz", "5 lumen/m2"]:
        assert "nearest" in refused("UNIT_UNKNOWN", lambda text=text: quantity(text)).hint  # type: ignore[misc]
    refused("UNIT_MISSING", lambda: quantity("1500"))
    refused("UNIT_MISSING", lambda: quantity(1500))
    for text in ["1.200,5 lm", "1,5 lm", "inf lm", "nan K", "1e999 lm"]:
        refused("NUMBER_INVALID", lambda text=text: quantity(text))  # type: ignore[misc]
    refused("NUMBER_INVALID", lambda: quantity(math.nan, "lm"))
