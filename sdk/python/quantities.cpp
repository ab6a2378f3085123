#include "errors.h"
#include "etendue/units.h"
#include "module.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace etendue::python {

namespace nb = nanobind;

namespace {

constexpr int dimension_count = static_cast<int>(Dimension::stop) + 1;

}  // namespace

void bind_quantities(nb::module_& m) {
  m.def(
      "dimensions",
      [] {
        std::vector<std::tuple<std::string_view, std::string_view>> all;
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
      "quantity_text",
      [](int dimension, double si) {
        return to_string(AnyQuantity{static_cast<Dimension>(dimension), si});
      },
      nb::arg("dimension"), nb::arg("si"), "The shortest text that reads back as the same double.");
}

}  // namespace etendue::python
