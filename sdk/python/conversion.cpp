#include "etendue/convert.h"

#include "elementwise.h"
#include "etendue/formulas.h"
#include "etendue/unit_names.h"
#include "module.h"
#include "settings.h"
#include "shapes.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace etendue::python {
namespace {

constexpr std::array<std::pair<std::string_view, FluxConvention>, 4> spot_fluxes{{{"falloff", FluxConvention::falloff},
                                                                                  {"cone", FluxConvention::cone},
                                                                                  {"frostbite_pi", FluxConvention::frostbite_pi},
                                                                                  {"isotropic", FluxConvention::isotropic}}};
constexpr std::array<std::pair<std::string_view, SpotFalloff>, 3> spot_falloffs{
    {{"hard", SpotFalloff::hard}, {"squared", SpotFalloff::squared}, {"smoothstep", SpotFalloff::smoothstep}}};

using ExplanationParts =
    std::tuple<std::string, std::vector<std::tuple<std::string, double, std::string_view>>, std::vector<std::string>, std::string>;
ExplanationParts numbers_of(const Explanation& e) {
  std::vector<std::tuple<std::string, double, std::string_view>> symbols;
  for (const Symbol& s : e.symbols) symbols.emplace_back(s.name, s.value, s.unit);
  return {e.formula, symbols, e.notes, to_string(e)};
}

}  // namespace

void bind_conversion(nb::module_& m) {
  const nb::class_<LightSetup> setup_type(m, "LightSetup", "What is known of a light besides the quantity.");
  m.def(
      "light_setup",
      [](const std::optional<ShapeNumbers>& shape, bool two_sided, std::string_view spot_flux, std::string_view spot_falloff,
         std::optional<double> given_distance_m, std::optional<double> wanted_distance_m, std::optional<double> efficacy_lm_W,
         double meter_k, double meter_c) {
        LightSetup setup;
        if (shape) setup.shape = shape_of(*shape);
        if (setup.shape && std::holds_alternative<MeshShape>(*setup.shape)) setup.mesh_area_m2 = size_of(*shape);
        if (setup.shape && std::holds_alternative<PhotometricShape>(*setup.shape)) setup.photometric_sr = size_of(*shape);
        setup.conventions = {two_sided, named(spot_flux, spot_fluxes), named(spot_falloff, spot_falloffs)};
        setup.given_distance_m = given_distance_m;
        setup.wanted_distance_m = wanted_distance_m;
        setup.efficacy_lm_W = efficacy_lm_W;
        setup.meter_k = meter_k;
        setup.meter_c = meter_c;
        return setup;
      },
      nb::arg("shape").none(), nb::arg("two_sided"), nb::arg("spot_flux"), nb::arg("spot_falloff"), nb::arg("given_distance_m").none(),
      nb::arg("wanted_distance_m").none(), nb::arg("efficacy_lm_W").none(), nb::arg("meter_k"), nb::arg("meter_c"));

  const nb::class_<Conversion> conversion_type(m, "Conversion", "One conversion, prepared for any number of values.");
  m.def(
      "conversion",
      [](const NamedUnit& given, const NamedUnit& wanted, const LightSetup& setup) {
        return unwrap(Conversion::between(given, wanted, setup));
      },
      nb::arg("given"), nb::arg("wanted"), nb::arg("setup"));
  def_elementwise<1, Conversion>(
      m, "converted", [](double x, const Conversion& c) { return c(x); }, "value", "conversion");

  m.def(
      "explain_conversion",
      [](double value, const NamedUnit& given, const NamedUnit& wanted, const LightSetup& setup) {
        return numbers_of(unwrap(explain(AnyQuantity{given.dimension, given.to_si(value)}, wanted.dimension, setup)));
      },
      nb::arg("value"), nb::arg("given"), nb::arg("wanted"), nb::arg("setup"),
      "Formula, symbols (name, value, unit), notes, and all as lines.");
  m.def(
      "explain_camera", [](const Settings& s) { return numbers_of(unwrap(explain(settings_of(s)))); }, nb::arg("settings"));
}

}  // namespace etendue::python
