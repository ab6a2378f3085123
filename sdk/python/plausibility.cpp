#include "elementwise.h"
#include "module.h"
#include "owned.h"

#include "etendue/plausibility.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace etendue::python {
namespace {

using Three = std::tuple<double, double, double>;
// In the order of PlausibleRanges.
using Ranges = std::tuple<double, double, double, double, double, double, double>;

PlausibleRanges ranges_of(const Ranges& r) {
  return {std::get<0>(r), std::get<1>(r), std::get<2>(r), std::get<3>(r), std::get<4>(r), std::get<5>(r), std::get<6>(r)};
}
Rgb rgb_at(const float* values) { return {values[0], values[1], values[2]}; }

std::uint8_t bits_of(const Doubts& doubts) {
  unsigned bits = 0;
  for (const Doubt doubt : all_doubts)
    if (doubts.has(doubt)) bits |= 1u << static_cast<unsigned>(doubt);
  return static_cast<std::uint8_t>(bits);
}

}  // namespace

void bind_plausibility(nb::module_& m) {
  m.def("plausible_ranges", [] {
    const PlausibleRanges r;
    return Ranges{r.albedo_least, r.albedo_greatest, r.f0_least, r.f0_greatest, r.metal_f0_least, r.dielectric_mask, r.metal_mask};
  });
  m.def("all_doubts", [] {
    std::vector<std::tuple<std::string, std::string, Three>> all;
    for (const Doubt doubt : all_doubts) {
      const DoubtInfo& info = info_of(doubt);
      all.emplace_back(info.name, info.meaning, Three{info.colour.x, info.colour.y, info.colour.z});
    }
    return all;
  });
  m.def(
      "doubts",
      [](const Array<float>& diffuse, const Array<float>& f0, const std::optional<Array<float>>& metal, const Ranges& given) {
        const std::size_t count = diffuse.size() / 3;
        const Owned<std::uint8_t> bits(count);
        const PlausibleRanges ranges = ranges_of(given);
        {
          const nb::gil_scoped_release others_may_run;
          for (std::size_t i = 0; i < count; ++i) {
            SurfaceColours colours{{rgb_at(diffuse.data() + 3 * i), rgb_at(f0.data() + 3 * i)}, std::nullopt, true};
            if (metal) colours.metal = static_cast<double>(metal->data()[i]);
            bits.values[i] = bits_of(doubts_of(colours, ranges));
          }
        }
        return bits.array(extents_of(diffuse, diffuse.ndim() - 1));
      },
      nb::arg("diffuse").noconvert(), nb::arg("f0").noconvert(), nb::arg("metal").none(), nb::arg("ranges"));
}

}  // namespace etendue::python
