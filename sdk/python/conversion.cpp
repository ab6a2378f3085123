#include "etendue/convert.h"

#include "elementwise.h"
#include "etendue/formulas.h"
#include "etendue/unit_names.h"
#include "module.h"
#include "settings.h"

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

template <class E, std::size_t N>
E named(std::string_view name, const std::array<std::pair<std::string_view, E>, N>& names) {
  for (const auto& [known, value] : names)
    if (known == name) return value;
  std::string hint = "one of:";
  for (const auto& [known, value] : names) hint += " " + std::string(known);
  raise({"NAME_UNKNOWN", "\"" + std::string(name) + "\" is not known here", {}, hint, {}});
}

constexpr std::array<std::pair<std::string_view, Caps>, 3> caps{{{"round", Caps::round}, {"flat", Caps::flat}, {"none", Caps::none}}};
constexpr std::array<std::pair<std::string_view, FluxConvention>, 4> spot_fluxes{{{"falloff", FluxConvention::falloff},
                                                                                  {"cone", FluxConvention::cone},
                                                                                  {"frostbite_pi", FluxConvention::frostbite_pi},
                                                                                  {"isotropic", FluxConvention::isotropic}}};
constexpr std::array<std::pair<std::string_view, SpotFalloff>, 3> spot_falloffs{
    {{"hard", SpotFalloff::hard}, {"squared", SpotFalloff::squared}, {"smoothstep", SpotFalloff::smoothstep}}};

// The name of a shape, its numbers in SI, and of tubes their caps.
using ShapeNumbers = std::tuple<std::string_view, std::vector<double>, std::string_view>;

void set_shape(const ShapeNumbers& given, LightSetup& setup) {
  const auto& [name, x, cap] = given;
  const auto at = [&x](std::size_t i) { return i < x.size() ? x[i] : 0; };
  if (name == "point") setup.shape = PointShape{};
  if (name == "spot") setup.shape = SpotShape{at(0), at(1)};
  if (name == "frustum") setup.shape = FrustumShape{at(0), at(1)};
  if (name == "distant") setup.shape = DistantShape{at(0)};
  if (name == "sphere") setup.shape = SphereShape{at(0)};
  if (name == "disk") setup.shape = DiskShape{at(0)};
  if (name == "rect") setup.shape = RectShape{at(0), at(1)};
  if (name == "tube") setup.shape = TubeShape{at(0), at(1), named(cap, caps)};
  if (name == "line") setup.shape = LineShape{at(0)};
  if (name == "environment") setup.shape = EnvironmentShape{};
  if (name == "polygon") {
    PolygonShape polygon;
    for (std::size_t i = 0; i + 1 < x.size(); i += 2) polygon.points.push_back({x[i], x[i + 1]});
    setup.shape = polygon;
  }
  if (name == "mesh") {
    setup.shape = MeshShape{};
    setup.mesh_area_m2 = at(0);
  }
  if (name == "photometric") {
    setup.shape = PhotometricShape{};
    setup.photometric_sr = at(0);
  }
}

using ExplanationParts =
    std::tuple<std::string, std::vector<std::tuple<std::string, double, std::string_view>>, std::vector<std::string>, std::string>;
ExplanationParts numbers_of(const Explanation& e) {
  std::vector<std::tuple<std::string, double, std::string_view>> symbols;
  for (const Symbol& s : e.symbols) symbols.emplace_back(s.name, s.value, s.unit);
  return {e.formula, symbols, e.notes, to_string(e)};
}

}  // namespace

void bind_conversion(nb::module_& m) {
  nb::class_<LightSetup>(m, "LightSetup", "What is known of a light besides the quantity.");
  m.def(
      "light_setup",
      [](const std::optional<ShapeNumbers>& shape, bool two_sided, std::string_view spot_flux, std::string_view spot_falloff,
         std::optional<double> given_distance_m, std::optional<double> wanted_distance_m, std::optional<double> efficacy_lm_W,
         double meter_k, double meter_c) {
        LightSetup setup;
        if (shape) set_shape(*shape, setup);
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

  nb::class_<Conversion>(m, "Conversion", "One conversion, prepared for any number of values.");
  m.def(
      "conversion",
      [](const NamedUnit& given, const NamedUnit& wanted, const LightSetup& setup) {
        return unwrap(Conversion::between(given.dimension, wanted.dimension, setup));
      },
      nb::arg("given"), nb::arg("wanted"), nb::arg("setup"));
  def_elementwise<1, Conversion, NamedUnit, NamedUnit>(
      m, "converted",
      [](double x, const Conversion& c, const NamedUnit& given, const NamedUnit& wanted) -> Result<double> {
        const Result<double> si = c(given.to_si(x));
        if (!si) return si.error();
        return wanted.from_si(*si);
      },
      "value", "conversion", "given", "wanted");

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
