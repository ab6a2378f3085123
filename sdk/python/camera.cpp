#include "etendue/camera.h"

#include "elementwise.h"
#include "module.h"
#include "settings.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <string_view>
#include <tuple>
#include <vector>

namespace etendue::python {
namespace {

// meter_k, meter_c, sensor, lens_q, aperture_counts.
using CalibrationNumbers = std::tuple<double, double, double, double, bool>;
Calibration calibration_of(const CalibrationNumbers& c) {
  const auto& [meter_k, meter_c, sensor, lens_q, aperture_counts] = c;
  return {"", meter_k, meter_c, sensor, lens_q, aperture_counts, ""};
}
using NamedCalibration = std::tuple<std::string_view, double, double, double, double, bool, std::string_view>;
NamedCalibration named(const Calibration& c) { return {c.name, c.meter_k, c.meter_c, c.sensor, c.lens_q, c.aperture_counts, c.source}; }

}  // namespace

void bind_camera(nb::module_& m) {
  m.def(
      "shutter_time", [](const Settings& s) { return unwrap(shutter_time(settings_of(s))); }, nb::arg("settings"));
  m.def(
      "ev_s", [](const Settings& s) { return unwrap(ev_s(settings_of(s))); }, nb::arg("settings"));
  m.def(
      "ev100", [](const Settings& s) { return unwrap(ev100(settings_of(s))); }, nb::arg("settings"));
  m.def(
      "effective_ev100", [](const Settings& s) { return unwrap(effective_ev100(settings_of(s))); }, nb::arg("settings"));
  m.def(
      "exposure_of", [](const Settings& s, const CalibrationNumbers& c) { return unwrap(exposure_of(settings_of(s), calibration_of(c))); },
      nb::arg("settings"), nb::arg("calibration"));

  m.def("calibrations", [] {
    std::vector<NamedCalibration> all;
    for (const Calibration& c : calibrations()) all.push_back(named(c));
    return all;
  });
  m.def(
      "calibration", [](std::string_view name) { return named(unwrap(calibration(name))); }, nb::arg("name"));

  using With = CalibrationNumbers;
  const auto of_ev = [&m](const char* name, double (*f)(double, const Calibration&)) {
    def_elementwise<1, With>(
        m, name, [f](double ev, const With& c) { return f(ev, calibration_of(c)); }, "ev100", "calibration");
  };
  of_ev("luminance_of_ev100", luminance_of_ev100);
  of_ev("illuminance_of_ev100", illuminance_of_ev100);
  of_ev("saturation_of_ev100", saturation_of_ev100);
  of_ev("exposure_of_ev100", exposure_of_ev100);
  def_elementwise<1, With>(
      m, "ev100_of_luminance", [](double l, const With& c) { return ev100_of_luminance(l, calibration_of(c)); }, "luminance_cd_m2",
      "calibration");
  def_elementwise<1, With>(
      m, "ev100_of_illuminance", [](double e, const With& c) { return ev100_of_illuminance(e, calibration_of(c)); }, "illuminance_lx",
      "calibration");
  def_elementwise<2, With>(
      m, "emissive_luminance", [](double ev, double stop, const With& c) { return emissive_luminance(ev, stop, calibration_of(c)); },
      "ev100", "compensation_stop", "calibration");
  def_elementwise<2, With>(
      m, "least_ev100_that_stores",
      [](double l, double most, const With& c) { return least_ev100_that_stores(l, most, calibration_of(c)); }, "luminance_cd_m2",
      "largest_value", "calibration");
  m.def(
      "bloom_compensation", [](const With& c) { return bloom_compensation(calibration_of(c)); }, nb::arg("calibration"));

  def_elementwise<3>(
      m, "lens_q",
      [](double transmission, double vignetting, double angle_rad) {
        return lens_q({transmission, vignetting, angle_rad});
      },
      "transmission", "vignetting", "angle_rad");
  def_elementwise<1, Settings, double>(
      m, "sensor_exposure", [](double l, const Settings& s, double q) { return sensor_exposure(l, settings_of(s), q); }, "luminance_cd_m2",
      "settings", "lens_q");
  def_elementwise<1, double, double, double, double>(
      m, "cell_energy",
      [](double h, double width_m, double height_m, double columns, double rows) {
        return cell_energy(h, {width_m, height_m, columns, rows});
      },
      "exposure_lx_s", "width_m", "height_m", "columns", "rows");
  m.def("sunny_sixteen", [] {
    std::vector<std::tuple<double, std::string_view, std::string_view>> rows;
    for (const SunnySixteen& row : sunny_sixteen()) rows.emplace_back(row.f_number, row.sky, row.shadows);
    return rows;
  });
}

}  // namespace etendue::python
