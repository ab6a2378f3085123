// The light of one emitter at a point within an asked tolerance, by the cheapest way that keeps it.
//   const LightWithin light = light_within(emitter, {position, normal, normal, view, Standard{}}, 1e-3);   // cd/m2
#pragma once

#include "etendue/eval.h"

#include <string_view>

namespace etendue::eval {

struct LightWithin {
  Estimate light;        // cd/m2; `error` is what is told of it, of both lobes where there are two
  std::string_view way;  // how it was found
};

// |error| <= tolerance max(value, 1e-3 E L) in every channel, E the illuminance that a luminance of 1 gives and L the light's own;
// tolerance from 1e-9 on.
//   unseen     below the horizon, or from behind: exactly 0, after one closed form
//   exact      Lambert, and whatever has no extent: a closed form
//   adaptive   GGX under area lights: specular_luminance
//   two lobes  Standard under area lights: half the tolerance for each, specular_luminance and `reference` of the diffuse lobe alone, which
//              has no peak
//   reference  all else
// No approximation with a fixed error is among them: `moments` is further off than .1 in a sixth of the configurations of
// tests/acceptance/specular --only adaptive, the transformed cosines in a quarter.
LightWithin light_within(const Emitter& emitter, const ShadingPoint& point, double tolerance);

}  // namespace etendue::eval
