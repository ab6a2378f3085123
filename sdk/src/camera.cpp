#include "etendue/camera.h"

#include "edit_distance.h"
#include "parameter_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue {
namespace {

constexpr std::array<Calibration, 9> all_calibrations{{
    {"frostbite", 12.5, 250, 78, 0.65, true, "Lagarde and de Rousiers 2014, Moving Frostbite to PBR 3.0, eq 12 and 70 to 75, listing 28"},
    {"filament", 12.5, 250, 78, 0.65, true, "Filament, Exposure.cpp: 1 / (1.2 2^EV100), K = 12.5, C = 250"},
    {"unreal", 12.5, 250, 78, 0.78, true, "Unreal Engine, r.EyeAdaptation.LensAttenuation = .78: 1 / 2^EV100"},
    {"hdrp", 12.5, 250, 78, 0.65, true, "Unity HDRP, ColorUtils: lens attenuation .65"},
    {"hdrp_perfect_lens", 12.5, 250, 78, 0.78, true, "Unity HDRP, LensAttenuationMode.PerfectLens: .78"},
    {"usd", 12.5, 250, 78, 0.78, true, "OpenUSD, UsdGeomCamera linear exposure scale, responsivity 1: t S / (100 N^2)"},
    {"pbrt", 12.5, 250, 78, 0.78, false, "pbrt-v4, imaging ratio exposuretime iso / 100: 1 cd/m2 is 1 at 1 s and ISO 100; no aperture"},
    {"iso_sbs", 12.5, 250, 78, 0.65, true, "ISO 12232, saturation-based speed: H = 78 / S, q = .65"},
    // Standard output sensitivity puts H = 10 / S at a pixel value of .18.
    {"iso_sos", 12.5, 250, 10 / 0.18, 0.65, true, "ISO 12232, standard output sensitivity: H = 10 / S at 18 % of full scale, q = .65"},
}};

constexpr std::array<SunnySixteen, 6> all_skies{{{22, "snow and sand", "dark with sharp edges"},
                                                 {16, "sunny", "distinct"},
                                                 {11, "slightly overcast", "soft around edges"},
                                                 {8, "overcast", "barely visible"},
                                                 {5.6, "heavily overcast", "none"},
                                                 {4, "open shade or sunset", "none"}}};

Error missing(std::string_view setting, std::string_view what, std::string hint) {
  return parameter_error(setting, "CAMERA_SETTING_MISSING", fmt::format("expected {}, found none", what), std::move(hint));
}
Error ambiguous(std::string_view setting, std::string_view first, std::string_view second) {
  return parameter_error(setting, "CAMERA_SETTING_AMBIGUOUS", fmt::format("expected either {} or {}, found both", first, second));
}
// A positive finite number is itself, everything else an error that names the setting.
Result<double> positive(std::string_view setting, std::string_view what, double value) {
  if (value > 0 && std::isfinite(value)) return value;
  return parameter_error(setting, "CAMERA_SETTING_INVALID", fmt::format("expected {} above 0 and finite, found {}", what, value));
}

Result<double> aperture(const CameraSettings& camera) {
  if (camera.f_number && camera.t_stop) return ambiguous("t_stop", "an f-number", "a T-stop");
  if (camera.f_number) return positive("f_number", "an f-number", *camera.f_number);
  if (camera.t_stop) return positive("t_stop", "a T-stop", *camera.t_stop);
  return missing("f_number", "an f-number or a T-stop", "for example f/2.8");
}

// D log2(10) - EC: by how many stops filters and compensation darken the picture.
Result<double> darkening_stop(const CameraSettings& camera) {
  if (!(camera.nd_density >= 0 && std::isfinite(camera.nd_density)))
    return parameter_error("nd_density", "CAMERA_SETTING_INVALID",
                           fmt::format("expected a filter's density from 0 upwards, found {}", camera.nd_density));
  if (!std::isfinite(camera.compensation_stop))
    return parameter_error("compensation_stop", "CAMERA_SETTING_INVALID",
                           fmt::format("expected an exposure compensation that is finite, found {}", camera.compensation_stop));
  return camera.nd_density * std::log2(10) - camera.compensation_stop;
}

double power_of_two(double ev) { return std::exp2(std::clamp(ev, -1000.0, 1000.0)); }

}  // namespace

Result<double> shutter_time(const CameraSettings& camera) {
  if (camera.shutter_s && camera.shutter_angle_rad) return ambiguous("shutter_angle_rad", "a shutter time", "a shutter angle");
  if (camera.shutter_s) return positive("shutter_s", "a shutter time in seconds", *camera.shutter_s);
  if (!camera.shutter_angle_rad)
    return missing("shutter_s", "a shutter time or a shutter angle", "for example 1/60 s, or 180 deg @ 24 fps");
  const double angle_rad = *camera.shutter_angle_rad;
  if (!(angle_rad > 0 && angle_rad <= 2 * pi))
    return parameter_error(
        "shutter_angle_rad", "CAMERA_SETTING_INVALID",
        fmt::format("expected a shutter angle above 0 and up to 360 degrees, found {} degrees", degrees.of({angle_rad})));
  if (!camera.frames_per_s) return missing("frames_per_s", "a frame rate beside the shutter angle", "for example 180 deg @ 24 fps");
  const Result<double> rate = positive("frames_per_s", "a frame rate", *camera.frames_per_s);
  if (!rate) return rate.error();
  return positive("shutter_s", "a shutter time in seconds", angle_rad / (2 * pi * *rate));
}

Result<double> ev_s(const CameraSettings& camera) {
  const Result<double> n = aperture(camera);
  if (!n) return n.error();
  const Result<double> t = shutter_time(camera);
  if (!t) return t.error();
  // Two logarithms: the quotient of extreme settings could leave the range of a double.
  return 2 * std::log2(*n) - std::log2(*t);
}

Result<double> ev100(const CameraSettings& camera) {
  const Result<double> without_iso = ev_s(camera);
  if (!without_iso) return without_iso.error();
  if (!camera.iso) return missing("iso", "a sensitivity", "for example ISO 100; without it only EV_S is known");
  const Result<double> s = positive("iso", "a sensitivity (ISO)", *camera.iso);
  if (!s) return s.error();
  return *without_iso - std::log2(*s / 100);
}

Result<double> effective_ev100(const CameraSettings& camera) {
  const Result<double> set = ev100(camera);
  if (!set) return set.error();
  const Result<double> darker = darkening_stop(camera);
  if (!darker) return darker.error();
  return *set + *darker;
}

std::span<const Calibration> calibrations() { return all_calibrations; }

Result<Calibration> calibration(std::string_view name) {
  std::vector<Candidate> candidates;
  for (const Calibration& known : all_calibrations) {
    if (known.name == name) return known;
    candidates.push_back({std::string(known.name), std::string(known.name)});
  }
  return parameter_error("calibration", "CALIBRATION_UNKNOWN", fmt::format("\"{}\" is no camera calibration", name),
                         fmt::format("nearest: {}", fmt::join(nearest_candidates(name, candidates, 3), ", ")));
}

double luminance_of_ev100(double ev100, const Calibration& calibration) { return power_of_two(ev100) * calibration.meter_k / 100; }
double illuminance_of_ev100(double ev100, const Calibration& calibration) { return power_of_two(ev100) * calibration.meter_c / 100; }

Result<double> ev100_of_luminance(double luminance_cd_m2, const Calibration& calibration) {
  if (!(luminance_cd_m2 > 0 && std::isfinite(luminance_cd_m2)))
    return parameter_error(
        "luminance_cd_m2", "LUMINANCE_NOT_POSITIVE",
        fmt::format("expected a luminance above 0 and finite, found {} cd/m2: it has no exposure value", luminance_cd_m2));
  return std::log2(luminance_cd_m2) - std::log2(calibration.meter_k / 100);
}

Result<double> ev100_of_illuminance(double illuminance_lx, const Calibration& calibration) {
  if (!(illuminance_lx > 0 && std::isfinite(illuminance_lx)))
    return parameter_error(
        "illuminance_lx", "ILLUMINANCE_NOT_POSITIVE",
        fmt::format("expected an illuminance above 0 and finite, found {} lx: it has no exposure value", illuminance_lx));
  return std::log2(illuminance_lx) - std::log2(calibration.meter_c / 100);
}

double saturation_of_ev100(double ev100, const Calibration& calibration) {
  return power_of_two(ev100) * (calibration.sensor / (100 * calibration.lens_q));
}
double exposure_of_ev100(double ev100, const Calibration& calibration) {
  return power_of_two(-ev100) / (calibration.sensor / (100 * calibration.lens_q));
}

Result<double> exposure_of(const CameraSettings& camera, const Calibration& calibration) {
  CameraSettings counted = camera;
  if (!calibration.aperture_counts) {
    counted.f_number = 1;
    counted.t_stop.reset();
  }
  const Result<double> ev = effective_ev100(counted);
  if (!ev) return ev.error();
  return exposure_of_ev100(*ev, calibration) / (counted.t_stop ? typical_lens.transmission : 1);
}

double lens_q(const Lens& lens) {
  const double cosine = std::cos(lens.angle_rad), squared = cosine * cosine;
  return pi / 4 * lens.transmission * lens.vignetting * squared * squared;
}

Result<SensorExposure> sensor_exposure(double luminance_cd_m2, const CameraSettings& camera, double lens_q) {
  const Result<double> n = aperture(camera);
  if (!n) return n.error();
  const Result<double> t = shutter_time(camera);
  if (!t) return t.error();
  const Result<double> darker = darkening_stop(camera);
  if (!darker) return darker.error();
  if (!(luminance_cd_m2 >= 0 && std::isfinite(luminance_cd_m2)))
    return parameter_error("luminance_cd_m2", "LUMINANCE_NEGATIVE",
                           fmt::format("expected a luminance from 0 upwards and finite, found {} cd/m2", luminance_cd_m2));
  const double q = lens_q / (camera.t_stop ? typical_lens.transmission : 1);
  const double illuminance_lx = q * luminance_cd_m2 / (*n * *n) * std::pow(10, -camera.nd_density);
  return SensorExposure{illuminance_lx, illuminance_lx * *t};
}

Result<double> cell_energy(double exposure_lx_s, const Sensor& sensor) {
  for (const auto& [setting, what, value] : {std::tuple{"width_m", "a sensor's width in metres", sensor.width_m},
                                             {"height_m", "a sensor's height in metres", sensor.height_m},
                                             {"columns", "a sensor's number of columns", sensor.columns},
                                             {"rows", "a sensor's number of rows", sensor.rows}})
    if (const Result<double> checked = positive(setting, what, value); !checked) return checked.error();
  return exposure_lx_s * (sensor.width_m / sensor.columns) * (sensor.height_m / sensor.rows);
}

double least_ev100_that_stores(double luminance_cd_m2, double largest_value, const Calibration& calibration) {
  constexpr double smallest = 1e-300;
  return std::log2(std::max(luminance_cd_m2, smallest)) - std::log2(std::max(largest_value, smallest)) -
         std::log2(calibration.sensor / (100 * calibration.lens_q));
}

double emissive_luminance(double ev100, double compensation_stop, const Calibration& calibration) {
  return luminance_of_ev100(ev100 + compensation_stop, calibration);
}
// Saturation is 2^EV sensor / (100 q); the meter's luminance 2^EV K / 100: their ratio in stops.
double bloom_compensation(const Calibration& calibration) {
  return std::log2(calibration.sensor / calibration.lens_q / calibration.meter_k);
}

std::span<const SunnySixteen> sunny_sixteen() { return all_skies; }

}  // namespace etendue
