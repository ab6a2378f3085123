"""Quantities with their unit."""

from __future__ import annotations

import dataclasses
import functools
import math
from typing import Any, NamedTuple

from . import _core
from .errors import Error

_DIMENSIONS = _core.dimensions()
_NUMBER_OF = {name: number for number, (name, _) in enumerate(_DIMENSIONS)}
_LOGARITHMIC = ("exposure value at ISO 100", "exposure value without ISO")
_STOP = "difference of exposure values"


@functools.total_ordering
@dataclasses.dataclass(frozen=True)
class Quantity:
    """A number that knows what it measures: quantity("1500 lm"), quantity(1500, "lm").

    si: the number in the SI unit of its dimension: lm, cd, cd/m2, lx, W, m, rad, sr, K, s; EV and stops as they are.
    dimension: "luminous flux", "length"...; dimensions() lists them.

    Like is added to and compared with like; numbers scale; like over like is a number. Watts times lm/W are lumens, cd times sr are lumens,
    EV plus stops are EV, and the difference of two EV is in stops. All else is an Error, DIMENSION_MISMATCH.
    """

    si: float
    dimension: str

    def __post_init__(self) -> None:
        if self.dimension not in _NUMBER_OF:
            raise Error(
                "DIMENSION_UNKNOWN", f'"{self.dimension}" is no dimension', hint=f"one of: {', '.join(_NUMBER_OF)}", field="dimension"
            )
        object.__setattr__(self, "si", float(self.si))

    def in_unit(self, unit: str) -> float:
        """The number in another unit of the same dimension: quantity("60 cm").in_unit("in"). A shape is needed beyond that: convert()."""
        named = unit_named(unit, "unit")
        found = _DIMENSIONS[named.dimension][0]
        if found != self.dimension:
            raise Error(
                "DIMENSION_MISMATCH",
                f"expected a unit of {self.dimension}, found {unit}, of {found}",
                hint="convert() knows what the shape of a light makes of it",
                field="unit",
            )
        return named.from_si(self.si)

    @property
    def unit(self) -> str:
        """The SI unit of its dimension."""
        return _DIMENSIONS[_NUMBER_OF[self.dimension]][1]

    def __str__(self) -> str:
        return _core.quantity_text(_NUMBER_OF[self.dimension], self.si)

    def __repr__(self) -> str:
        return f"quantity({str(self)!r})"

    def _like(self, other: object, verb: str) -> Quantity:
        if not isinstance(other, Quantity) or other.dimension != self.dimension:
            raise _mismatch(self, verb, other)
        return other

    def __add__(self, other: Quantity) -> Quantity:
        if self.dimension in _LOGARITHMIC and isinstance(other, Quantity) and other.dimension == _STOP:
            return Quantity(self.si + other.si, self.dimension)
        if self.dimension in _LOGARITHMIC:
            raise _mismatch(self, "+", other)
        return Quantity(self.si + self._like(other, "+").si, self.dimension)

    def __sub__(self, other: Quantity) -> Quantity:
        if self.dimension in _LOGARITHMIC and isinstance(other, Quantity) and other.dimension == _STOP:
            return Quantity(self.si - other.si, self.dimension)
        difference = self.si - self._like(other, "-").si
        return Quantity(difference, _STOP if self.dimension in _LOGARITHMIC else self.dimension)

    def __neg__(self) -> Quantity:
        return Quantity(-self.si, self.dimension)

    def __mul__(self, other: float | Quantity) -> Quantity:
        if isinstance(other, Quantity):
            product = _PRODUCTS.get((self.dimension, other.dimension)) or _PRODUCTS.get((other.dimension, self.dimension))
            if product is None:
                raise _mismatch(self, "*", other)
            return Quantity(self.si * other.si, product)
        if self.dimension in _LOGARITHMIC or not isinstance(other, (int, float)):
            raise _mismatch(self, "*", other)
        return Quantity(self.si * other, self.dimension)

    def __rmul__(self, other: float) -> Quantity:
        return self * other

    def __truediv__(self, other: float | Quantity) -> Any:
        if isinstance(other, Quantity):
            if other.dimension == self.dimension and self.dimension not in _LOGARITHMIC:
                return self.si / other.si
            for (left, right), product in _PRODUCTS.items():
                if product == self.dimension and other.dimension in (left, right):
                    return Quantity(self.si / other.si, right if other.dimension == left else left)
            raise _mismatch(self, "/", other)
        if self.dimension in _LOGARITHMIC or not isinstance(other, (int, float)):
            raise _mismatch(self, "/", other)
        return Quantity(self.si / other, self.dimension)

    def __lt__(self, other: Quantity) -> bool:
        return self.si < self._like(other, "<").si


# What two factors make; a quotient is read from the same table.
_PRODUCTS = {
    ("radiant flux", "luminous efficacy"): "luminous flux",
    ("radiant intensity", "luminous efficacy"): "luminous intensity",
    ("radiance", "luminous efficacy"): "luminance",
    ("irradiance", "luminous efficacy"): "illuminance",
    ("luminous intensity", "solid angle"): "luminous flux",
    ("radiant intensity", "solid angle"): "radiant flux",
}


def _mismatch(left: Quantity, verb: str, right: object) -> Error:
    found = right.dimension if isinstance(right, Quantity) else f"{right!r}"
    return Error("DIMENSION_MISMATCH", f"{left.dimension} {verb} {found} has no meaning")


def quantity(value: str | float | Quantity, unit: str | None = None) -> Quantity:
    """A quantity from text, "1500 lm", or from a number and its unit.

    Errors: UNIT_MISSING, UNIT_UNKNOWN (with the nearest spellings), NUMBER_INVALID.
    """
    if isinstance(value, Quantity):
        return value
    if isinstance(value, str):
        if unit is not None:
            raise Error("NUMBER_INVALID", f'expected a number beside the unit "{unit}", found text: "{value}"', field="value")
        number, si = _core.parse_quantity(value)
    elif unit is None:
        raise Error(
            "UNIT_MISSING",
            f"expected a unit after the number, found {value!r}",
            hint='write for example quantity(1500, "lm")',
            field="unit",
        )
    else:
        named = unit_named(unit, "unit")
        number, si = named.dimension, named.to_si(float(value))
        if not math.isfinite(si):
            raise Error("NUMBER_INVALID", f"expected a finite number of {unit}, found {value!r}", field="value")
    return of_number(si, number)


def si_of(value: str | float | Quantity, dimension: str, field: str) -> float:
    """Of a parameter that is text with its unit, a quantity, or a number in the SI unit, the number in the SI unit."""
    if isinstance(value, (str, Quantity)):
        q = quantity(value)
        if q.dimension != dimension:
            expected = f"a {dimension} (in {_DIMENSIONS[_NUMBER_OF[dimension]][1]})"
            raise Error("DIMENSION_MISMATCH", f"expected {expected} for {field}, found a {q.dimension}: {q}", field=field)
        return q.si
    return float(value)


def dimensions() -> dict[str, str]:
    """The name of each dimension, and its SI unit."""
    return dict(_DIMENSIONS)


def number_of(dimension: str) -> int:
    """The number by which the compiled half knows a dimension."""
    return _NUMBER_OF[dimension]


def of_number(si: float, number: int) -> Quantity:
    """A quantity of the dimension of that number."""
    return Quantity(si, _DIMENSIONS[number][0])


def unit_named(unit: str | None, field: str) -> _core.NamedUnit:
    """What a unit is. Errors: UNIT_MISSING, UNIT_UNKNOWN."""
    if not isinstance(unit, str):
        raise Error("UNIT_MISSING", f"expected a unit, found {unit!r}", hint='write for example unit="lm"', field=field)
    try:
        return _core.unit_named(unit)
    except Error as error:
        error.field = field
        raise


class Unit(NamedTuple):
    """A unit: how it is written, the SI prefixes that it takes (a letter each), what it is called, what it measures."""

    symbol: str
    prefixes: str
    name: str
    dimension: str


def units() -> list[Unit]:
    """Every unit that text may have."""
    return [Unit(symbol, prefixes, name, _DIMENSIONS[number][0]) for symbol, prefixes, name, number in _core.unit_spellings()]
