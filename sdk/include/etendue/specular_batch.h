// The specular light of one area light at many points at once, in float, on the best instruction set that the machine has:
// height-correlated round GGX with Schlick's Fresnel, by a method of specular_methods.h.
//   const Result<SpecularBatch> batch = SpecularBatch::of(SpecularRule::moments, emitter);
//   BatchOutcome done = batch->shares({points, vx, vy, vz, alpha}, of_f0, of_f90, 0);
//   luminance = batch->scale() * (f0 * of_f0[i] + f90 * of_f90[i]);   // cd/m2 towards the view, in any colour of f0
#pragma once

#include "etendue/illuminance_batch.h"

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

namespace etendue::eval {

// Shading points whose surface and shading normals are one; unit vectors to the eye; alpha (roughness squared), below 1e-4 taken as that.
struct SpecularPoints {
  PointBatch surface;
  std::span<const float> vx, vy, vz, alpha;
};

enum class SpecularRule { ltc, ltc_one_cosine, ltc_two_lobes, ltc_two_cosines, ltc_two_caps, moments };

class SpecularBatch {
 public:
  // `ltc`, `ltc-one-cosine`, `ltc-two-lobes`, `ltc-two-cosines`, `ltc-two-caps` and `moments`; nothing for other names.
  static std::optional<SpecularRule> rule_named(std::string_view method);
  // Errors: METHOD_SHAPE: the rule has no vectors for the light: rectangles (not by caps), spheres, disks, suns and tubes with
  // round caps (these not by caps), uniform and without a window; `ltc-two-cosines` rectangles alone,
  // `ltc-one-cosine` no tubes.
  static Result<SpecularBatch> of(SpecularRule rule, const Emitter& emitter);

  // Of each point the luminance for a light of 1 cd/m2, as factors on f0 and on f90: what the method gives in double, but for roundings of
  // floats, within 2e-3 of the value, 1e-4, and 2e-6 / (alpha n.v); on the mean 5e-5 of the light; of
  // round lights and tubes by moments 1e-2, whose outline is in other parts. Points with a number that is not finite
  // become `where_none`, and are counted. Errors: BATCH_SIZES_DIFFER.
  BatchOutcome shares(const SpecularPoints& points, std::span<float> of_f0, std::span<float> of_f90, float where_none) const;
  const Rgb& scale() const { return scale_; }  // cd/m2

  class Light;  // sdk/src/eval/specular_batch.h

 private:
  SpecularBatch(SpecularRule rule, std::shared_ptr<const Light> light, const Rgb& scale)
      : rule_(rule), light_(std::move(light)), scale_(scale) {}
  SpecularRule rule_;
  std::shared_ptr<const Light> light_;
  Rgb scale_;
};

}  // namespace etendue::eval
