// The list of the specular methods, source by source.
#include "etendue/specular_methods.h"

#include "specular_moments.h"
#include "specular_view.h"

#include <algorithm>
#include <vector>

namespace etendue::eval {
namespace {

std::optional<Rgb> moments(const Emitter& emitter, const ShadingPoint& point) {
  const std::optional<GgxLobe> lobe = correlated_ggx(point.brdf);
  if (!lobe || !is_uniform_area_light(emitter)) return std::nullopt;
  return luminance_of(emitter) * by_moments(emitter, point, *lobe);
}

constexpr SpecularMethod ours[] = {
    {"moments", "Etendue",
     "Exact but for the slow factor of the lobe, which is taken at four places, and for outlines in pieces; no table.", moments},
};

}  // namespace

std::span<const SpecularMethod> specular_methods() {
  static const std::vector<SpecularMethod> all = [] {
    std::vector<SpecularMethod> methods;
    for (const std::span<const SpecularMethod> part : {ltc_methods(), std::span<const SpecularMethod>(ours)})
      methods.insert(methods.end(), part.begin(), part.end());
    return methods;
  }();
  return all;
}

const SpecularMethod* find_specular_method(std::string_view name) {
  const auto all = specular_methods();
  const auto found = std::find_if(all.begin(), all.end(), [&](const SpecularMethod& m) { return m.name == name; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace etendue::eval
