// Published methods for the specular light of one area light at many points at once, in float, by name, so that they are timed and measured
// as SpecularBatch is: height-correlated round GGX with Schlick's Fresnel. `etendue bench` shows what each costs and errs.
//   const Result<SpecularMethodBatch> batch = SpecularMethodBatch::of("karis-14", emitter);
//   BatchOutcome done = batch->shares({points, vx, vy, vz, alpha}, of_f0, of_f90, 0);
#pragma once

#include "etendue/specular_batch.h"

#include <memory>
#include <span>
#include <string_view>
#include <utility>

namespace etendue::eval {

// One light made ready for a method.
class SpecularMethodBatch {
 public:
  // Those of specular_methods.h that have been written in vectors.
  static std::span<const std::string_view> names();
  // Errors: METHOD_SHAPE: the method has no vectors for the light: one-sided rectangles and disks, spheres, suns, tubes with round caps and
  // a length, uniform and without a window.
  static Result<SpecularMethodBatch> of(std::string_view method, const Emitter& emitter);

  // As SpecularBatch::shares: what the method gives in double, but for roundings of floats, within 2e-3 of the value or 1e-5 of
  // what the lobe has at most. Where a method has no finite number the shares are 0. Errors: BATCH_SIZES_DIFFER.
  BatchOutcome shares(const SpecularPoints& points, std::span<float> of_f0, std::span<float> of_f90, float where_none) const;
  const Rgb& scale() const { return scale_; }  // cd/m2

  class Light;  // sdk/src/eval/specular_method_batch.cpp

 private:
  SpecularMethodBatch(std::size_t method, std::shared_ptr<const Light> light, const Rgb& scale)
      : method_(method), light_(std::move(light)), scale_(scale) {}
  std::size_t method_;  // its place among names()
  std::shared_ptr<const Light> light_;
  Rgb scale_;
};

}  // namespace etendue::eval
