"""Panoramas of the surroundings become physical: pixels in cd/m2, the sun a light of its own.

Texels are latitude-longitude, linear Rec.709, rows from the top (+Y): an array of height x width x 3, taken as float32 and without a copy
where it is that already. Column u = 1/2 - atan2(x, z) / (2 pi), row v = acos(y) / pi. Lagarde and de Rousiers, Moving Frostbite to PBR
3.0, section 4.9.1.1. Errors: PANORAMA_INVALID, DIRECTION_INVALID.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._arrays import as_array
from .colour import Rgb
from .errors import Error
from .quantity import Quantity, si_of

Direction = tuple[float, float, float]
Texels = NDArray[np.float32]

# What the compiled half calls a parameter, and what it is called here.
_CALLED = {"lux": "measured", "cd_m2": "measured", "radius_rad": "radius"}


def _texels(texels: ArrayLike) -> Texels:
    array = as_array(texels, "texels")
    if array.ndim != 3 or array.shape[-1] != 3:
        raise Error("SHAPE_MISMATCH", f"expected texels of height x width x 3, found shape {array.shape}", field="texels")
    return np.ascontiguousarray(array, np.float32)


def _call(kernel: Callable[..., Any], *arguments: object) -> Any:
    try:
        return kernel(*arguments)
    except Error as error:
        error.field = _CALLED.get(error.field, error.field)
        raise


def _vector(direction: Direction) -> Direction:
    x, y, z = direction
    return float(x), float(y), float(z)


def illuminance(texels: ArrayLike, normal: Direction = (0, 1, 0)) -> Rgb:
    """Illuminance on a plane with this normal, in lx where texels are cd/m2; an even sky of L gives pi L."""
    return Rgb(*_call(_core.illuminance_of_panorama, _texels(texels), _vector(normal)))


def luminance(texels: ArrayLike, direction: Direction, radius: str | Quantity = "0.5 deg") -> Rgb:
    """Mean over a cone of that angular radius, weighted by solid angle: what a spot meter of twice that angle shows."""
    return Rgb(*_call(_core.luminance_of_panorama, _texels(texels), _vector(direction), si_of(radius, "angle", "radius")))


def factor_for_illuminance(texels: ArrayLike, measured: str | Quantity, normal: Direction = (0, 1, 0)) -> float:
    """What relative texels are to be multiplied by to be cd/m2, from what a lux meter with that normal showed, "32 klx".

    Error: CALIBRATION_IMPOSSIBLE, where the panorama is black there or nothing was measured.
    """
    lux = si_of(measured, "illuminance", "measured")
    return float(_call(_core.factor_for_illuminance, _texels(texels), _vector(normal), lux))


def factor_for_luminance(texels: ArrayLike, measured: str | Quantity, direction: Direction, radius: str | Quantity = "0.5 deg") -> float:
    """The same from what a spot meter showed in a direction, "3500 cd/m2"."""
    cd_m2 = si_of(measured, "luminance", "measured")
    return float(_call(_core.factor_for_luminance, _texels(texels), _vector(direction), si_of(radius, "angle", "radius"), cd_m2))


class SunCut(NamedTuple):
    """A sun that was cut out.

    direction: towards it. illuminance_lx: on a plane that faces it. luminance: of its disk in cd/m2, as linear Rec.709.
    diameter_rad: of that disk. texels: painted over; at_maximum: as many of them are as bright as the brightest, and several speak for a
    clipped sun, with too few lux.
    """

    direction: Direction
    illuminance_lx: float
    luminance: Rgb
    diameter_rad: float
    texels: int
    at_maximum: int


def cut_sun(texels: ArrayLike, radius: str | Quantity = "3 deg") -> tuple[SunCut, Texels]:
    """The sun as a distant light, and the panorama without it: together they give every plane that sees it what there was before.

    Texels within `radius` of the sun are painted over, in a copy, with the mean of the ring around them. Errors: SUN_RADIUS_INVALID (no
    ring), SUN_NOT_FOUND (nothing is brighter than the ring).
    """
    rest = _texels(texels).copy()
    direction, lux, rgb, diameter_rad, painted, at_maximum = _call(_core.cut_sun, rest, si_of(radius, "angle", "radius"))
    return SunCut(direction, lux, Rgb(*rgb), diameter_rad, painted, at_maximum), rest
