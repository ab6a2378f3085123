"""Spectra against the CIE 1931 2 degree observer, summed at 1 nm; luminous efficacy; temperatures and efficacies of named sources."""

import dataclasses
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._arrays import Number, as_array, elementwise
from .errors import Error

K_CD_LM_W = 683.0
"""Luminous efficacy at 540 THz, lm/W, which defines the candela."""
K_M_LM_W = 683.002
"""The factor of sums over V(lambda), which is tabulated over wavelengths in air."""

Band = tuple[float, float]
VISIBLE: Band = (380.0, 780.0)
"""What figures of lamps count as light, in nm."""
WHOLE: Band = (0.0, math.inf)
"""All radiation."""


class Tristimulus(NamedTuple):
    """K_m times the sums over the colour-matching functions: y is the photometric twin of the spectrum's quantity."""

    x: float
    y: float
    z: float


@dataclasses.dataclass(frozen=True)
class Spectrum:
    """A quantity per nanometre at equal steps; between them it is linear, outside it is zero.

    Errors of its methods: SPECTRUM_INVALID unless the step is positive and there are two values or more, finite, none negative.
    """

    values: ArrayLike
    first_nm: float = 360.0
    step_nm: float = 1.0

    def _numbers(self) -> tuple[float, float, np.ndarray[tuple[int, ...], np.dtype[np.float64]]]:
        values = np.ascontiguousarray(as_array(self.values, "values"), np.float64)
        if values.ndim != 1:
            raise Error("SHAPE_MISMATCH", f"expected values in one row, found shape {values.shape}", field="values")
        return self.first_nm, self.step_nm, values

    def tristimulus(self) -> Tristimulus:
        """XYZ with Y in photometric units: cd/m2 of W/m2/sr/nm, lm of W/nm."""
        return Tristimulus(*_core.tristimulus(*self._numbers()))

    def efficacy(self, band: Band = VISIBLE) -> float:
        """Luminous efficacy of the radiation within a band, lm/W. Errors: EFFICACY_UNDEFINED for darkness, BAND_INVALID."""
        return _core.efficacy(*self._numbers(), *band)


def planck_radiance(wavelength_m: Number, kelvin: Number | float) -> Number:
    """Planck's law in W/(m2 sr m), c1L / (lambda^5 (exp(c2 / (lambda T)) - 1)), constants of SI 2019."""
    return elementwise(_core.planck_radiance, wavelength_m=wavelength_m, kelvin=kelvin)  # type: ignore[no-any-return]


def blackbody_luminance(kelvin: Number) -> Number:
    """Luminance of a Planckian radiator in cd/m2; 100 K to 100000 K."""
    return elementwise(_core.blackbody_luminance, kelvin=kelvin)  # type: ignore[no-any-return]


def blackbody_radiance(kelvin: Number) -> Number:
    """Radiance of a Planckian radiator, sigma T^4 / pi in W/m2/sr; 100 K to 100000 K."""
    return elementwise(_core.blackbody_radiance, kelvin=kelvin)  # type: ignore[no-any-return]


def blackbody_efficacy(kelvin: Number, band: Band = WHOLE) -> Number:
    """Luminous efficacy of a Planckian radiator's radiation within a band in nm, lm/W; 95.43 of all of it at most, at 6628 K."""
    return elementwise(_core.blackbody_efficacy, *map(float, band), kelvin=kelvin)  # type: ignore[no-any-return]


class TemperaturePreset(NamedTuple):
    """The colour temperatures that a source gives for a kind of light, in K."""

    name: str
    low_kelvin: float
    high_kelvin: float
    source: str


class EfficacyPreset(NamedTuple):
    """The efficacies that a source gives for a kind of lamp, in lm/W: of electricity, or of radiation within 380 nm to 780 nm."""

    name: str
    of_electricity: bool
    low_lm_w: float
    high_lm_w: float
    source: str


def temperature_preset(name: str) -> TemperaturePreset:
    """Error: PRESET_UNKNOWN, with the nearest names."""
    return TemperaturePreset(*_core.temperature_preset(name))


def temperature_presets() -> dict[str, TemperaturePreset]:
    """All that are known by a name."""
    return {row[0]: TemperaturePreset(*row) for row in _core.temperature_presets()}


def efficacy_preset(name: str) -> EfficacyPreset:
    """Error: PRESET_UNKNOWN, with the nearest names."""
    return EfficacyPreset(*_core.efficacy_preset(name))


class EfficacyPolicy(NamedTuple):
    """How watts become lumens: lumens per watt, what that was called, and its source ("" of a plain number)."""

    lm_w: float
    name: str
    source: str


def efficacy_policy(text: str) -> EfficacyPolicy:
    """What convert()'s efficacy may be as text.

        >>> efficacy_policy("15 lm/W").lm_w
        15.0
        >>> efficacy_policy("CIE D65").lm_w
        204.8
        >>> round(efficacy_policy("2856 K").lm_w, 2)
        16.45

    A number; the name of a preset that is one number; a Planckian radiator by its temperature, all that it radiates or, "2856 K visible",
    what of it lies within 380 nm to 780 nm. Errors: EFFICACY_AMBIGUOUS (a preset that is a range), PRESET_UNKNOWN, UNIT_UNKNOWN,
    DIMENSION_MISMATCH, TEMPERATURE_OUT_OF_RANGE.
    """
    return EfficacyPolicy(*_core.efficacy_policy(text))


def efficacy_presets() -> list[EfficacyPreset]:
    """All of them; a name may stand for both kinds of watts."""
    return [EfficacyPreset(*row) for row in _core.efficacy_presets()]
