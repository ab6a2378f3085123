"""Automatic exposure: a picture's luminances become one reading, readings become a smooth EV.

Values are luminances in cd/m2, or illuminances in lx from a render's illuminance layer, whose reading does not depend on albedo. They are
float32, as pictures are; NaN and infinity are counted and left out.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._arrays import as_array
from .errors import Error


class MeterCounts(NamedTuple):
    """Pixels of a reading; negative ones are averaged as the darkest."""

    averaged: int
    nan: int
    infinite: int
    negative: int


class LogAverage(NamedTuple):
    """The geometric mean, in the unit of the values."""

    mean: float
    counts: MeterCounts


LIMITS = (2.0**-13, 2.0**21)
"""Values outside count as the ends: EV100 -10 and 24 for luminances and K = 12.5."""


def log_average(values: ArrayLike, limits: tuple[float, float] = LIMITS) -> LogAverage:
    """The geometric mean of all values. Errors: NOTHING_METERED (none is finite), METER_LIMITS_INVALID."""
    mean, counts = _core.log_average(np.ascontiguousarray(as_array(values, "values"), np.float32), *limits)
    return LogAverage(mean, MeterCounts(*counts))


class MeterHistogram:
    """Counts of values in bins of 1/128 of an octave: means are within .0057 EV of those over the sorted pixels.

    >>> histogram = MeterHistogram()
    >>> histogram.add(np.full((4, 4), 4096.0))
    >>> round(float(np.log2(histogram.mean())), 1)
    12.0
    """

    def __init__(self) -> None:
        self._bins = _core.MeterHistogram()

    def add(self, values: ArrayLike) -> None:
        """Luminances or illuminances."""
        self._bins.add(np.ascontiguousarray(as_array(values, "values"), np.float32))

    def add_rgb(self, rgb: ArrayLike) -> None:
        """Linear Rec.709 by its luminance; channels in the last extent."""
        array = as_array(rgb, "rgb")
        if array.ndim == 0 or array.shape[-1] != 3:
            raise Error("SHAPE_MISMATCH", f"expected rgb of 3 channels in the last extent, found shape {array.shape}", field="rgb")
        self._bins.add_rgb(np.ascontiguousarray(array, np.float32))

    def mean(self, low: float = 0.1, high: float = 0.9, limits: tuple[float, float] = LIMITS) -> float:
        """The geometric mean of the pixels between two shares of them, sorted by value. Errors: NOTHING_METERED, PERCENTILES_INVALID."""
        return self._bins.mean(low, high, *limits)

    def percentile(self, share: float, limits: tuple[float, float] = LIMITS) -> float:
        """The value below which that share of the pixels lies. Errors as of mean()."""
        return self._bins.percentile(share, *limits)

    @property
    def counts(self) -> MeterCounts:
        """What has been added."""
        return MeterCounts(*self._bins.counts())


def adapted_ev100(ev100: float, target_ev100: float, elapsed_s: float, *, brighter_s: float = 0.4, darker_s: float = 1.2) -> float:
    """EV after a time: target + (ev - target) e^(-elapsed / time constant), the same however often it is called.

    Error: ADAPTATION_INVALID.
    """
    return _core.adapted_ev100(ev100, target_ev100, elapsed_s, brighter_s, darker_s)
