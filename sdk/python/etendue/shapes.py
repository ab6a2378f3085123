"""Shapes of lights, for convert(): what turns lumens into candelas, nits and lux.

A length is text, "15 cm", a Quantity, or a number of metres. An angle is text, "30 deg", or a Quantity: a bare number would leave open
whether it is in degrees. inner and outer are half angles, all others full ones.
"""

import dataclasses
from collections.abc import Sequence

from .errors import Error
from .quantity import Quantity, si_of

Length = str | float | Quantity
Angle = str | Quantity

_Numbers = tuple[str, list[float], str]


def _angle_rad(value: Angle, field: str) -> float:
    if not isinstance(value, (str, Quantity)):
        raise Error(
            "UNIT_MISSING", f"expected {field} with its unit, found {value!r}", hint=f'write for example "{value} deg"', field=field
        )
    return si_of(value, "angle", field)


def _length_m(value: Length, field: str) -> float:
    return si_of(value, "length", field)


@dataclasses.dataclass(frozen=True)
class Point:
    """The same intensity in all directions: I = flux / 4 pi."""

    def _numbers(self) -> _Numbers:
        return "point", [], ""


@dataclasses.dataclass(frozen=True)
class Spot:
    """A cone between whose half angles the intensity falls off. convert()'s spot_flux and spot_falloff say how its flux is counted."""

    inner: Angle
    outer: Angle

    def _numbers(self) -> _Numbers:
        return "spot", [_angle_rad(self.inner, "inner"), _angle_rad(self.outer, "outer")], ""


@dataclasses.dataclass(frozen=True)
class Frustum:
    """A pyramid of full angles with the same intensity all over it, as a projector has."""

    width_angle: Angle
    height_angle: Angle

    def _numbers(self) -> _Numbers:
        return "frustum", [_angle_rad(self.width_angle, "width_angle"), _angle_rad(self.height_angle, "height_angle")], ""


@dataclasses.dataclass(frozen=True)
class Distant:
    """The sun: a disk of that angular diameter, infinitely far away; illuminance is on a plane that faces it."""

    angular_diameter: Angle = "0 deg"

    def _numbers(self) -> _Numbers:
        return "distant", [_angle_rad(self.angular_diameter, "angular_diameter")], ""


@dataclasses.dataclass(frozen=True)
class Sphere:
    """A luminous sphere: L = flux / (pi 4 pi r^2)."""

    radius: Length

    def _numbers(self) -> _Numbers:
        return "sphere", [_length_m(self.radius, "radius")], ""


@dataclasses.dataclass(frozen=True)
class Disk:
    """A luminous disk; convert()'s two_sided says whether its flux is that of both sides."""

    radius: Length

    def _numbers(self) -> _Numbers:
        return "disk", [_length_m(self.radius, "radius")], ""


@dataclasses.dataclass(frozen=True)
class Rect:
    """A luminous rectangle."""

    width: Length
    height: Length

    def _numbers(self) -> _Numbers:
        return "rect", [_length_m(self.width, "width"), _length_m(self.height, "height")], ""


@dataclasses.dataclass(frozen=True)
class Polygon:
    """A luminous polygon, by its corners (x, y) in its own plane, of any winding."""

    points: Sequence[tuple[Length, Length]]

    def _numbers(self) -> _Numbers:
        return "polygon", [_length_m(x, "points") for point in self.points for x in point], ""


@dataclasses.dataclass(frozen=True)
class Tube:
    """A luminous cylinder, length between the centres of its caps: "round" (half spheres), "flat" or "none"."""

    length: Length
    radius: Length
    caps: str = "round"

    def _numbers(self) -> _Numbers:
        return "tube", [_length_m(self.length, "length"), _length_m(self.radius, "radius")], self.caps


@dataclasses.dataclass(frozen=True)
class Line:
    """A tube too thin to have a surface: I(theta) = flux sin(theta) / pi^2."""

    length: Length

    def _numbers(self) -> _Numbers:
        return "line", [_length_m(self.length, "length")], ""


@dataclasses.dataclass(frozen=True)
class Mesh:
    """A surface of known area, of one side, in m2, that emits equally in all directions."""

    area_m2: float

    def _numbers(self) -> _Numbers:
        return "mesh", [float(self.area_m2)], ""


@dataclasses.dataclass(frozen=True)
class Photometric:
    """An intensity distribution of a file (IES, EULUMDAT), by its flux over its axial intensity: "2.9 sr"."""

    flux_over_axial: str | Quantity

    def _numbers(self) -> _Numbers:
        return "photometric", [si_of(self.flux_over_axial, "solid angle", "flux_over_axial")], ""


@dataclasses.dataclass(frozen=True)
class Environment:
    """An even sky all around: a plane that lies under it has E = pi L."""

    def _numbers(self) -> _Numbers:
        return "environment", [], ""


Shape = Point | Spot | Frustum | Distant | Sphere | Disk | Rect | Polygon | Tube | Line | Mesh | Photometric | Environment


def shape_of_numbers(name: str, numbers: Sequence[float], caps: str) -> Shape:
    """The shape of that name, from numbers in SI."""
    angles = [Quantity(x, "angle") for x in numbers]
    match name:
        case "spot":
            return Spot(angles[0], angles[1])
        case "frustum":
            return Frustum(angles[0], angles[1])
        case "distant":
            return Distant(angles[0])
        case "sphere":
            return Sphere(numbers[0])
        case "disk":
            return Disk(numbers[0])
        case "rect":
            return Rect(numbers[0], numbers[1])
        case "tube":
            return Tube(numbers[0], numbers[1], caps)
        case "line":
            return Line(numbers[0])
        case "polygon":
            return Polygon(list(zip(numbers[::2], numbers[1::2], strict=True)))
        case "mesh":
            return Mesh(numbers[0])
        case "photometric":
            return Photometric(Quantity(numbers[0], "solid angle"))
        case "environment":
            return Environment()
    return Point()
