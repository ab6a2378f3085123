"""Light quantities into one another, and the formula behind it."""

import dataclasses
from typing import Any, NamedTuple, overload

from . import _core
from ._arrays import Array, elementwise
from .camera import CameraSettings, ev100, ev_s
from .errors import Error
from .quantity import Quantity, quantity, si_of, unit_named
from .shapes import Length, Shape
from .spectrum import efficacy_policy
from .text import parse


class _Given(NamedTuple):
    """What was given: numbers in a unit, and what was written beside them."""

    numbers: Any
    unit: _core.NamedUnit
    distance: Quantity | None
    efficacy: Quantity | None


def _given(value: Any, unit: str | None) -> _Given:
    if isinstance(value, str) and unit is None:
        kind, *numbers = _core.parse(value)
        if kind == "quantity":  # in the unit that was written, so that nothing is rounded on the way to SI
            _, _, distance_m, lm_w, number, named = numbers
            return _Given(
                number,
                named,
                None if distance_m is None else Quantity(distance_m, "length"),
                None if lm_w is None else Quantity(lm_w, "luminous efficacy"),
            )
        written = parse(value)
        if isinstance(written, CameraSettings):
            written = (
                Quantity(ev_s(written), "exposure value without ISO")
                if written.iso is None
                else Quantity(ev100(written), "exposure value at ISO 100")
            )
        if not isinstance(written, Quantity):
            raise Error(
                "DIMENSION_MISMATCH",
                f"expected a quantity, found a colour: {value!r}",
                hint="etendue.colour converts colours",
                field="value",
            )
        value = written
    if isinstance(value, (str, float, int, Quantity)):
        q = quantity(value, unit)
        return _Given(q.si, unit_named(q.unit, "unit"), None, None)
    return _Given(value, unit_named(unit, "unit"), None, None)


def lm_w_of(efficacy: str | Quantity) -> float:
    """Lumens per watt of what efficacy says: a quantity, or a policy as text."""
    if isinstance(efficacy, str):
        return efficacy_policy(efficacy).lm_w
    return si_of(efficacy, "luminous efficacy", "efficacy")


def _setup(
    given: _Given,
    shape: Shape | None,
    two_sided: bool,
    spot_flux: str,
    spot_falloff: str,
    distance: Length | None,
    given_distance: Length | None,
    efficacy: str | Quantity | None,
    meter_k: float,
    meter_c: float,
) -> _core.LightSetup:
    wanted = distance if distance is not None else given.distance
    measured = given.distance or (given_distance if given_distance is not None else distance)
    lamp = efficacy if efficacy is not None else given.efficacy
    return _core.light_setup(
        None if shape is None else shape._numbers(),
        two_sided,
        spot_flux,
        spot_falloff,
        None if measured is None else si_of(measured, "length", "given_distance"),
        None if wanted is None else si_of(wanted, "length", "distance"),
        None if lamp is None else lm_w_of(lamp),
        meter_k,
        meter_c,
    )


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
        >>> convert("15 klx @ 2 m", "cd", shape=Point())
        60000.0
        >>> convert(np.array([400.0, 800.0]), "cd", unit="lm", shape=Point())
        array([31.83098862, 63.66197724])

    two_sided: of flat shapes, the flux is that of both sides.
    spot_flux: "falloff" (the integral over what is rendered), "cone", "frostbite_pi", "isotropic".
    spot_falloff: "squared" (Frostbite, glTF), "smoothstep" (pbrt), "hard".
    distance: of an illuminance, given or wanted, from the light's origin along its axis; given_distance where both are illuminances.
    efficacy: between watts and lumens: "15 lm/W", a preset's name such as "CIE D65", "2856 K" (etendue.spectrum.efficacy_policy).
    Electrical watts: the lamp's; radiant watts: that of its spectrum.
    meter_k, meter_c: what ties EV to luminance, 2^EV K / 100, and to illuminance, 2^EV C / 100.

    What is needed and was not said is an Error that names it: SHAPE_MISSING, SIZE_MISSING, DISTANCE_MISSING, EFFICACY_MISSING,
    UNIT_UNSUITABLE, DIMENSION_MISMATCH, NUMBER_INVALID.
    """
    given = _given(value, unit)
    setup = _setup(given, shape, two_sided, spot_flux, spot_falloff, distance, given_distance, efficacy, meter_k, meter_c)
    wanted = unit_named(to, "to")
    conversion = _core.conversion(given.unit, wanted, setup)
    return elementwise(_core.converted, conversion, value=given.numbers)


class Symbol(NamedTuple):
    """A letter of a formula: its value in SI, and its unit, "" for a pure number."""

    name: str
    value: float
    unit: str


@dataclasses.dataclass(frozen=True)
class Explanation:
    """The formula behind a result, its symbols, and why it is so: conventions and sources. str() is all of it, for people."""

    formula: str
    symbols: tuple[Symbol, ...]
    notes: tuple[str, ...]
    _text: str = dataclasses.field(repr=False)

    def __str__(self) -> str:
        return self._text


def explain(
    value: str | float | Quantity | CameraSettings,
    to: str = "EV",
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
) -> Explanation:
    """The formula that convert() computes for the same arguments, or that gives a camera its exposure value.

    >>> explain("1500 lm", "nit", shape=Sphere("15 cm")).formula
    'luminance = flux/(4*pi^2*radius^2)'
    """
    if isinstance(value, CameraSettings):
        formula, symbols, notes, text = _core.explain_camera(value._numbers)
    else:
        given = _given(value, unit)
        setup = _setup(given, shape, two_sided, spot_flux, spot_falloff, distance, given_distance, efficacy, meter_k, meter_c)
        formula, symbols, notes, text = _core.explain_conversion(given.numbers, given.unit, unit_named(to, "to"), setup)
        if isinstance(efficacy, str) and (policy := efficacy_policy(efficacy)).source and any(name == "efficacy" for name, _, _ in symbols):
            notes = [*notes, f"efficacy of {policy.name}: {policy.lm_w} lm/W; {policy.source}"]
            text += f"\n  {notes[-1]}"
    return Explanation(formula, tuple(Symbol(*s) for s in symbols), tuple(notes), text)
