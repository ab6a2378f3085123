// Frostbite's standard model as a map of what it gives back of a white sky, and a variant of it that never gives back more than it gets.
//   const EnergySafeStandard safe{surface, standard_albedos()};
//   const Rgb f_cos = brdf_cos(safe, view, light);
#pragma once

#include "etendue/directional_albedo.h"
#include "etendue/eval.h"

#include <memory>

namespace etendue::eval {

// Directional albedo of both lobes together, seen with that cosine; exact, to that relative error of the specular part. With a white base
// colour up to 1.13 for cosines from .05 on (sdk/docs/materials.md has the map): the model is not energy-safe.
Rgb standard_albedo(const Standard& surface, double cosine, double relative = 1e-10);

// Of the model's GGX lobe, over all roughnesses and cosines. Made in one to two seconds; one serves all surfaces.
std::shared_ptr<const AlbedoTable> standard_albedos();

// The model with its diffuse lobe multiplied by s(v) s(l), s as diffuse_kept(): reciprocal, at most as bright as the model anywhere, equal
// to it wherever light and view both come under angles at which white would be safe, and of an albedo of at most 1 at any view, for every
// base colour, metal mask, roughness and reflectance. `albedos` is of standard_albedos().
struct EnergySafeStandard {
  Standard surface;
  std::shared_ptr<const AlbedoTable> albedos;
};
// s(x) = min(1, (1 - E_s(x)) / ((1 - metal) E_d(x))) channel by channel, E_s the albedo of the specular lobe, E_d of the white diffuse one.
Rgb diffuse_kept(const EnergySafeStandard& safe, double cosine);
// Directional albedo: at most 1. The diffuse lobe's part within 1e-5.
Rgb standard_albedo(const EnergySafeStandard& safe, double cosine, double relative = 1e-10);
// BRDF times cosine of `light`, 1/sr, as brdf_cos(Brdf). Being no brighter than its surface, it is sampled as that is (sample_brdf).
Rgb brdf_cos(const EnergySafeStandard& safe, const Vec3d& view, const Vec3d& light);

}  // namespace etendue::eval
