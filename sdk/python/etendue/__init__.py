"""Physical lights: quantities with their units, colour temperature, cameras. Exact, and the same numbers as the C++ library bit for bit.

    >>> import etendue
    >>> etendue.convert("1500 lm", "nit", shape=etendue.Sphere("15 cm"))
    1688.686394038963
    >>> etendue.quantity("1.5 klx")
    quantity('1500 lx')
    >>> etendue.colour.planckian(2856.0)
    Chromaticity(x=0.44753514422783053, y=0.40742828970434986)
    >>> sunny = etendue.camera.CameraSettings(f_number=16, shutter_s=1 / 125, iso=100)
    >>> round(etendue.camera.ev100(sunny), 3)
    14.966

Whatever cannot be answered is an etendue.Error with code, text, hint, field.
"""

from . import (
    batch,
    camera,
    colour,
    colour_space,
    dialect,
    false_colour,
    hdri,
    material_fit,
    metering,
    normal_filter,
    photometry,
    pixel,
    plausibility,
    spectrum,
)
from .conversion import Explanation, convert, explain
from .errors import ClampedWarning, Error
from .quantity import Quantity, Unit, dimensions, quantity, units
from .shapes import (
    Disk,
    Distant,
    Environment,
    Frustum,
    Line,
    Mesh,
    Photometric,
    Point,
    Polygon,
    Rect,
    Shape,
    Sphere,
    Spot,
    Tube,
)
from .text import Written, WrittenQuantity, parse

__all__ = [
    "ClampedWarning",
    "Disk",
    "Distant",
    "Environment",
    "Error",
    "Explanation",
    "Frustum",
    "Line",
    "Mesh",
    "Photometric",
    "Point",
    "Polygon",
    "Quantity",
    "Rect",
    "Shape",
    "Sphere",
    "Spot",
    "Tube",
    "Unit",
    "Written",
    "WrittenQuantity",
    "batch",
    "camera",
    "colour",
    "colour_space",
    "convert",
    "dialect",
    "dimensions",
    "explain",
    "false_colour",
    "hdri",
    "material_fit",
    "metering",
    "normal_filter",
    "parse",
    "photometry",
    "pixel",
    "plausibility",
    "quantity",
    "spectrum",
    "units",
]
