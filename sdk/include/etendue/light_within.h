// The light of one emitter at a point within an asked tolerance, by the cheapest way that keeps it.
//   const LightWithin light = light_within(emitter, {position, normal, normal, view, Standard{}}, 1e-3);   // cd/m2
//   const LightPlan plan(emitter, {1e-3, 0});   // for many points of any surfaces
//   const std::vector<LightWithin> lights = plan(points);
#pragma once

#include "etendue/eval.h"

#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace etendue::eval {

class PictureMoments;

struct LightWithin {
  Estimate light;        // cd/m2; `error` is what is told of it, of both lobes where there are two
  std::string_view way;  // how it was found
};

// |error| <= tolerance max(value, 1e-3 E L) in every channel, E the illuminance that a luminance of 1 gives and L the light's own;
// tolerance from 1e-9 on.
//   unseen     below the horizon, or from behind: exactly 0, after one closed form
//   exact      Lambert, and whatever has no extent: a closed form
//   far        a light that is small where it stands: a few places of it, both lobes at once (far_luminance.h)
//   adaptive   GGX under area lights: specular_luminance
//   two lobes  Standard, MetalRough and TwoColour under area lights: half the tolerance for each lobe, GGX as above and `reference` of the
//              diffuse one alone, which has no peak
//   cells      either, with GGX in vectors (specular_within_batch.h): not meshes; many points, from 1e-4 (two lobes: 2e-4) on
//   picture    a rectangle with a picture whose moments are given (picture_light.h), where its cells are enough
//   reference  all else
// No approximation with a fixed error is among them: `moments` is further off than .1 in a sixth of the configurations of
// tests/acceptance/specular --only adaptive, the transformed cosines in a quarter.
LightWithin light_within(const Emitter& emitter, const ShadingPoint& point, double tolerance);

// The same for many points under one light, which has to outlive it. |error| <= max(relative max(value, 1e-3 E L), absolute); `absolute` in
// cd/m2. What does not hang on the point is made once. May be used from several threads.
class LightPlan {
 public:
  // `picture`: that of the emitter's pattern, or null.
  LightPlan(const Emitter& emitter, const Tolerance& tolerance, std::shared_ptr<const PictureMoments> picture = nullptr);

  LightWithin operator()(const ShadingPoint& point) const;
  // As many answers as points.
  std::vector<LightWithin> operator()(std::span<const ShadingPoint> points) const;

 private:
  struct Batches;
  const Emitter& emitter_;
  Tolerance tolerance_;
  std::shared_ptr<const Batches> batches_;
  std::shared_ptr<const PictureMoments> picture_;
};

}  // namespace etendue::eval
