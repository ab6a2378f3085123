#include "etendue/spectrum.h"

#include "elementwise.h"
#include "etendue/light_presets.h"
#include "module.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <string_view>
#include <tuple>
#include <vector>

namespace etendue::python {
namespace {

Spectrum spectrum_of(double first_nm, double step_nm, const Array<double>& values) {
  return {first_nm, step_nm, std::vector<double>(values.data(), values.data() + values.size())};
}

using TemperatureRow = std::tuple<std::string_view, double, double, std::string_view>;
using EfficacyRow = std::tuple<std::string_view, bool, double, double, std::string_view>;
TemperatureRow row(const TemperaturePreset& p) { return {p.name, p.low_K, p.high_K, p.source}; }
EfficacyRow row(const EfficacyPreset& p) { return {p.name, p.watts == WattsOf::electricity, p.low_lm_W, p.high_lm_W, p.source}; }

template <class Presets>
auto rows_of(const Presets& presets) {
  std::vector<decltype(row(presets.front()))> rows;
  for (const auto& preset : presets) rows.push_back(row(preset));
  return rows;
}

}  // namespace

void bind_spectrum(nb::module_& m) {
  m.def(
      "tristimulus",
      [](double first_nm, double step_nm, const Array<double>& values) {
        const Vec3d xyz = unwrap(tristimulus(spectrum_of(first_nm, step_nm, values)));
        return std::make_tuple(xyz.x, xyz.y, xyz.z);
      },
      nb::arg("first_nm"), nb::arg("step_nm"), nb::arg("values"));
  m.def(
      "efficacy",
      [](double first_nm, double step_nm, const Array<double>& values, double band_first_nm, double band_last_nm) {
        return unwrap(efficacy(spectrum_of(first_nm, step_nm, values), {band_first_nm, band_last_nm}));
      },
      nb::arg("first_nm"), nb::arg("step_nm"), nb::arg("values"), nb::arg("band_first_nm"), nb::arg("band_last_nm"));
  def_elementwise<2>(m, "planck_radiance", planck_radiance, "wavelength_m", "kelvin");
  def_elementwise<1>(m, "blackbody_luminance", blackbody_luminance, "kelvin");
  def_elementwise<1>(m, "blackbody_radiance", blackbody_radiance, "kelvin");
  def_elementwise<1, double, double>(
      m, "blackbody_efficacy",
      [](double kelvin, double first, double last) {
        return blackbody_efficacy(kelvin, {first, last});
      },
      "kelvin", "band_first_nm", "band_last_nm");

  m.def("temperature_presets", [] { return rows_of(temperature_presets()); });
  m.def(
      "temperature_preset", [](std::string_view name) { return row(unwrap(temperature_preset(name))); }, nb::arg("name"));
  m.def("efficacy_presets", [] { return rows_of(efficacy_presets()); });
  m.def(
      "efficacy_preset", [](std::string_view name) { return row(unwrap(efficacy_preset(name))); }, nb::arg("name"));
  m.def(
      "efficacy_policy",
      [](std::string_view text) {
        const EfficacyPolicy policy = unwrap(efficacy_policy(text));
        return std::make_tuple(policy.lm_W, policy.name, policy.source);
      },
      nb::arg("text"));
}

}  // namespace etendue::python
