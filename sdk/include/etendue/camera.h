// A photographic camera: settings, exposure values, calibrations, what reaches the sensor.
//   auto ev = ev100({.f_number = 16, .shutter_s = 1.0 / 125, .iso = 100});   // 14.966, a sunny day
//   pixel = luminance * exposure_of_ev100(*ev, *calibration("filament"));
// Equations: Lagarde and de Rousiers, Moving Frostbite to PBR 3.0, sections 4.3 and 5.1.
#pragma once

#include "etendue/result.h"
#include "etendue/units.h"

#include <optional>
#include <span>
#include <string_view>

namespace etendue {

// What is set on a camera. One of f_number and t_stop; one of shutter_s and shutter_angle_rad (with frames_per_s).
// The T-stop T = N / sqrt(transmission of the lens) counts as N in an exposure value, as cinematographers use it; where light that
// reaches the sensor is computed the lens' loss is then not counted a second time.
struct CameraSettings {
  std::optional<double> f_number;           // N
  std::optional<double> t_stop;             // T
  std::optional<double> shutter_s;          // t
  std::optional<double> shutter_angle_rad;  // t = angle / (2 pi frames_per_s)
  std::optional<double> frames_per_s;
  std::optional<double> iso;     // S, arithmetic
  double nd_density = 0;         // optical density D of the filters: they let 10^-D through. Sums for stacked filters
  double compensation_stop = 0;  // EC: positive makes the picture brighter
};

// t in seconds. All these name the setting that is missing (CAMERA_SETTING_MISSING), stated twice (CAMERA_SETTING_AMBIGUOUS) or not a
// positive finite number (CAMERA_SETTING_INVALID).
Result<double> shutter_time(const CameraSettings& camera);
// log2(N^2 / t): what aperture and shutter alone say.
Result<double> ev_s(const CameraSettings& camera);
// EV100 = log2(N^2 / t) - log2(S / 100), eq 67. Filters and compensation are not in it: they are no setting of a light meter.
Result<double> ev100(const CameraSettings& camera);
// The EV100 of a camera without filters and compensation that gives the same picture: EV100 + D log2(10) - EC (eq 68).
Result<double> effective_ev100(const CameraSettings& camera);

// How somebody ties EV100 to luminance and to pixel values.
struct Calibration {
  std::string_view name;
  double meter_k = 12.5;        // cd s/m2, reflected-light meter: L = 2^EV100 K / 100
  double meter_c = 250;         // lx s, incident-light meter with a dome: E = 2^EV100 C / 100
  double sensor = 78;           // H S of a pixel value of 1, lx s: 78 for saturation-based speed
  double lens_q = 0.65;         // H = q L t / N^2, eq 70
  bool aperture_counts = true;  // false: exposure from t and S alone
  std::string_view source;
};
// "frostbite", "filament", "unreal", "hdrp", "hdrp_perfect_lens", "usd", "pbrt", "iso_sbs", "iso_sos".
std::span<const Calibration> calibrations();
// CALIBRATION_UNKNOWN, with the nearest names.
Result<Calibration> calibration(std::string_view name);

// Luminance of a reflected-light meter's reading, illuminance of an incident-light meter's. Never infinite: EV beyond +-1000 count as that.
double luminance_of_ev100(double ev100, const Calibration& calibration);
double illuminance_of_ev100(double ev100, const Calibration& calibration);
// Only of positive finite numbers: LUMINANCE_NOT_POSITIVE, ILLUMINANCE_NOT_POSITIVE.
Result<double> ev100_of_luminance(double luminance_cd_m2, const Calibration& calibration);
Result<double> ev100_of_illuminance(double illuminance_lx, const Calibration& calibration);

// The luminance whose pixel value is 1: 2^EV100 sensor / (100 q), eq 75 (1.2 2^EV100 for 78 and .65).
double saturation_of_ev100(double ev100, const Calibration& calibration);
// What cd/m2 are multiplied by to become pixel values: the reciprocal of the above.
double exposure_of_ev100(double ev100, const Calibration& calibration);
// The same for a camera with its filters and compensation. Equal to exposure_of_ev100(effective_ev100(camera)), but for two cases: a T-stop
// brings the lens' transmission with it (that of typical_lens is taken out of q), and a calibration may not count the aperture.
Result<double> exposure_of(const CameraSettings& camera, const Calibration& calibration);

// The lens of ISO 12232: q = pi/4 transmission vignetting cos^4(angle off the axis).
struct Lens {
  double transmission = 0.9, vignetting = 0.98, angle_rad = 10 * pi / 180;
};
inline constexpr Lens typical_lens{};
double lens_q(const Lens& lens);  // .6516 for the typical one, which is rounded to .65

// Image-plane illuminance E = q L / N^2 in lx and exposure H = E t in lx s (eq 70, 71), behind the filters.
struct SensorExposure {
  double illuminance_lx, exposure_lx_s;
};
Result<SensorExposure> sensor_exposure(double luminance_cd_m2, const CameraSettings& camera, double lens_q);

// Energy on one cell of a sensor, Q = H A in lm s (eq 76), A = width height / (columns rows). CAMERA_SETTING_INVALID.
struct Sensor {
  double width_m = 0.036, height_m = 0.024;
  double columns = 5760, rows = 3240;
};
Result<double> cell_energy(double exposure_lx_s, const Sensor& sensor);

// Exposure is often multiplied in before a picture is stored in a format with a largest value (65504 for half): the least EV100 at which
// this luminance still fits.
double least_ev100_that_stores(double luminance_cd_m2, double largest_value, const Calibration& calibration);

// Luminance of an emitter that is to follow the camera: 2^(EV100 + compensation) K / 100 (listing 29). It saturates the sensor, and so
// blooms, only from bloom_compensation() upwards: log2(100 sensor / (100 q K)), 3.263 stops for 78, .65 and 12.5.
double emissive_luminance(double ev100, double compensation_stop, const Calibration& calibration);
double bloom_compensation(const Calibration& calibration);

// "Sunny 16": with t = 1/S, the aperture for a sky (table 13).
struct SunnySixteen {
  double f_number;
  std::string_view sky, shadows;
};
std::span<const SunnySixteen> sunny_sixteen();

}  // namespace etendue
