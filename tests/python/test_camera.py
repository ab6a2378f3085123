"""Cameras: the sunny sixteen, calibrations, and settings that are missing or wrong."""

import math

import numpy as np
import pytest

import etendue
from etendue import camera
from etendue.camera import CameraSettings

SUNNY = CameraSettings(f_number=16, shutter_s=1 / 125, iso=100)


def test_sunny_sixteen() -> None:
    assert camera.ev100(SUNNY) == pytest.approx(math.log2(256 * 125), rel=1e-15)
    assert [row.f_number for row in camera.sunny_sixteen()] == sorted((row.f_number for row in camera.sunny_sixteen()), reverse=True)


def test_calibrations() -> None:
    assert camera.luminance_of_ev100(15.0) == 4096
    assert camera.illuminance_of_ev100(15.0) == pytest.approx(2.5 * 2**15)
    # 78 / (100 .65) = 1.2: where a picture saturates.
    assert camera.exposure_of_ev100(0.0, "frostbite") == pytest.approx(1 / 1.2)
    assert camera.exposure_of(SUNNY) == pytest.approx(camera.exposure_of_ev100(camera.ev100(SUNNY)))
    assert camera.Calibration(lens_q=0.5).meter_k == 12.5
    assert set(camera.calibrations()) >= {"frostbite", "filament", "unreal", "hdrp", "usd", "pbrt"}
    with pytest.raises(etendue.Error) as caught:
        camera.calibration("frostbit")
    assert caught.value.code == "CALIBRATION_UNKNOWN"
    assert "frostbite" in caught.value.hint + caught.value.text


def test_cine_settings() -> None:
    # 180 degrees at 24 frames a second are 1/48 s; ND .9 takes 2.99 stops.
    cine = CameraSettings(t_stop=2.8, shutter_angle_rad=math.pi, frames_per_s=24, iso=800, nd_density=0.9)
    assert camera.shutter_time(cine) == pytest.approx(1 / 48)
    assert camera.effective_ev100(cine) - camera.ev100(cine) == pytest.approx(0.9 * math.log2(10))


def test_arrays() -> None:
    ev = np.linspace(-6, 20, 53)
    assert np.allclose(camera.ev100_of_luminance(camera.luminance_of_ev100(ev)), ev, atol=1e-12)
    with pytest.raises(etendue.Error) as caught:
        camera.ev100_of_luminance(np.array([1.0, 0.0]))
    assert (caught.value.code, caught.value.index) == ("LUMINANCE_NOT_POSITIVE", (1,))


@pytest.mark.parametrize(
    ("settings", "code"),
    [
        (CameraSettings(f_number=0, shutter_s=1, iso=100), "CAMERA_SETTING_INVALID"),
        (CameraSettings(f_number=8, shutter_s=-1, iso=100), "CAMERA_SETTING_INVALID"),
        (CameraSettings(f_number=8, shutter_s=1, iso=math.nan), "CAMERA_SETTING_INVALID"),
        (CameraSettings(f_number=8, shutter_s=1), "CAMERA_SETTING_MISSING"),
        (CameraSettings(f_number=8, t_stop=9, shutter_s=1, iso=100), "CAMERA_SETTING_AMBIGUOUS"),
    ],
)
def test_bad_settings(settings: CameraSettings, code: str) -> None:
    with pytest.raises(etendue.Error) as caught:
        camera.ev100(settings)
    assert caught.value.code == code
