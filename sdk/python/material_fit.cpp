#include "elementwise.h"
#include "module.h"
#include "owned.h"

#include "etendue/material_codes.h"
#include "etendue/material_fit_batch.h"

#include <span>
#include <tuple>

namespace etendue::python {
namespace {

using Three = std::tuple<double, double, double>;

Rgb rgb_of(const Three& t) { return {std::get<0>(t), std::get<1>(t), std::get<2>(t)}; }
Three tuple_of(const Rgb& c) { return {c.x, c.y, c.z}; }
DielectricF0 dielectric_of(bool core) { return core ? DielectricF0::core : DielectricF0::free; }

}  // namespace

void bind_material_fit(nb::module_& m) {
  m.def(
      "disney_to_two_colours",
      [](const Three& base_colour, double metal, double reflectance) {
        const ColourPair pair = colour_pair_of({rgb_of(base_colour), metal, reflectance});
        return std::make_tuple(tuple_of(pair.diffuse), tuple_of(pair.f0));
      },
      nb::arg("base_colour"), nb::arg("metal"), nb::arg("reflectance"));
  m.def(
      "fit_disney",
      [](const Three& diffuse, const Three& f0, bool core, double tolerance) {
        const DisneyFit fit = fit_disney({rgb_of(diffuse), rgb_of(f0)}, dielectric_of(core), tolerance);
        return std::make_tuple(tuple_of(fit.value.base_colour), fit.value.metal, fit.value.reflectance, fit.residual, fit.metal_low,
                               fit.metal_high);
      },
      nb::arg("diffuse"), nb::arg("f0"), nb::arg("core"), nb::arg("tolerance"));
  m.def(
      "fit_codes",
      [](const Three& diffuse, const Three& f0, int bits, int dielectric, double metal_low, double metal_high) {
        const StoredFit fit =
            fit_codes({rgb_of(diffuse), rgb_of(f0)}, {bits, static_cast<DielectricCode>(dielectric)}, {metal_low, metal_high});
        const auto& base = fit.codes.base_colour;
        return std::make_tuple(std::make_tuple(base[0], base[1], base[2]), fit.codes.metal, fit.codes.dielectric,
                               tuple_of(fit.value.base_colour), fit.value.metal, fit.value.reflectance, fit.residual);
      },
      nb::arg("diffuse"), nb::arg("f0"), nb::arg("bits"), nb::arg("dielectric"), nb::arg("metal_low"), nb::arg("metal_high"));
  m.def(
      "fit_disney_many",
      [](const Array<float>& diffuse, const Array<float>& f0, bool core) {
        const std::size_t count = diffuse.size() / 3;
        const Owned<float> base(3 * count), metal(count), reflectance(count);
        const auto colours = [](const Array<float>& a) {
          return std::span<const Vec3f>(reinterpret_cast<const Vec3f*>(a.data()), a.size() / 3);
        };
        const Status done = [&] {
          const nb::gil_scoped_release others_may_run;
          return fit_disney(colours(diffuse), colours(f0),
                            {{reinterpret_cast<Vec3f*>(base.values), count}, {metal.values, count}, {reflectance.values, count}},
                            dielectric_of(core));
        }();
        unwrap(done);
        const Extents pixels = extents_of(diffuse, diffuse.ndim() - 1);
        Extents channels = pixels;
        channels.push_back(3);
        return std::make_tuple(base.array(channels), metal.array(pixels), reflectance.array(pixels));
      },
      nb::arg("diffuse").noconvert(), nb::arg("f0").noconvert(), nb::arg("core"));
}

}  // namespace etendue::python
