"""Disney parameters (base colour, metal, reflectance) of a diffuse albedo and an f0, and back. Colours are linear Rec.709.

>>> found = fit((0.0, 0.0, 0.0), (0.9, 0.6, 0.3))
>>> found.metal, found.base_colour, found.residual
(1.0, (0.9, 0.6, 0.3), 0.0)
>>> fit_stored((0.2, 0.1, 0.05), (0.04, 0.04, 0.04), metal_high=0).base_colour_codes
(124, 89, 63)
"""

from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._arrays import as_array
from .errors import Error

Three = tuple[float, float, float]


class TwoColours(NamedTuple):
    """Diffuse albedo and reflectance at normal incidence."""

    diffuse: Three
    f0: Three


class Fit(NamedTuple):
    """Disney parameters, the sum of the six squared differences, and the metal masks around metal with which the rms grows by no more
    than the tolerance.
    """

    base_colour: Three
    metal: float
    reflectance: float
    residual: float
    metal_low: float
    metal_high: float


class StoredFit(NamedTuple):
    """Codes from 0 to 2^bits - 1 (base colour sRGB, the others linear), what they stand for, and its residual."""

    base_colour_codes: tuple[int, int, int]
    metal_code: int
    dielectric_code: int
    base_colour: Three
    metal: float
    reflectance: float
    residual: float


_DIELECTRICS = {"reflectance": 0, "specular": 1, "none": 2}


def _three(colour: ArrayLike, name: str) -> Three:
    array = as_array(colour, name)
    if array.shape != (3,):
        raise Error("COLOUR_INVALID", f"expected three numbers for {name}, found shape {array.shape}", field=name)
    return float(array[0]), float(array[1]), float(array[2])


def two_colours(base_colour: ArrayLike, metal: float, reflectance: float) -> TwoColours:
    """Diffuse (1 - metal) base, f0 = .16 reflectance^2 (1 - metal) + metal base."""
    return TwoColours(*_core.disney_to_two_colours(_three(base_colour, "base_colour"), float(metal), float(reflectance)))


def fit(diffuse: ArrayLike, f0: ArrayLike, *, core: bool = False, tolerance: float = 1 / 510) -> Fit:
    """The globally best parameters. core: f0 of dielectrics is .04, as in glTF's core. tolerance: of the metal interval, rms."""
    return Fit(*_core.fit_disney(_three(diffuse, "diffuse"), _three(f0, "f0"), core, float(tolerance)))


def fit_stored(
    diffuse: ArrayLike,
    f0: ArrayLike,
    *,
    bits: int = 8,
    dielectric: Literal["reflectance", "specular", "none"] = "reflectance",
    metal_low: float = 0.0,
    metal_high: float = 1.0,
) -> StoredFit:
    """The stored values that come nearest, never worse than the rounded optimum; metal within the range.

    dielectric: what is stored of a dielectric's f0: reflectance (.16 r^2), KHR_materials_specular's factor beside an ior of 7/3 (.16 w),
    or nothing (.04). Error: FORMAT_INVALID unless bits is from 1 to 16 and dielectric one of these.
    """
    if not 1 <= bits <= 16:
        raise Error("FORMAT_INVALID", f"bits: expected 1 to 16, found {bits}", field="bits")
    if dielectric not in _DIELECTRICS:
        raise Error("FORMAT_INVALID", f"dielectric: expected {', '.join(_DIELECTRICS)}, found '{dielectric}'", field="dielectric")
    kind = _DIELECTRICS[dielectric]
    return StoredFit(*_core.fit_codes(_three(diffuse, "diffuse"), _three(f0, "f0"), bits, kind, float(metal_low), float(metal_high)))


def fit_many(
    diffuse: ArrayLike, f0: ArrayLike, *, core: bool = False
) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]]:
    """Base colours, metals and reflectances of arrays whose last extent is 3, in float32, near the optimum as material_fit_batch.h says.

    Error: COLOUR_INVALID unless both have the same extents, the last of them 3.
    """
    a = np.ascontiguousarray(as_array(diffuse, "diffuse"), np.float32)
    b = np.ascontiguousarray(as_array(f0, "f0"), np.float32)
    if a.ndim == 0 or a.shape[-1] != 3 or a.shape != b.shape:
        raise Error("COLOUR_INVALID", f"expected arrays of the same extents, the last 3, found {a.shape} and {b.shape}", field="diffuse")
    many: tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]] = _core.fit_disney_many(a, b, core)
    return many
