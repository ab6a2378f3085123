"""What texels of a normal map turn into where they are too small to be seen one by one: roughness. As `etendue filter` does it.

>>> round(mean_length(100.0), 12)
0.99
>>> found = filtered(0.1, 0.99)
>>> found.alpha > 0.1
True
"""

from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._arrays import Number, as_array, elementwise
from .errors import Error

Method = Literal["ggx", "slopes", "listing32"]


class Lobe(NamedTuple):
    """Alpha of a filtered lobe, and the share of its facets that it has elsewhere than the average of lobes it stands for ("ggx" alone)."""

    alpha: float
    misplaced: float


class Level(NamedTuple):
    """A mip level: means of unit normals (height x width x 3), and of each texel alpha filtered and as authored, and what is misplaced."""

    means: NDArray[np.float32]
    alphas: NDArray[np.float32]
    authored_alphas: NDArray[np.float32]
    misplaced: NDArray[np.float32]


def concentration(mean_length: Number) -> Number:
    """Kappa of von Mises and Fisher's distribution whose mean has that length: coth kappa - 1 / kappa. Infinite at 1."""
    kappa: Number = elementwise(_core.normal_concentration, mean_length=mean_length)
    return kappa


def mean_length(concentration: Number) -> Number:
    """The way back: the length of the mean of normals that are spread with that kappa."""
    length: Number = elementwise(_core.mean_normal_length, concentration=concentration)
    return length


def filtered_many(alpha: ArrayLike, mean_length: ArrayLike, method: Method = "ggx") -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Alphas, and shares that are misplaced, of arrays that broadcast with each other, all within [0, 1].

    method: the GGX lobe nearest to the average of the texels' lobes; "slopes", alpha^2 + 2 / kappa; or "listing32", as Lagarde and
    de Rousiers 2014 print it. Errors: SHAPE_MISMATCH, METHOD_UNKNOWN.
    """
    try:
        a, r = np.broadcast_arrays(as_array(alpha, "alpha"), as_array(mean_length, "mean_length"))
    except ValueError:
        shapes = f"alpha {np.shape(alpha)}, mean_length {np.shape(mean_length)}"
        raise Error("SHAPE_MISMATCH", f"expected shapes that broadcast, found {shapes}", field="alpha") from None
    many: tuple[NDArray[np.float64], NDArray[np.float64]] = _core.filtered_lobes(
        np.asarray(a, np.float64, order="C"), np.asarray(r, np.float64, order="C"), method
    )
    return many


def filtered(alpha: float, mean_length: float, method: Method = "ggx") -> Lobe:
    """The lobe that stands for lobes of one alpha whose normals have a mean of that length."""
    alphas, misplaced = filtered_many(float(alpha), float(mean_length), method)
    return Lobe(float(alphas), float(misplaced))


def levels(normals: ArrayLike, alpha: ArrayLike, method: Method = "ggx") -> list[Level]:
    """All mip levels of a normal map (height x width x 3, directions of any length but 0), the map itself the first.

    alpha: one number, or one for each texel. A texel stands for the exact area under it, so that every level has the same mean. Errors:
    SHAPE_MISMATCH, METHOD_UNKNOWN, FIELD_UNSUITABLE (a normal without a direction, an alpha beyond [0, 1], with the place).
    """
    field = np.asarray(as_array(normals, "normals"), np.float32, order="C")
    if field.ndim != 3 or field.shape[-1] != 3:
        raise Error("SHAPE_MISMATCH", f"expected normals of height x width x 3, found shape {field.shape}", field="normals")
    alphas = np.asarray(as_array(alpha, "alpha"), np.float32, order="C")
    if alphas.ndim != 0 and alphas.shape != field.shape[:2]:
        raise Error("SHAPE_MISMATCH", f"expected one alpha or {field.shape[:2]} of them, found shape {alphas.shape}", field="alpha")
    return [Level(*level) for level in _core.filter_normals(field, alphas.reshape(-1), method)]
