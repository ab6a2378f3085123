#include "elementwise.h"
#include "errors.h"
#include "etendue/quantity_text.h"
#include "etendue/unit_names.h"
#include "module.h"
#include "settings.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <string_view>
#include <tuple>
#include <vector>

namespace etendue::python {
namespace {

constexpr int dimension_count = static_cast<int>(Dimension::stop) + 1;

// What was written: its kind, and its numbers.
struct AsTuple {
  nb::object operator()(const WrittenQuantity& q) const {
    const AnyQuantity in_si = q.quantity();
    return nb::make_tuple("quantity", static_cast<int>(in_si.dimension), in_si.si, q.distance_m, q.efficacy_lm_W, q.number, q.unit);
  }
  nb::object operator()(const CameraSettings& camera) const { return nb::make_tuple("camera", settings_numbers(camera)); }
  nb::object operator()(const ColourTemperature& t) const { return nb::make_tuple("temperature", t.kelvin, t.duv); }
  nb::object operator()(const Chromaticity& xy) const { return nb::make_tuple("xy", xy.x, xy.y); }
  nb::object operator()(const Rgb& rgb) const { return nb::make_tuple("rgb", rgb.x, rgb.y, rgb.z); }
};

}  // namespace

void bind_quantities(nb::module_& m) {
  nb::class_<NamedUnit>(m, "NamedUnit", "What one unit is in SI.")
      .def_prop_ro("dimension", [](const NamedUnit& unit) { return static_cast<int>(unit.dimension); })
      .def("to_si", &NamedUnit::to_si, nb::arg("x"))
      .def("from_si", &NamedUnit::from_si, nb::arg("si"));
  m.def(
      "unit_named", [](std::string_view spelling) { return unwrap(unit_named(spelling)); }, nb::arg("spelling"));
  m.def(
      "unit_spellings",
      [] {
        std::vector<std::tuple<std::string_view, std::string_view, std::string_view, int>> all;
        for (const UnitSpelling& s : unit_spellings()) all.emplace_back(s.symbol, s.prefixes, s.name, static_cast<int>(s.unit.dimension));
        return all;
      },
      "Symbol, SI prefixes, name and dimension of each unit.");
  m.def(
      "dimensions",
      [] {
        std::vector<std::tuple<std::string_view, std::string_view>> all;
        all.reserve(dimension_count);
        for (int i = 0; i < dimension_count; ++i)
          all.emplace_back(name_of(static_cast<Dimension>(i)), si_unit_of(static_cast<Dimension>(i)));
        return all;
      },
      "Name and SI unit of each dimension, in the order of their numbers.");
  m.def(
      "parse_quantity",
      [](std::string_view text) {
        const AnyQuantity q = unwrap(parse_quantity(text));
        return std::make_tuple(static_cast<int>(q.dimension), q.si);
      },
      nb::arg("text"), "Number of the dimension, and value in its SI unit.");
  m.def(
      "parse", [](std::string_view text) { return std::visit(AsTuple(), unwrap(parse(text))); }, nb::arg("text"),
      nb::sig("def parse(text: str) -> tuple[typing.Any, ...]"), "What was written, and its numbers.");
  m.def(
      "parse_clamping",
      [](std::string_view text) {
        Diagnostics clamped;
        const Written written = unwrap(parse(text, clamped));
        std::vector<std::string> warnings;
        for (const Diagnostic& d : clamped.all()) warnings.push_back(d.text);
        return nb::make_tuple(std::visit(AsTuple(), written), warnings);
      },
      nb::arg("text"), nb::sig("def parse_clamping(text: str) -> tuple[tuple[typing.Any, ...], list[str]]"),
      "The same with temperatures clamped, and what there is to warn of.");
  m.def(
      "quantity_text",
      [](int dimension, double si) {
        return to_string(AnyQuantity{static_cast<Dimension>(dimension), si});
      },
      nb::arg("dimension"), nb::arg("si"), "The shortest text that reads back as the same double.");
}

}  // namespace etendue::python
