#include "etendue/colour_space.h"

#include "elementwise.h"
#include "module.h"

#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <string_view>
#include <tuple>
#include <vector>

namespace etendue::python {
namespace {

using Pair = std::tuple<double, double>;
Chromaticity chromaticity_of(const Pair& xy) { return {std::get<0>(xy), std::get<1>(xy)}; }
Pair pair_of(const Chromaticity& xy) { return {xy.x, xy.y}; }

NewArray<double> array_of(const Matrix3& m) {
  auto* values = new double[9]{m.a.x, m.b.x, m.c.x, m.a.y, m.b.y, m.c.y, m.a.z, m.b.z, m.c.z};
  return NewArray<double>(values, {3, 3}, nb::capsule(values, [](void* p) noexcept { delete[] static_cast<double*>(p); }));
}

}  // namespace

void bind_colour_space(nb::module_& m) {
  m.def(
      "colour_space",
      [](std::string_view name) {
        const ColourSpace s = unwrap(colour_space(name));
        return std::make_tuple(s.name, pair_of(s.red), pair_of(s.green), pair_of(s.blue), pair_of(s.white), s.source);
      },
      nb::arg("name"));
  m.def("colour_spaces", [] {
    std::vector<std::string_view> names;
    for (const ColourSpace& s : colour_spaces()) names.push_back(s.name);
    return names;
  });
  m.def(
      "rgb_to_xyz", [](std::string_view space) { return array_of(rgb_to_xyz(unwrap(colour_space(space)))); }, nb::arg("space"));
  m.def(
      "xyz_to_rgb", [](std::string_view space) { return array_of(xyz_to_rgb(unwrap(colour_space(space)))); }, nb::arg("space"));
  m.def(
      "adaptation_matrix",
      [](const Pair& from, const Pair& to, std::string_view adaptation) {
        return array_of(unwrap(adaptation_matrix(chromaticity_of(from), chromaticity_of(to), unwrap(adaptation_of(adaptation)))));
      },
      nb::arg("from_white"), nb::arg("to_white"), nb::arg("adaptation"));
  m.def(
      "space_conversion",
      [](std::string_view from, std::string_view to, std::string_view adaptation) {
        return array_of(unwrap(conversion(unwrap(colour_space(from)), unwrap(colour_space(to)), unwrap(adaptation_of(adaptation)))));
      },
      nb::arg("from_space"), nb::arg("to_space"), nb::arg("adaptation"));
  m.def(
      "white_balance",
      [](const Pair& white, std::string_view space, std::string_view adaptation) {
        return array_of(unwrap(white_balance(chromaticity_of(white), unwrap(colour_space(space)), unwrap(adaptation_of(adaptation)))));
      },
      nb::arg("scene_white"), nb::arg("space"), nb::arg("adaptation"));
  m.def(
      "to_space",
      [](const Pair& xy, std::string_view space, std::string_view adaptation, const Pair& observer_white) {
        const InSpace found = unwrap(to_space(chromaticity_of(xy), unwrap(colour_space(space)),
                                              {unwrap(adaptation_of(adaptation)), chromaticity_of(observer_white)}));
        return std::make_tuple(found.rgb.x, found.rgb.y, found.rgb.z, found.in_gamut);
      },
      nb::arg("xy"), nb::arg("space"), nb::arg("adaptation"), nb::arg("observer_white"));
}

}  // namespace etendue::python
