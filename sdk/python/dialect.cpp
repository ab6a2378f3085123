#include "etendue/dialect.h"

#include "elementwise.h"
#include "module.h"
#include "shapes.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace etendue::python {
namespace {

using Triple = std::tuple<double, double, double>;
// unit, exposure_stop, normalize, reflector, metres_per_unit, efficacy_lm_W.
using FormParts = std::tuple<std::string, double, bool, bool, std::optional<double>, std::optional<double>>;
// shape, amount, form, colour, two_sided, range.
using StatedParts = std::tuple<ShapeNumbers, double, FormParts, Triple, bool, std::optional<double>>;
using LossParts = std::vector<std::pair<std::string, std::string>>;

DialectForm form_of(const FormParts& parts) {
  const auto& [unit, exposure_stop, normalize, reflector, metres_per_unit, efficacy] = parts;
  return {unit, exposure_stop, normalize, reflector, metres_per_unit, efficacy};
}
StatedLight stated_of(const StatedParts& parts) {
  const auto& [shape, amount, form, colour, two_sided, range] = parts;
  return {shape_of(shape), amount, form_of(form), std::apply([](auto... c) { return Rgb{c...}; }, colour), two_sided, range};
}
StatedParts parts_of(const StatedLight& s) {
  const FormParts form{s.form.unit, s.form.exposure_stop, s.form.normalize, s.form.reflector, s.form.metres_per_unit, s.form.efficacy_lm_W};
  return {numbers_of(s.shape), s.amount, form, {s.colour.x, s.colour.y, s.colour.z}, s.two_sided, s.range};
}
LossParts parts_of(const LossReport& report) {
  LossParts parts;
  for (const Loss& loss : report.losses) parts.emplace_back(loss.what, loss.effect);
  return parts;
}

std::string_view name_of_kind(Resolved::Kind kind) {
  switch (kind) {
    case Resolved::Kind::intensity:
      return "intensity";
    case Resolved::Kind::luminance:
      return "luminance";
    case Resolved::Kind::illuminance:
      return "illuminance";
    case Resolved::Kind::line:
      break;
  }
  return "line";
}

}  // namespace

void bind_dialect(nb::module_& m) {
  m.def("dialects", [] {
    std::vector<std::tuple<std::string_view, std::string_view, std::string_view, std::string_view>> all;
    for (const DialectInfo& d : dialects()) all.emplace_back(d.name, d.program, d.source, d.unverified);
    return all;
  });
  m.def(
      "dialect_units",
      [](std::string_view dialect, const ShapeNumbers& shape) { return units_of(unwrap(dialect_named(dialect)).dialect, shape_of(shape)); },
      nb::arg("dialect"), nb::arg("shape"));
  m.def(
      "dialect_emission",
      [](std::string_view dialect, const StatedParts& stated) {
        const FromDialect read = unwrap(from_dialect(unwrap(dialect_named(dialect)).dialect, stated_of(stated)));
        const Resolved emitted = unwrap(resolve(read.light));
        return std::make_tuple(name_of_kind(emitted.kind), Triple{emitted.rgb.x, emitted.rgb.y, emitted.rgb.z}, emitted.flux_lm,
                               parts_of(read.losses));
      },
      nb::arg("dialect"), nb::arg("stated"), "Kind, linear Rec.709, flux in lm, losses.");
  m.def(
      "dialect_translated",
      [](const StatedParts& stated, std::string_view from, std::string_view to, const FormParts& form) {
        const FromDialect read = unwrap(from_dialect(unwrap(dialect_named(from)).dialect, stated_of(stated)));
        const ToDialect written = unwrap(to_dialect(unwrap(dialect_named(to)).dialect, read.light, form_of(form)));
        LossParts losses = parts_of(read.losses);
        for (auto& loss : parts_of(written.losses)) losses.push_back(std::move(loss));
        return std::make_tuple(parts_of(written.stated), losses);
      },
      nb::arg("stated"), nb::arg("from_dialect"), nb::arg("to_dialect"), nb::arg("form"));
  m.def(
      "suspected_compat_lights",
      [](std::string_view generator, const std::vector<std::pair<ShapeNumbers, double>>& given) {
        std::vector<Light> lights(given.size());
        for (std::size_t i = 0; i < given.size(); ++i) {
          lights[i].shape = shape_of(given[i].first);
          lights[i].emission.given =
              std::holds_alternative<DistantShape>(lights[i].shape) ? Emission::Given::illuminance : Emission::Given::intensity;
          lights[i].emission.value = given[i].second;
        }
        const std::optional<Diagnostic> warning = suspected_compat_lights(generator, lights);
        return warning ? std::optional(std::make_tuple(warning->text, warning->hint)) : std::nullopt;
      },
      nb::arg("generator"), nb::arg("lights"), "Text and hint of the warning.");
  m.def(
      "interoperability_spread",
      [](double flux_lm, double inner_rad, double outer_rad) {
        std::vector<std::tuple<std::string, std::string, std::string, double>> rows;
        for (const SpreadRow& row : unwrap(interoperability_spread(flux_lm, {inner_rad, outer_rad})))
          rows.emplace_back(row.program, row.stated, row.divides_by, row.candela);
        return rows;
      },
      nb::arg("flux_lm"), nb::arg("inner_rad"), nb::arg("outer_rad"));
}

}  // namespace etendue::python
