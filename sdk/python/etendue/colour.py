"""Chromaticity, colour temperature and the linear Rec.709 of lights, in double.

Temperatures are in kelvin; x, y are CIE 1931 (2 degree observer); RGB is linear Rec.709 with its D65 white. A number gives a number or a
named tuple, an array an array of the same precision, with a last extent of 2 or 3 for what is a tuple. Domains and errors: Error.code
TEMPERATURE_OUT_OF_RANGE, DUV_OUT_OF_RANGE, NOT_NEAR_LOCUS.
"""

from typing import Any, NamedTuple, overload

from numpy.typing import NDArray

from . import _core
from ._arrays import Array, Number, elementwise, rowwise


class Chromaticity(NamedTuple):
    """CIE 1931 x, y."""

    x: float
    y: float


class ColourTemperature(NamedTuple):
    """Correlated colour temperature in K, and the distance from the Planckian locus in CIE 1960 (u, v): above (greenish) is positive."""

    kelvin: float
    duv: float


class ClampedTemperature(NamedTuple):
    """A temperature in K, and whether it was another one; arrays of both for an array."""

    kelvin: Any
    clamped: Any


class Rgb(NamedTuple):
    """Linear Rec.709; negative channels are outside of its gamut."""

    r: float
    g: float
    b: float


class Uv(NamedTuple):
    """CIE 1960 u, v."""

    u: float
    v: float


Pair = Chromaticity | ColourTemperature | Uv | tuple[float, float]
Triple = Rgb | tuple[float, float, float]


def _pair(result: Any, kind: type) -> Any:
    return kind(*result) if isinstance(result, tuple) else result


@overload
def planckian(kelvin: float) -> Chromaticity: ...
@overload
def planckian(kelvin: Array) -> Array: ...
def planckian(kelvin: Any) -> Any:
    """Chromaticity of a Planckian radiator, 100 K to 100000 K and infinity: c2 of SI 2019, summed from 360 to 830 nm at 1 nm."""
    return _pair(elementwise(_core.planckian, kelvin=kelvin), Chromaticity)


@overload
def daylight(kelvin: float) -> Chromaticity: ...
@overload
def daylight(kelvin: Array) -> Array: ...
def daylight(kelvin: Any) -> Any:
    """Chromaticity of CIE daylight (CIE 015), 4000 K to 25000 K. D65 is at 6503.6 K."""
    return _pair(elementwise(_core.daylight, kelvin=kelvin), Chromaticity)


@overload
def daylight_or_planckian(kelvin: float) -> Chromaticity: ...
@overload
def daylight_or_planckian(kelvin: Array) -> Array: ...
def daylight_or_planckian(kelvin: Any) -> Any:
    """CIE daylight, which below 4000 K leaves smoothly for the Planckian locus and reaches it at 2500 K; 100 K to 25000 K."""
    return _pair(elementwise(_core.daylight_or_planckian, kelvin=kelvin), Chromaticity)


@overload
def to_chromaticity(kelvin: float, duv: float = 0.0) -> Chromaticity: ...
@overload
def to_chromaticity(kelvin: Array, duv: float | Array = 0.0) -> Array: ...
def to_chromaticity(kelvin: Any, duv: Any = 0.0) -> Any:
    """The point at a distance Duv from the Planckian locus, along its normal in CIE 1960: 500 K to 100000 K, |Duv| <= .05."""
    return _pair(elementwise(_core.to_chromaticity, kelvin=kelvin, duv=duv), Chromaticity)


@overload
def to_colour_temperature(xy: Pair) -> ColourTemperature: ...
@overload
def to_colour_temperature(xy: Array) -> Array: ...
def to_colour_temperature(xy: Any) -> Any:
    """Correlated colour temperature and Duv, to the rounding of a double: the inverse of to_chromaticity.

    Errors: NOT_NEAR_LOCUS beyond |Duv| = .05, TEMPERATURE_OUT_OF_RANGE beyond 500 K and 100000 K.
    """
    return rowwise(_core.to_colour_temperature, 2, "xy", xy, ColourTemperature)


def clamped_temperature(kelvin: float | NDArray[Any]) -> ClampedTemperature:
    """The nearest temperature of 100 K to 100000 K, for those who ask for it: everything else here refuses what is beyond.

    >>> clamped_temperature(250000.0)
    ClampedTemperature(kelvin=100000.0, clamped=True)

    What is no temperature, 0 K, a negative one or NaN, is an Error still: TEMPERATURE_OUT_OF_RANGE.
    """
    found = elementwise(_core.clamped_temperature, kelvin=kelvin)
    if isinstance(found, tuple):
        return ClampedTemperature(found[0], bool(found[1]))
    return ClampedTemperature(found[..., 0], found[..., 1] != 0)


def mired_of(kelvin: Number) -> Number:
    """Reciprocal megakelvin, 10^6 / T, in which filters are sold."""
    return elementwise(_core.mired_of, kelvin=kelvin)  # type: ignore[no-any-return]


def shifted_by_mired(kelvin: Number, shift_mired: Number | float) -> Number:
    """The temperature behind a conversion filter, 10^6 / (10^6 / T + shift); positive is warmer."""
    return elementwise(_core.shifted_by_mired, kelvin=kelvin, shift_mired=shift_mired)  # type: ignore[no-any-return]


@overload
def to_uv1960(xy: Pair) -> Uv: ...
@overload
def to_uv1960(xy: Array) -> Array: ...
def to_uv1960(xy: Any) -> Any:
    """CIE 1960 (u, v), in which Duv is measured. CIE 1976 is (u, 1.5 v)."""
    return rowwise(_core.to_uv1960, 2, "xy", xy, Uv)


@overload
def from_uv1960(uv: Pair) -> Chromaticity: ...
@overload
def from_uv1960(uv: Array) -> Array: ...
def from_uv1960(uv: Any) -> Any:
    """The chromaticity of a point of CIE 1960."""
    return rowwise(_core.from_uv1960, 2, "uv", uv, Chromaticity)


@overload
def to_rgb(xy: Pair) -> Rgb: ...
@overload
def to_rgb(xy: Array) -> Array: ...
def to_rgb(xy: Any) -> Any:
    """Linear Rec.709 of luminance 1, without adaptation; negative channels are kept. Black where y <= 0."""
    return rowwise(_core.to_rgb, 2, "xy", xy, Rgb)


@overload
def chromaticity_of_rgb(rgb: Triple) -> Chromaticity: ...
@overload
def chromaticity_of_rgb(rgb: Array) -> Array: ...
def chromaticity_of_rgb(rgb: Any) -> Any:
    """The chromaticity of linear Rec.709; (0, 0) for black."""
    return rowwise(_core.chromaticity_of_rgb, 3, "rgb", rgb, Chromaticity)


@overload
def luminance_of(rgb: Triple) -> float: ...
@overload
def luminance_of(rgb: Array) -> Array: ...
def luminance_of(rgb: Any) -> Any:
    """Y = .2126 R + .7152 G + .0722 B."""
    return rowwise(_core.luminance_of, 3, "rgb", rgb)


@overload
def clipped_keeping_luminance(rgb: Triple) -> Rgb: ...
@overload
def clipped_keeping_luminance(rgb: Array) -> Array: ...
def clipped_keeping_luminance(rgb: Any) -> Any:
    """Moved into the gamut (no negative channel) at the same luminance: clipped, then rescaled. Black where Y <= 0."""
    return rowwise(_core.clipped_keeping_luminance, 3, "rgb", rgb, Rgb)
