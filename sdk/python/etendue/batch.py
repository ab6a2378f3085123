"""Many float32 values at once, on the machine's best instruction set: fractions of a nanosecond an element.

The functions of the same names in etendue.camera and etendue.colour, which compute in double, are the definition; each batch says how far
it may be from them for the same input. What is outside a function's domain becomes NaN, and how many there were comes with the result.
Arrays are taken without a copy where they are contiguous float32.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._arrays import as_array
from .camera import AnyCalibration, calibration_of
from .errors import Error

Floats = NDArray[np.float32]


def _call(kernel: Callable[..., Any], name: str, values: ArrayLike, width: int, *extra: float, dtype: type = np.float32) -> Any:
    array = as_array(values, name)
    if width > 1 and (array.ndim == 0 or array.shape[-1] != width):
        raise Error("SHAPE_MISMATCH", f"expected {name} of {width} numbers in its last extent, found shape {array.shape}", field=name)
    return kernel(np.ascontiguousarray(array, dtype).reshape(array.shape), *extra)


def scaled(values: ArrayLike, factor: float) -> Floats:
    """Values times a factor, within 1 ulp of the exact product; what is too large for a float becomes the largest."""
    return _call(_core.batch_scaled, "values", values, 1, float(factor))  # type: ignore[no-any-return]


def luminance_of_ev100(ev100: ArrayLike, calibration: AnyCalibration = "frostbite") -> tuple[Floats, int]:
    """Luminance in cd/m2 within 3e-7 EV, and how many were NaN."""
    return _call(_core.batch_luminance_of_ev100, "ev100", ev100, 1, calibration_of(calibration).meter_k)  # type: ignore[no-any-return]


def ev100_of_luminance(luminance_cd_m2: ArrayLike, calibration: AnyCalibration = "frostbite") -> tuple[Floats, int]:
    """EV100 within 2e-7 EV and half an ulp, and how many luminances were not positive and finite."""
    k = calibration_of(calibration).meter_k
    return _call(_core.batch_ev100_of_luminance, "luminance_cd_m2", luminance_cd_m2, 1, k)  # type: ignore[no-any-return]


def planckian(kelvin: ArrayLike) -> tuple[Floats, int]:
    """Chromaticities of 800 K to 100000 K and infinity, within 6e-7 in (u', v'), and how many temperatures were outside."""
    return _call(_core.batch_planckian, "kelvin", kelvin, 1)  # type: ignore[no-any-return]


def planckian_rgb(kelvin: ArrayLike) -> tuple[Floats, int]:
    """Linear Rec.709 of luminance 1 of these, within 6e-6 of the largest channel, and how many temperatures were outside."""
    return _call(_core.batch_planckian_rgb, "kelvin", kelvin, 1)  # type: ignore[no-any-return]


def to_colour_temperature(xy: ArrayLike) -> tuple[NDArray[np.float64], int]:
    """Temperature and Duv, of and in double: within .0001 K for 1000 K to 40000 K and |Duv| <= .02; and how many have none."""
    return _call(_core.batch_to_colour_temperature, "xy", xy, 2, dtype=np.float64)  # type: ignore[no-any-return]


def fit_colour_temperature(xy: ArrayLike) -> tuple[Floats, int]:
    """Temperature alone, roughly: within .32 % for 1000 K to 40000 K and |Duv| <= .02; and how many were refused."""
    return _call(_core.batch_fit_colour_temperature, "xy", xy, 2)  # type: ignore[no-any-return]


def srgb_to_linear(encoded: ArrayLike) -> Floats:
    """Linear light of sRGB (IEC 61966-2-1), within a relative 7e-7; below 0 the straight part goes on."""
    return _call(_core.batch_srgb_to_linear, "encoded", encoded, 1)  # type: ignore[no-any-return]


def linear_to_srgb(linear: ArrayLike) -> Floats:
    """The inverse of srgb_to_linear."""
    return _call(_core.batch_linear_to_srgb, "linear", linear, 1)  # type: ignore[no-any-return]
