#include "elementwise.h"
#include "module.h"
#include "owned.h"

#include "etendue/normal_filter.h"

#include <nanobind/stl/vector.h>

#include <algorithm>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace etendue::python {
namespace {

using Level = std::tuple<NewArray<float>, NewArray<float>, NewArray<float>, NewArray<float>>;

NormalFilter filter_named(const std::string& name) {
  const auto filter = normal_filter_named(name);
  if (!filter) raise({"METHOD_UNKNOWN", "expected ggx, slopes or listing32, found '" + name + "'", {}, {}, {}});
  return *filter;
}

NewArray<float> copied(std::span<const float> values, const Extents& extents) {
  const Owned<float> room(values.size());
  std::copy(values.begin(), values.end(), room.values);
  return room.array(extents);
}

}  // namespace

void bind_normal_filter(nb::module_& m) {
  def_elementwise<1>(m, "normal_concentration", normal_concentration, "mean_length");
  def_elementwise<1>(m, "mean_normal_length", mean_normal_length, "concentration");
  m.def(
      "filtered_lobes",
      [](const Array<double>& alpha, const Array<double>& mean_length, const std::string& method) {
        const NormalFilter filter = filter_named(method);
        const Owned<double> alphas(alpha.size()), misplaced(alpha.size());
        for (std::size_t i = 0; i < alpha.size(); ++i) {
          const FilteredLobe lobe = filtered_lobe(alpha.data()[i], mean_length.data()[i], filter);
          alphas.values[i] = lobe.alpha, misplaced.values[i] = lobe.misplaced;
        }
        const Extents extents = extents_of(alpha, alpha.ndim());
        return std::make_tuple(alphas.array(extents), misplaced.array(extents));
      },
      nb::arg("alpha").noconvert(), nb::arg("mean_length").noconvert(), nb::arg("method"));
  m.def(
      "filter_normals",
      [](const Array<float>& normals, const Array<float>& alphas, const std::string& method) {
        const NormalFilter filter = filter_named(method);
        const auto height = static_cast<std::uint32_t>(normals.shape(0)), width = static_cast<std::uint32_t>(normals.shape(1));
        const NormalField field{
            width, height, {reinterpret_cast<const Vec3f*>(normals.data()), normals.size() / 3}, {alphas.data(), alphas.size()}};
        const auto levels = [&] {
          const nb::gil_scoped_release others_may_run;
          return filter_normals(field, filter);
        }();
        std::vector<Level> all;
        for (const NormalLevel& level : unwrap(levels)) {
          const Extents texels{level.height, level.width}, vectors{level.height, level.width, 3};
          all.emplace_back(copied({reinterpret_cast<const float*>(level.means.data()), 3 * level.means.size()}, vectors),
                           copied(level.alphas, texels), copied(level.authored_alphas, texels), copied(level.misplaced, texels));
        }
        return all;
      },
      nb::arg("normals").noconvert(), nb::arg("alphas").noconvert(), nb::arg("method"));
}

}  // namespace etendue::python
