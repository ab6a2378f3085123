#include "etendue/layered_surface.h"

#include "etendue/material_fit.h"
#include "etendue/material_parameters.h"
#include "etendue/plausibility.h"

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

template <class T>
T mixed(const T& below, const T& above, double share) {
  return below * (1 - share) + above * share;
}

struct RoughnessOf {
  double operator()(const Lambert&) const { return 1; }
  double operator()(const Conductor& m) const { return std::sqrt(m.alpha); }
  double operator()(const SpecularGlossiness& m) const { return 1 - m.glossiness; }
  template <class Model>
  double operator()(const Model& m) const {
    return m.roughness;
  }
};

Standard mixed_colours(const Standard& below, const Standard& above, double share) {
  const ColourPair a = colour_pair_of({below.base_colour, below.metal, below.reflectance});
  const ColourPair b = colour_pair_of({above.base_colour, above.metal, above.reflectance});
  const DisneyColours fit = fit_disney({mixed(a.diffuse, b.diffuse, share), mixed(a.f0, b.f0, share)}).value;
  return {fit.base_colour, fit.metal, mixed(below.roughness, above.roughness, share), fit.reflectance};
}

Standard mixed_parameters(const Standard& below, const Standard& above, double share) {
  return {mixed(below.base_colour, above.base_colour, share), mixed(below.metal, above.metal, share),
          mixed(below.roughness, above.roughness, share), mixed(below.reflectance, above.reflectance, share)};
}

}  // namespace

Standard standard_of(const SurfaceModel& model) {
  if (const auto* standard = std::get_if<Standard>(&model)) return *standard;
  if (const auto* m = std::get_if<MetalRough>(&model))
    return {m->base_colour, m->metallic, m->roughness, reflectance_of_f0(f0_of_ior(m->ior)).value};
  const SurfaceColours colours = described(model);
  const DisneyColours best = colours.metal ? fit_disney_at(*colours.metal, colours.pair) : fit_disney(colours.pair).value;
  return {best.base_colour, best.metal, std::visit(RoughnessOf{}, model), best.reflectance};
}

std::vector<double> layer_weights(std::span<const double> masks) {
  std::vector<double> weights(masks.size());
  double left = 1;
  for (std::size_t i = masks.size(); i-- > 0;) {
    const double mask = i == 0 ? 1 : std::clamp(masks[i], 0.0, 1.0);
    weights[i] = left * mask;
    left *= 1 - mask;
  }
  return weights;
}

std::string_view name_of(NormalBlend blend) {
  switch (blend) {
    case NormalBlend::replace:
      return "replace";
    case NormalBlend::slopes:
      return "slopes";
    case NormalBlend::reoriented:
      break;
  }
  return "reoriented";
}
std::optional<NormalBlend> normal_blend_named(std::string_view name) {
  for (const NormalBlend blend : normal_blends)
    if (name == name_of(blend)) return blend;
  return std::nullopt;
}
std::optional<LayerBlend> layer_blend_named(std::string_view name) {
  if (name == "parameters") return LayerBlend::parameters;
  if (name == "colours") return LayerBlend::colours;
  return std::nullopt;
}

// Reoriented: the rotation that takes z to `below` takes `above` along. With t = below + z it is t (t.a) / t.z - a of a = (-x, -y, z).
Vec3d blended_normal(const Vec3d& below, const Vec3d& above, NormalBlend blend) {
  if (blend == NormalBlend::replace || below.z <= 0 || above.z <= 0) return above;
  if (blend == NormalBlend::slopes)
    return normalised(Vec3d{below.x * above.z + above.x * below.z, below.y * above.z + above.y * below.z, below.z * above.z});
  const Vec3d t{below.x, below.y, below.z + 1}, a{-above.x, -above.y, above.z};
  return normalised(t * (dot(t, a) / t.z) - a);
}

LayerValue blended(std::span<const LayerValue> layers, std::span<const double> masks, NormalBlend normals, LayerBlend blend) {
  LayerValue out = layers[0];
  for (std::size_t i = 1; i < layers.size(); ++i) {
    const LayerValue& layer = layers[i];
    const double share = std::clamp(masks[i], 0.0, 1.0);
    if (share == 0) continue;
    out.surface = blend == LayerBlend::colours ? mixed_colours(out.surface, layer.surface, share)
                                               : mixed_parameters(out.surface, layer.surface, share);
    const Vec3d normal = mixed(out.normal, blended_normal(out.normal, layer.normal, normals), share);
    out.normal = dot(normal, normal) > 0 ? normalised(normal) : layer.normal;
    out.occlusion = mixed(out.occlusion, layer.occlusion, share);
    out.emissive = mixed(out.emissive, layer.emissive, share);
  }
  return out;
}

}  // namespace etendue
