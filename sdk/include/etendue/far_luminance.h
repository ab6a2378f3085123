// Light that is small beside whatever a surface's reflectance bends over: a few places of the light are enough, with a bound.
//   const auto light = far_luminance(emitter, {position, normal, normal, view, Standard{}}, 1e-3);   // cd/m2
#pragma once

#include "etendue/eval.h"

#include <optional>

namespace etendue::eval {

// |error| <= relative value in every channel, by the fewest places that a bound allows: 1 to 64 of a parallelogram, disk, sphere or sun of
// one luminance without a window, whole above both horizons, on surfaces that reflect GGX of any masking, Disney's, Frostbite's or glTF's
// diffuse lobe, or both. Nothing for others and where 64 places would not do. Estimate::error is the bound: twice what the leading term of
// the rule's error is at most, which no configuration of tests/acceptance/far_errors has exceeded (sdk/docs/specular.md, "Far lights").
std::optional<Estimate> far_luminance(const Emitter& emitter, const ShadingPoint& point, double relative);

}  // namespace etendue::eval
