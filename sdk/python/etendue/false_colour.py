"""Exposure values, luminances or illuminances as colours whose lightness rises with them.

>>> colours, counts = false_colours([4.0, 8.0, 99.0], least=0, greatest=16)
>>> counts
Counts(below=0, above=1, nan=0)
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._arrays import as_array
from .colour import Rgb


class Counts(NamedTuple):
    """Values outside of a scale: black below, white above, magenta for NaN."""

    below: int
    above: int
    nan: int


def false_colour(position: float) -> Rgb:
    """From dark blue (0) over green (.5) to pale yellow (1), linear Rec.709; luminance rises all the way. Outside: the ends."""
    return Rgb(*_core.false_colour(float(position)))


def false_colours(
    values: ArrayLike, least: float, greatest: float, *, logarithmic: bool = False, bands: int = 0
) -> tuple[NDArray[np.float32], Counts]:
    """Colours of float32 values, channels in a last extent of 3, and how many values were outside of the scale.

    logarithmic: equal ratios look equal, for cd/m2 and lx; not for EV, which is a logarithm. bands: as many even colours instead of a
    gradient. Error: SCALE_INVALID unless least < greatest, finite, above 0 where logarithmic, bands from 0 to 4096.
    """
    array = np.ascontiguousarray(as_array(values, "values"), np.float32)
    colours, counts = _core.false_colours(array, float(least), float(greatest), logarithmic, bands)
    return colours, Counts(*counts)
