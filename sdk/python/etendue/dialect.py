"""What other programs' numbers for a light mean, from one to another, with what is lost on the way.

    >>> lamp = StatedLight(Spot("0 deg", "30 deg"), 1000, Form("lm"))
    >>> round(emission("frostbite", lamp).rgb.g, 1)
    318.3
    >>> round(translate(lamp, "frostbite", "threejs", Form("cd"))[0].amount, 1)
    318.3

Dialects: "blender", "gltf_spec", "gltf_compat", "gltf_raw", "usd", "hdrp", "unreal", "filament", "frostbite", "godot", "threejs", "pbrt",
"vray"; dialects() says where each rule is from. Errors: DIALECT_UNKNOWN, DIALECT_HAS_NO_SUCH_LIGHT, UNIT_UNSUITABLE,
METRES_PER_UNIT_MISSING, EFFICACY_MISSING, SIZE_MISSING, NUMBER_INVALID, COLOUR_INVALID.
"""

import dataclasses
from collections.abc import Iterable
from typing import Any, NamedTuple

from . import _core
from .colour import Rgb
from .conversion import lm_w_of
from .quantity import Quantity, si_of
from .shapes import Shape, shape_of_numbers


class Dialect(NamedTuple):
    """A program, where its rules are from, and what of them no public source was read for."""

    name: str
    program: str
    source: str
    unverified: str


class Loss(NamedTuple):
    """What the other program cannot say, and what that does."""

    what: str
    effect: str


@dataclasses.dataclass(frozen=True)
class Form:
    """How an amount is meant, besides its number.

    unit: one of units_of(); "" is the first of these. exposure_stop and normalize are USD's. reflector: HDRP's,
    and Filament's FOCUSED_SPOT.
    metres_per_unit: required of USD, but for distant and dome lights. efficacy: required of Blender's watts, as convert() takes it.
    """

    unit: str = ""
    exposure_stop: float = 0.0
    normalize: bool = False
    reflector: bool = False
    metres_per_unit: float | None = None
    efficacy: str | Quantity | None = None

    def _parts(self) -> Any:
        efficacy = None if self.efficacy is None else lm_w_of(self.efficacy)
        return self.unit, self.exposure_stop, self.normalize, self.reflector, self.metres_per_unit, efficacy


@dataclasses.dataclass(frozen=True)
class StatedLight:
    """A light in a program's own terms.

    Numbers for lengths are in its own unit; colour is what it multiplies by; range: where its light ends.
    """

    shape: Shape
    amount: float
    form: Form = Form()
    colour: tuple[float, float, float] = (1.0, 1.0, 1.0)
    two_sided: bool = False
    range: float | None = None

    def _parts(self) -> Any:
        r, g, b = map(float, self.colour)
        return self.shape._numbers(), float(self.amount), self.form._parts(), (r, g, b), self.two_sided, self.range


class Emitted(NamedTuple):
    """What a stated light sends out.

    kind: of rgb, "intensity" (cd, on the axis), "luminance" (cd/m2), "illuminance" (lx, of a true direction), "line" (cd, across).
    flux_lm: 0 where there is no total.
    """

    kind: str
    rgb: Rgb
    flux_lm: float
    losses: tuple[Loss, ...]


class Spread(NamedTuple):
    """What lumens typed into a program's spot become."""

    program: str
    stated: str
    divides_by: str
    candela: float


def dialects() -> list[Dialect]:
    """Every program whose lights are known."""
    return [Dialect(*row) for row in _core.dialects()]


def units_of(dialect: str, shape: Shape) -> list[str]:
    """The units in which a program states lights of this shape, the usual one first; none: it has no such light."""
    return _core.dialect_units(dialect, shape._numbers())


def emission(dialect: str, light: StatedLight) -> Emitted:
    """What a program's light sends out, in photometric units."""
    kind, rgb, flux_lm, losses = _core.dialect_emission(dialect, light._parts())
    return Emitted(kind, Rgb(*rgb), flux_lm, tuple(Loss(*loss) for loss in losses))


def translate(light: StatedLight, from_dialect: str, to_dialect: str, form: Form | None = None) -> tuple[StatedLight, list[Loss]]:
    """The same light in another program's terms, in the form wanted there, and what is lost."""
    parts, losses = _core.dialect_translated(light._parts(), from_dialect, to_dialect, (form or Form())._parts())
    numbers, amount, (unit, stop, normalize, reflector, metres_per_unit, lm_w), colour, two_sided, end = parts
    efficacy = None if lm_w is None else Quantity(lm_w, "luminous efficacy")
    written = Form(unit, stop, normalize, reflector, metres_per_unit, efficacy)
    stated = StatedLight(shape_of_numbers(*numbers), amount, written, colour, two_sided, end)
    return stated, [Loss(*loss) for loss in losses]


class Suspicion(NamedTuple):
    """Why lights seem to be unitless, and what to do about it."""

    text: str
    hint: str


def suspected_compat_lights(generator: str, lights: Iterable[tuple[Shape, float]]) -> Suspicion | None:
    """Whether Blender's exporter seems to have written a glTF file's lights without the 683 lm/W that the format asks for.

    generator: the file's asset.generator. lights: its points and spots in cd, its suns (Distant) in lx.

        >>> suspected_compat_lights("Khronos glTF Blender I/O v4.2", [(Point(), 54.35)]) is None
        False
        >>> suspected_compat_lights("Khronos glTF Blender I/O v4.2", [(Point(), 5435.0)]) is None
        True

    Small lamps alone can look the same.
    """
    found = _core.suspected_compat_lights(generator, [(shape._numbers(), float(amount)) for shape, amount in lights])
    return None if found is None else Suspicion(*found)


def interoperability_spread(flux: str | Quantity, inner: str | Quantity, outer: str | Quantity) -> list[Spread]:
    """The same lumens typed into each program's spot of these half angles: candela on the axis."""
    lumens = si_of(flux, "luminous flux", "flux")
    rows = _core.interoperability_spread(lumens, si_of(inner, "angle", "inner"), si_of(outer, "angle", "outer"))
    return [Spread(*row) for row in rows]
