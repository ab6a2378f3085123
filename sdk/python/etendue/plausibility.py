"""Whether colours of a surface can be those of a real one, as `etendue check` judges them. Colours are linear Rec.709.

>>> doubts((0.95, 0.95, 0.95), (0.04, 0.04, 0.04), metal=0)
('bright_albedo',)
>>> doubts_of_disney((0.2, 0.2, 0.2), metal=1)
('dim_metal',)
>>> doubts_of_disney((0.9, 0.6, 0.3), metal=1)
()
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core, material_fit
from ._arrays import as_array
from .errors import Error


class Ranges(NamedTuple):
    """What is possible: albedo and f0 of dielectrics, f0 of metals, each by the largest channel; masks that are neither."""

    albedo_least: float
    albedo_greatest: float
    f0_least: float
    f0_greatest: float
    metal_f0_least: float
    dielectric_mask: float
    metal_mask: float


class Doubt(NamedTuple):
    """A reason for doubt, the colour of a view of it, and its bit in what flags() gives."""

    name: str
    meaning: str
    colour: tuple[float, float, float]
    bit: int


RANGES = Ranges(*_core.plausible_ranges())
"""The library's own ranges; RANGES._replace(albedo_least=0.02) for others."""
DOUBTS = tuple(Doubt(name, meaning, colour, 1 << i) for i, (name, meaning, colour) in enumerate(_core.all_doubts()))
"""All of them, worst first."""


def _colours(colours: ArrayLike, name: str) -> NDArray[np.float32]:
    array = np.asarray(as_array(colours, name), np.float32, order="C")
    if array.ndim == 0 or array.shape[-1] != 3:
        raise Error("COLOUR_INVALID", f"expected three numbers in the last extent of {name}, found shape {array.shape}", field=name)
    return array


def flags(diffuse: ArrayLike, f0: ArrayLike, metal: ArrayLike | None = None, *, ranges: Ranges = RANGES) -> NDArray[np.uint8]:
    """The doubts about each of many colours: the sum of their bits, 0 where there is none.

    diffuse and f0 have 3 as their last extent and are taken as float32; metal has the others, or is a number. Without it two colours are a
    metal or a dielectric where they can be one within half an 8-bit step. Errors: COLOUR_INVALID, SHAPE_MISMATCH.
    """
    albedos, mirrors = _colours(diffuse, "diffuse"), _colours(f0, "f0")
    if albedos.shape != mirrors.shape:
        raise Error("SHAPE_MISMATCH", f"expected f0 of the shape of diffuse, {albedos.shape}, found {mirrors.shape}", field="f0")
    masks = None
    if metal is not None:
        given = as_array(metal, "metal")
        if given.ndim != 0 and given.shape != albedos.shape[:-1]:
            raise Error("SHAPE_MISMATCH", f"expected metal of shape {albedos.shape[:-1]}, found {given.shape}", field="metal")
        masks = np.asarray(np.broadcast_to(given, albedos.shape[:-1]), np.float32, order="C")
    bits: NDArray[np.uint8] = _core.doubts(albedos, mirrors, masks, ranges)
    return bits


def names(bits: int) -> tuple[str, ...]:
    """Of the doubts in one of what flags() gives, worst first."""
    return tuple(doubt.name for doubt in DOUBTS if int(bits) & doubt.bit)


def doubts(diffuse: ArrayLike, f0: ArrayLike, metal: float | None = None, *, ranges: Ranges = RANGES) -> tuple[str, ...]:
    """The doubts about one surface, worst first."""
    bits = flags(diffuse, f0, metal, ranges=ranges)
    if bits.ndim != 0:
        raise Error("SHAPE_MISMATCH", f"expected one colour, found shape {(*bits.shape, 3)}", hint="flags() takes many", field="diffuse")
    return names(int(bits))


def doubts_of_disney(base_colour: ArrayLike, metal: float = 0.0, reflectance: float = 0.5, *, ranges: Ranges = RANGES) -> tuple[str, ...]:
    """The same of Disney parameters."""
    pair = material_fit.two_colours(base_colour, metal, reflectance)
    return doubts(pair.diffuse, pair.f0, metal, ranges=ranges)
