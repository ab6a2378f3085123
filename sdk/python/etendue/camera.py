"""Cameras: exposure values, calibrations, what reaches the sensor.

EV100 = log2(N^2 / t) - log2(S / 100). Functions of an exposure value or of a luminance take numbers, and arrays of float64 or float32.
A calibration is a Calibration or the name of one. Equations: Lagarde and de Rousiers, Moving Frostbite to PBR 3.0, sections 4.3 and 5.1.
"""

import dataclasses
from typing import NamedTuple

from . import _core
from ._arrays import Number, elementwise

_Numbers = tuple[float, float, float, float, bool]


@dataclasses.dataclass(frozen=True)
class CameraSettings:
    """What is set on a camera: one of f_number and t_stop; one of shutter_s and shutter_angle_rad (with frames_per_s).

    iso: S, arithmetic. nd_density: optical density D of filters, which let 10^-D through. compensation_stop: positive is brighter.
    """

    f_number: float | None = None
    t_stop: float | None = None
    shutter_s: float | None = None
    shutter_angle_rad: float | None = None
    frames_per_s: float | None = None
    iso: float | None = None
    nd_density: float = 0.0
    compensation_stop: float = 0.0

    @property
    def _numbers(
        self,
    ) -> tuple[float | None, float | None, float | None, float | None, float | None, float | None, float, float]:
        return (
            self.f_number,
            self.t_stop,
            self.shutter_s,
            self.shutter_angle_rad,
            self.frames_per_s,
            self.iso,
            self.nd_density,
            self.compensation_stop,
        )


@dataclasses.dataclass(frozen=True)
class Calibration:
    """How somebody ties EV100 to luminance and to pixel values.

    meter_k: K in cd s/m2, L = 2^EV100 K / 100. meter_c: C in lx s, E = 2^EV100 C / 100. sensor: H S of a pixel value of 1, lx s.
    lens_q: H = q L t / N^2. aperture_counts: False where exposure comes from t and S alone.
    """

    name: str = ""
    meter_k: float = 12.5
    meter_c: float = 250.0
    sensor: float = 78.0
    lens_q: float = 0.65
    aperture_counts: bool = True
    source: str = ""

    @property
    def _numbers(self) -> _Numbers:
        return (self.meter_k, self.meter_c, self.sensor, self.lens_q, self.aperture_counts)


AnyCalibration = str | Calibration


def calibration_of(named_or_given: AnyCalibration) -> Calibration:
    """The calibration itself, or the one of that name."""
    return calibration(named_or_given) if isinstance(named_or_given, str) else named_or_given


def _numbers_of(named_or_given: AnyCalibration) -> _Numbers:
    return calibration_of(named_or_given)._numbers


def calibration(name: str) -> Calibration:
    """The calibration of that name: "frostbite", "filament", "unreal", "hdrp"...; calibrations() has all.

    Error: CALIBRATION_UNKNOWN, with the nearest names.
    """
    return Calibration(*_core.calibration(name))


def calibrations() -> dict[str, Calibration]:
    """All that are known by a name."""
    return {numbers[0]: Calibration(*numbers) for numbers in _core.calibrations()}


def shutter_time(camera: CameraSettings) -> float:
    """Time t in s.

    Errors, of this and the next four: CAMERA_SETTING_MISSING, CAMERA_SETTING_AMBIGUOUS, CAMERA_SETTING_INVALID.
    """
    return _core.shutter_time(camera._numbers)


def ev_s(camera: CameraSettings) -> float:
    """EV_S = log2(N^2 / t): what aperture and shutter alone say."""
    return _core.ev_s(camera._numbers)


def ev100(camera: CameraSettings) -> float:
    """EV100 = log2(N^2 / t) - log2(S / 100), without filters and compensation: they are no setting of a light meter."""
    return _core.ev100(camera._numbers)


def effective_ev100(camera: CameraSettings) -> float:
    """The EV100 of a camera without filters and compensation that gives the same picture: EV100 + D log2(10) - EC."""
    return _core.effective_ev100(camera._numbers)


def exposure_of(camera: CameraSettings, calibration: AnyCalibration = "frostbite") -> float:
    """What cd/m2 are multiplied by to become pixel values, filters and compensation included."""
    return _core.exposure_of(camera._numbers, _numbers_of(calibration))


def luminance_of_ev100(ev100: Number, calibration: AnyCalibration = "frostbite") -> Number:
    """Luminance in cd/m2 of a reflected-light meter's reading, 2^EV100 K / 100."""
    return elementwise(_core.luminance_of_ev100, _numbers_of(calibration), ev100=ev100)  # type: ignore[no-any-return]


def illuminance_of_ev100(ev100: Number, calibration: AnyCalibration = "frostbite") -> Number:
    """Illuminance in lx of an incident-light meter's reading, 2^EV100 C / 100."""
    return elementwise(_core.illuminance_of_ev100, _numbers_of(calibration), ev100=ev100)  # type: ignore[no-any-return]


def ev100_of_luminance(luminance_cd_m2: Number, calibration: AnyCalibration = "frostbite") -> Number:
    """log2(L 100 / K). Error: LUMINANCE_NOT_POSITIVE."""
    return elementwise(_core.ev100_of_luminance, _numbers_of(calibration), luminance_cd_m2=luminance_cd_m2)  # type: ignore[no-any-return]


def ev100_of_illuminance(illuminance_lx: Number, calibration: AnyCalibration = "frostbite") -> Number:
    """log2(E 100 / C). Error: ILLUMINANCE_NOT_POSITIVE."""
    return elementwise(_core.ev100_of_illuminance, _numbers_of(calibration), illuminance_lx=illuminance_lx)  # type: ignore[no-any-return]


def saturation_of_ev100(ev100: Number, calibration: AnyCalibration = "frostbite") -> Number:
    """The luminance in cd/m2 whose pixel value is 1: 1.2 2^EV100 with 78 and q = .65."""
    return elementwise(_core.saturation_of_ev100, _numbers_of(calibration), ev100=ev100)  # type: ignore[no-any-return]


def exposure_of_ev100(ev100: Number, calibration: AnyCalibration = "frostbite") -> Number:
    """What cd/m2 are multiplied by to become pixel values: the reciprocal of saturation_of_ev100."""
    return elementwise(_core.exposure_of_ev100, _numbers_of(calibration), ev100=ev100)  # type: ignore[no-any-return]


def emissive_luminance(ev100: Number, compensation_stop: Number | float, calibration: AnyCalibration = "frostbite") -> Number:
    """Luminance in cd/m2 of an emitter that follows the camera, 2^(EV100 + compensation) K / 100."""
    return elementwise(  # type: ignore[no-any-return]
        _core.emissive_luminance, _numbers_of(calibration), ev100=ev100, compensation_stop=compensation_stop
    )


def bloom_compensation(calibration: AnyCalibration = "frostbite") -> float:
    """The compensation in stops from which an emitter saturates the sensor: 3.263 with 78, q = .65 and K = 12.5."""
    return _core.bloom_compensation(_numbers_of(calibration))


def least_ev100_that_stores(luminance_cd_m2: Number, largest_value: Number | float, calibration: AnyCalibration = "frostbite") -> Number:
    """The least EV100 at which this luminance, once exposed, fits a format whose largest value this is (65504 for half)."""
    return elementwise(  # type: ignore[no-any-return]
        _core.least_ev100_that_stores, _numbers_of(calibration), luminance_cd_m2=luminance_cd_m2, largest_value=largest_value
    )


def lens_q(transmission: float = 0.9, vignetting: float = 0.98, angle_rad: float = 0.17453292519943295) -> float:
    """Quotient q = pi/4 transmission vignetting cos^4(angle off the axis) of ISO 12232: .6516 for a typical lens at 10 degrees."""
    return float(elementwise(_core.lens_q, transmission=transmission, vignetting=vignetting, angle_rad=angle_rad))


class SensorExposure(NamedTuple):
    """On the sensor: illuminance in lx, and exposure H in lx s."""

    illuminance_lx: float
    exposure_lx_s: float


def sensor_exposure(luminance_cd_m2: float, camera: CameraSettings, lens_q: float = 0.65) -> SensorExposure:
    """Image-plane illuminance q L / N^2 and exposure H = E t, behind the filters."""
    return SensorExposure(*_core.sensor_exposure(float(luminance_cd_m2), camera._numbers, lens_q))


def cell_energy(
    exposure_lx_s: Number, *, width_m: float = 0.036, height_m: float = 0.024, columns: float = 5760.0, rows: float = 3240.0
) -> Number:
    """Energy on one cell of a sensor in lm s: H width height / (columns rows)."""
    return elementwise(_core.cell_energy, width_m, height_m, columns, rows, exposure_lx_s=exposure_lx_s)  # type: ignore[no-any-return]


class SunnySixteen(NamedTuple):
    """With t = 1/S, the aperture for a sky."""

    f_number: float
    sky: str
    shadows: str


def sunny_sixteen() -> list[SunnySixteen]:
    """The rule's table."""
    return [SunnySixteen(*row) for row in _core.sunny_sixteen()]
