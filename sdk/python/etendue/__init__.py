"""Physical lights: quantities with their units, colour temperature, cameras. Exact, and the same numbers as the C++ library bit for bit.

    >>> import etendue
    >>> etendue.quantity("1.5 klx")
    quantity('1500 lx')
    >>> etendue.colour.planckian(2856.0)
    Chromaticity(x=0.44753506298853964, y=0.4074278252447847)
    >>> sunny = etendue.camera.CameraSettings(f_number=16, shutter_s=1 / 125, iso=100)
    >>> round(etendue.camera.ev100(sunny), 3)
    14.966

Whatever cannot be answered is an etendue.Error with code, text, hint, field.
"""

from . import camera, colour
from .errors import Error
from .quantity import Quantity, dimensions, quantity

__all__ = ["Error", "Quantity", "camera", "colour", "dimensions", "quantity"]
