// Specular light of area lights to an asked tolerance: as few evaluations as it takes, and a bound that says what is left.
//   const auto light = specular_luminance(emitter, {position, normal, normal, view, GgxLobe{0.2}}, 1e-3);   // cd/m2
#pragma once

#include "etendue/eval.h"

#include <optional>

namespace etendue::eval {

// |error| <= tolerance max(value, 1e-3 E L, least) in every channel, E the illuminance that a luminance of 1 gives and L the light's own;
// `least` in cd/m2, 0 or more. `tolerance` from 1e-9 on. Estimate::error is what it is held to: the sum of estimates of all cells, which
// are made to lie above what their rules leave (sdk/docs/specular.md); tests/acceptance/specular --only adaptive counts how many answers
// keep it. Where 20000 cells do not reach the tolerance, the error is larger than asked. Lights that are thin along the horizon are left to
// `reference`. Takes round GGX of any masking with Schlick's Fresnel (GgxLobe, or such a SpecularLobe without compensation), and lights
// that have an outline: spheres, disks, polygons, tubes, meshes, suns, a constant sky, without pattern or window. Nothing for others.
std::optional<Estimate> specular_luminance(const Emitter& emitter, const ShadingPoint& point, double tolerance, double least = 0);

}  // namespace etendue::eval
