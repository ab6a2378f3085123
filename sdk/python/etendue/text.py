"""What people write about lights, cameras and colours, in one line."""

import warnings
from typing import NamedTuple

from . import _core
from .camera import CameraSettings
from .colour import Chromaticity, ColourTemperature, Rgb
from .errors import ClampedWarning
from .quantity import Quantity, of_number


class WrittenQuantity(NamedTuple):
    """A quantity with what was written beside it: "15 klx @ 2 m", "60 W at 15 lm/W"."""

    quantity: Quantity
    distance: Quantity | None
    efficacy: Quantity | None


Written = Quantity | WrittenQuantity | CameraSettings | ColourTemperature | Chromaticity | Rgb


def parse(text: str, *, clamp: bool = False) -> Written:
    """Quantities, cameras and colours as people write them.

        >>> parse("1200 lm")
        quantity('1200 lm')
        >>> parse("15 klx @ 2 m").distance
        quantity('2 m')
        >>> parse("f/2.8 1/60 s ISO 400").f_number
        2.8
        >>> parse("3000 K Duv -0.003")
        ColourTemperature(kelvin=3000.0, duv=-0.003)
        >>> parse("xy .3127 .329")
        Chromaticity(x=0.3127, y=0.329)

    Also "T2.8 180 deg @ 24 fps ND 0.9", "3200 K + 137 mired", "60 W at 15 lm/W", "#ffb46b" (sRGB, decoded), "rgb 1 .5 .2" (linear Rec.709).

    clamp: a temperature beyond 100 K to 100000 K counts as the nearer of the two, with a ClampedWarning, and is no Error.

    Errors: NUMBER_INVALID, UNIT_MISSING, UNIT_UNKNOWN (with the nearest spellings), DIMENSION_MISMATCH, CAMERA_SETTING_INVALID,
    CAMERA_SETTING_AMBIGUOUS, TEMPERATURE_OUT_OF_RANGE, COLOUR_INVALID, TEXT_UNEXPECTED.
    """
    if clamp:
        (kind, *numbers), told = _core.parse_clamping(text)
        for warning in told:
            warnings.warn(warning, ClampedWarning, stacklevel=2)
    else:
        kind, *numbers = _core.parse(text)
    if kind == "camera":
        return CameraSettings(*numbers[0])
    if kind == "temperature":
        return ColourTemperature(*numbers)
    if kind == "xy":
        return Chromaticity(*numbers)
    if kind == "rgb":
        return Rgb(*numbers)
    number, si, distance_m, efficacy_lm_w, _, _ = numbers
    if distance_m is None and efficacy_lm_w is None:
        return of_number(si, number)
    return WrittenQuantity(
        of_number(si, number),
        None if distance_m is None else Quantity(distance_m, "length"),
        None if efficacy_lm_w is None else Quantity(efficacy_lm_w, "luminous efficacy"),
    )
