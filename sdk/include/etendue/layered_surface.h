// Layers of surfaces at one place, the lowest first, each covering what is below it by its mask: blended to one surface, or left as they
// are and their light summed up (layered_light.h).
#pragma once

#include "etendue/material.h"
#include "etendue/vec.h"

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace etendue {

struct LayerValue {
  Standard surface;
  Vec3d normal{0, 0, 1};  // tangent space, unit
  double occlusion = 1;   // of indirect light
  Rgb emissive{0, 0, 0};  // cd/m2
};
// Of any model: Disney parameters of what it comes to (plausibility.h), nearest where it is two colours or a conductor.
Standard standard_of(const SurfaceModel& model);

// What each layer's light counts for: its mask times what the layers above leave, masks held within [0, 1]. The lowest one's mask is taken
// as 1: they sum up to 1.
std::vector<double> layer_weights(std::span<const double> masks);

// How a layer's normal goes with the one below it, before the mask.
enum class NormalBlend {
  replace,     // it takes its place: a layer that hides the relief below
  slopes,      // (x, y) / z add up: two height fields over each other
  reoriented,  // it is turned to stand on the one below (Barre-Brisebois and Hill 2012, Blending in Detail): a thin layer over a relief
};
inline constexpr std::array<NormalBlend, 3> normal_blends{NormalBlend::replace, NormalBlend::slopes, NormalBlend::reoriented};
std::string_view name_of(NormalBlend blend);
std::optional<NormalBlend> normal_blend_named(std::string_view name);
// Unit vectors; `below` and `above` with z > 0, else as `replace`.
Vec3d blended_normal(const Vec3d& below, const Vec3d& above, NormalBlend blend);

enum class LayerBlend {
  parameters,  // base colour (linear), metal, roughness and reflectance are mixed each for itself, as engines do (Karis 2013)
  colours,     // diffuse albedo and f0 are mixed, which is what layers of one roughness do, and their nearest Disney parameters taken
};
std::optional<LayerBlend> layer_blend_named(std::string_view name);  // "parameters", "colours"

// `masks` as many as layers, not none. The mask mixes normals linearly, then to unit length; occlusion and emission linearly.
LayerValue blended(std::span<const LayerValue> layers, std::span<const double> masks, NormalBlend normals = NormalBlend::replace,
                   LayerBlend blend = LayerBlend::parameters);

}  // namespace etendue
