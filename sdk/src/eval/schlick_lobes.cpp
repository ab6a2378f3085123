#include "schlick_lobes.h"

#include "kernels.h"
#include "specular_view.h"

#include <algorithm>
#include <type_traits>

namespace etendue::eval {
namespace {

constexpr Rgb white{1, 1, 1};

bool is_black(const Rgb& c) { return c == Rgb{}; }

SchlickLobes lobes(const GgxLobe& specular, const Rgb& diffuse_colour, const Brdf& diffuse) {
  return {specular, is_black(diffuse_colour) ? std::nullopt : std::optional(diffuse)};
}

struct Splitter {
  std::optional<SchlickLobes> operator()(const Standard& m) const {
    const StandardLobes parts = lobes_of(m);
    return lobes(parts.specular, parts.diffuse.base_colour, parts.diffuse);
  }
  // (1 - m) Schlick(f0) + m Schlick(base) is Schlick's of the mean of both; base (1 - m) (1 - Fresnel) / pi is glTF's diffuse lobe.
  std::optional<SchlickLobes> operator()(const MetalRough& m) const {
    const double root = (m.ior - 1) / (m.ior + 1), alpha = std::max(m.roughness * m.roughness, min_alpha);
    const Rgb f0 = white * ((1 - m.metallic) * root * root) + m.base_colour * m.metallic, base = m.base_colour * (1 - m.metallic);
    return lobes({alpha, f0, 1, Masking::separable}, base, GltfDiffuse{base, m.ior});
  }
  // diffuse (1 - f0 - (1 - f0) w) / pi, w Schlick's weight: glTF's with an index of 1, in which no f0 is taken off.
  std::optional<SchlickLobes> operator()(const TwoColour& m) const {
    const Rgb base = m.diffuse * (white - m.f0);
    return lobes({std::max(m.roughness * m.roughness, min_alpha), m.f0, 1, Masking::separable}, base, GltfDiffuse{base, 1});
  }
  std::optional<SchlickLobes> operator()(const Principled& m) const {
    if (m.metallic != 1 || !(m.specular > 0)) return std::nullopt;
    return SchlickLobes{{std::max(0.001, m.roughness * m.roughness), m.base_colour, 1, Masking::separable}, std::nullopt};
  }
  template <class Other>
  std::optional<SchlickLobes> operator()(const Other& m) const {
    const std::optional<GgxLobe> ggx = round_ggx(Brdf{m});
    return ggx ? std::optional(SchlickLobes{*ggx, std::nullopt}) : std::nullopt;
  }
};

}  // namespace

std::optional<SchlickLobes> schlick_lobes(const Brdf& brdf) { return std::visit(Splitter{}, brdf); }

}  // namespace etendue::eval
