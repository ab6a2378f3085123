// Shapes of lights as names and numbers.
#pragma once

#include "errors.h"
#include "etendue/light.h"

#include <array>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace etendue::python {

// The name of a shape, its numbers in the order of its members, and of tubes their caps. Of a mesh: the area of one side in m2; of
// photometric shapes: flux over axial intensity in sr; neither is in the Shape.
using ShapeNumbers = std::tuple<std::string, std::vector<double>, std::string>;
Shape shape_of(const ShapeNumbers& given);
ShapeNumbers numbers_of(const Shape& shape);
inline double size_of(const ShapeNumbers& given) { return std::get<1>(given).empty() ? 0 : std::get<1>(given).front(); }

// What a choice is called. NAME_UNKNOWN lists the names.
template <class E, std::size_t N>
E named(std::string_view name, const std::array<std::pair<std::string_view, E>, N>& names) {
  for (const auto& [known, value] : names)
    if (known == name) return value;
  std::string hint = "one of:";
  for (const auto& [known, value] : names) hint += " " + std::string(known);
  raise({"NAME_UNKNOWN", "\"" + std::string(name) + "\" is not known here", {}, hint, {}});
}

}  // namespace etendue::python
