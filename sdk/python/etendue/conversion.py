"""Light quantities into one another."""

from typing import Any, overload

import numpy as np

from . import _core
from ._arrays import Array, elementwise
from .quantity import Quantity, dimension_of_unit, in_unit, number_of, quantity, si_of, to_si
from .shapes import Length, Shape


@overload
def convert(
    value: str | float | Quantity,
    to: str,
    *,
    unit: str | None = None,
    shape: Shape | None = None,
    two_sided: bool = False,
    spot_flux: str = "falloff",
    spot_falloff: str = "squared",
    distance: Length | None = None,
    given_distance: Length | None = None,
    efficacy: str | Quantity | None = None,
    meter_k: float = 12.5,
    meter_c: float = 250.0,
) -> float: ...
@overload
def convert(
    value: Array,
    to: str,
    *,
    unit: str,
    shape: Shape | None = None,
    two_sided: bool = False,
    spot_flux: str = "falloff",
    spot_falloff: str = "squared",
    distance: Length | None = None,
    given_distance: Length | None = None,
    efficacy: str | Quantity | None = None,
    meter_k: float = 12.5,
    meter_c: float = 250.0,
) -> Array: ...
def convert(
    value: Any,
    to: str,
    *,
    unit: str | None = None,
    shape: Shape | None = None,
    two_sided: bool = False,
    spot_flux: str = "falloff",
    spot_falloff: str = "squared",
    distance: Length | None = None,
    given_distance: Length | None = None,
    efficacy: str | Quantity | None = None,
    meter_k: float = 12.5,
    meter_c: float = 250.0,
) -> Any:
    """What a light of that shape makes of a quantity, as a number in the unit `to`; of an array and its unit, an array.

        >>> convert("1500 lm", "nit", shape=Sphere("15 cm"))
        1688.686394038963

    two_sided: of flat shapes, the flux is that of both sides.
    spot_flux: "falloff" (the integral over what is rendered), "cone", "frostbite_pi", "isotropic".
    spot_falloff: "squared" (Frostbite, glTF), "smoothstep" (pbrt), "hard".
    distance: of an illuminance, given or wanted, from the light's origin along its axis; given_distance where both are illuminances.
    efficacy: in lm/W, between watts and lumens. Electrical watts: the lamp's; radiant watts: that of its spectrum.
    meter_k, meter_c: what ties EV to luminance, 2^EV K / 100, and to illuminance, 2^EV C / 100.

    What is needed and was not said is an Error that names it: SHAPE_MISSING, SIZE_MISSING, DISTANCE_MISSING, EFFICACY_MISSING,
    UNIT_UNSUITABLE, DIMENSION_MISMATCH, NUMBER_INVALID.
    """
    if isinstance(value, np.ndarray):
        given, si = dimension_of_unit(unit, "unit"), to_si(value, unit)
    else:
        q = quantity(value, unit)
        given, si = q.dimension, q.si
    wanted = dimension_of_unit(to, "to")
    distance_m = None if distance is None else si_of(distance, "length", "distance")
    conversion = _core.conversion(
        number_of(given),
        number_of(wanted),
        None if shape is None else shape._numbers(),
        two_sided,
        spot_flux,
        spot_falloff,
        distance_m if given_distance is None else si_of(given_distance, "length", "given_distance"),
        distance_m,
        None if efficacy is None else si_of(efficacy, "luminous efficacy", "efficacy"),
        meter_k,
        meter_c,
    )
    return in_unit(elementwise(_core.converted, conversion, value=si), wanted, to)
