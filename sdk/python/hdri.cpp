#include "etendue/hdri.h"

#include "elementwise.h"
#include "module.h"

#include <span>
#include <tuple>

namespace etendue::python {
namespace {

using Triple = std::tuple<double, double, double>;
Vec3d vec_of(const Triple& t) { return {std::get<0>(t), std::get<1>(t), std::get<2>(t)}; }
Triple triple_of(const Vec3d& v) { return {v.x, v.y, v.z}; }

// Rows from the top of RGB: an array of height x width x 3.
using Texels = Array<float>;
std::span<const Vec3f> span_of(const Texels& t) { return {reinterpret_cast<const Vec3f*>(t.data()), t.size() / 3}; }
PanoramaSize size_of(const Texels& t) { return {t.shape(1), t.shape(0)}; }
using WritableTexels = nb::ndarray<float, nb::c_contig, nb::device::cpu>;

}  // namespace

void bind_hdri(nb::module_& m) {
  m.def(
      "illuminance_of_panorama",
      [](const Texels& texels, const Triple& normal) {
        return triple_of(unwrap(illuminance_of_panorama(span_of(texels), size_of(texels), vec_of(normal))));
      },
      nb::arg("texels").noconvert(), nb::arg("normal"));
  m.def(
      "luminance_of_panorama",
      [](const Texels& texels, const Triple& direction, double radius_rad) {
        return triple_of(unwrap(luminance_of_panorama(span_of(texels), size_of(texels), vec_of(direction), radius_rad)));
      },
      nb::arg("texels").noconvert(), nb::arg("direction"), nb::arg("radius_rad"));
  m.def(
      "factor_for_illuminance",
      [](const Texels& texels, const Triple& normal, double lux) {
        return unwrap(factor_for_illuminance(span_of(texels), size_of(texels), vec_of(normal), lux));
      },
      nb::arg("texels").noconvert(), nb::arg("normal"), nb::arg("lux"));
  m.def(
      "factor_for_luminance",
      [](const Texels& texels, const Triple& direction, double radius_rad, double cd_m2) {
        return unwrap(factor_for_luminance(span_of(texels), size_of(texels), vec_of(direction), radius_rad, cd_m2));
      },
      nb::arg("texels").noconvert(), nb::arg("direction"), nb::arg("radius_rad"), nb::arg("cd_m2"));
  m.def(
      "cut_sun",
      [](const WritableTexels& texels, double radius_rad) {
        const std::span<Vec3f> all(reinterpret_cast<Vec3f*>(texels.data()), texels.size() / 3);
        const SunCut cut = unwrap(cut_sun(all, {texels.shape(1), texels.shape(0)}, radius_rad));
        return std::make_tuple(triple_of(cut.direction), cut.illuminance_lx, triple_of(unwrap(resolve(cut.light)).rgb),
                               std::get<DistantShape>(cut.light.shape).diameter_rad, cut.texels, cut.at_maximum);
      },
      nb::arg("texels").noconvert(), nb::arg("radius_rad"),
      "Direction, illuminance in lx, what its light sends out (lx or cd/m2) as linear Rec.709, diameter in rad, texels, texels at the "
      "maximum.");
}

}  // namespace etendue::python
