#include "etendue/false_colour.h"

#include "elementwise.h"
#include "module.h"

#include <span>
#include <tuple>

namespace etendue::python {

void bind_false_colour(nb::module_& m) {
  m.def(
      "false_colour",
      [](double position) {
        const Rgb rgb = false_colour(position);
        return std::make_tuple(rgb.x, rgb.y, rgb.z);
      },
      nb::arg("position"));
  m.def(
      "false_colours",
      [](const Array<float>& values, double least, double greatest, bool logarithmic, int bands) {
        auto* colours = new float[values.size() * 3 + 1];
        nb::capsule owner(colours, [](void* p) noexcept { delete[] static_cast<float*>(p); });
        const FalseColourCounts counts =
            unwrap(false_colour(std::span<const float>(values.data(), values.size()), {least, greatest, logarithmic, bands},
                                std::span<Vec3f>(reinterpret_cast<Vec3f*>(colours), values.size())));
        Extents extents = extents_of(values, values.ndim());
        extents.push_back(3);
        return std::make_tuple(NewArray<float>(colours, extents.size(), extents.data(), owner),
                               std::make_tuple(counts.below, counts.above, counts.nan));
      },
      nb::arg("values").noconvert(), nb::arg("least"), nb::arg("greatest"), nb::arg("logarithmic"), nb::arg("bands"));
}

}  // namespace etendue::python
