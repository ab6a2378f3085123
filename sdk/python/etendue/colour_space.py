"""Linear RGB spaces and the matrices between them, in double; what becomes of the white point is always said.

Spaces by name: "rec709", "rec2020", "p3", "acescg". Adaptations: "none", "xyz_scaling", "von_kries", "bradford", "cat02", "cat16".
Matrices are for columns: matrix @ rgb, or pixels @ matrix.T. Errors: COLOUR_SPACE_UNKNOWN and ADAPTATION_UNKNOWN, with the nearest names,
WHITE_POINT_INVALID.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _core
from .colour import Chromaticity, Rgb

Matrix = NDArray[np.float64]
Xy = Chromaticity | tuple[float, float]


class ColourSpace(NamedTuple):
    """A linear RGB space by its primaries and its white."""

    name: str
    red: Chromaticity
    green: Chromaticity
    blue: Chromaticity
    white: Chromaticity
    source: str


def colour_space(name: str) -> ColourSpace:
    """The space of that name."""
    found, red, green, blue, white, source = _core.colour_space(name)
    return ColourSpace(found, Chromaticity(*red), Chromaticity(*green), Chromaticity(*blue), Chromaticity(*white), source)


def colour_spaces() -> list[str]:
    """Every name."""
    return _core.colour_spaces()


def rgb_to_xyz(space: str) -> Matrix:
    """Columns are the primaries, scaled so that R = G = B = 1 is the white with Y = 1."""
    return _core.rgb_to_xyz(space)


def xyz_to_rgb(space: str) -> Matrix:
    """The inverse of rgb_to_xyz."""
    return _core.xyz_to_rgb(space)


def conversion(from_space: str, to_space: str, adaptation: str) -> Matrix:
    """Linear RGB of one space to that of another."""
    return _core.space_conversion(from_space, to_space, adaptation)


def adaptation_matrix(from_white: Xy, to_white: Xy, adaptation: str) -> Matrix:
    """XYZ seen under one white to XYZ that looks the same under the other."""
    return _core.adaptation_matrix((from_white[0], from_white[1]), (to_white[0], to_white[1]), adaptation)


def white_balance(scene_white: Xy, space: str, adaptation: str) -> Matrix:
    """What linear RGB of a space is multiplied by so that the scene's white becomes the space's."""
    return _core.white_balance((scene_white[0], scene_white[1]), space, adaptation)


class InSpace(NamedTuple):
    """A colour in a space; out of gamut a channel is negative, and stays so."""

    rgb: Rgb
    in_gamut: bool


def to_space(xy: Xy, space: str, *, adaptation: str = "none", observer_white: Xy = (0.0, 0.0)) -> InSpace:
    """A chromaticity with Y = 1 in a space, as it is or for an eye adapted to a white.

    Errors: CHROMATICITY_INVALID, WHITE_POINT_INVALID.
    """
    r, g, b, in_gamut = _core.to_space((xy[0], xy[1]), space, adaptation, (observer_white[0], observer_white[1]))
    return InSpace(Rgb(r, g, b), in_gamut)
