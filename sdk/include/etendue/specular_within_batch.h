// The specular light of one polygon, sphere, disk, sun or tube at many points to an asked tolerance, on the best instruction set
// that the machine has: round GGX with Schlick's Fresnel, the integral of specular_light.h with its cells in vectors.
//   const Result<SpecularWithinBatch> batch = SpecularWithinBatch::of(emitter, 1e-3);
//   BatchOutcome done = batch->shares({points, vx, vy, vz, alpha}, {of_f0, of_f90, bound_f0, bound_f90}, 0);
//   luminance = batch->scale() * (f0 * of_f0[i] + f90 * of_f90[i]);   // cd/m2 towards the view, in any colour of f0
#pragma once

#include "etendue/specular_batch.h"

namespace etendue::eval {

// Of each point the luminance for a light of 1 cd/m2 as factors on f0 and f90, and bounds of its error as such: f0 bound_f0 + f90
// bound_f90. Bounds that are not asked for are empty.
struct BoundedShares {
  std::span<float> of_f0, of_f90, bound_f0, bound_f90;
};

// The same points in doubles, one after the other.
struct SpecularPlace {
  Vec3d position, normal, view;
  double alpha;
};

class SpecularWithinBatch {
 public:
  static constexpr double least_f0 = 0.02, least_tolerance = 1e-4, most_tolerance = 0.1;

  // |error| <= tolerance max(value, 1e-3 E L, least) as for specular_luminance, wherever f0 is least_f0 f90 or more and no more than f90;
  // `least` in cd/m2. Masking is correlated or separable.
  // Errors: METHOD_SHAPE: no uniform polygon, sphere, disk, sun or tube without a window; METHOD_LOBE: other masking;
  // TOLERANCE_OUT_OF_RANGE.
  static Result<SpecularWithinBatch> of(const Emitter& emitter, double tolerance, Masking masking = Masking::correlated, double least = 0);

  // Points that a rectangle is far from take a few places of it (far_luminance.h), most others cells of floats; where a float has too few
  // digits, of a concave polygon the horizon leaves more than four parts, or the cells do not get there, specular_luminance in double is
  // asked for the tolerance. Bounds are estimates, as those of
  // specular_luminance are; tests/acceptance/specular --only adaptive counts how many answers keep them. Points with a number that is not
  // finite become `where_none`, and are counted. Errors: BATCH_SIZES_DIFFER.
  BatchOutcome shares(const SpecularPoints& points, const BoundedShares& to, float where_none) const;
  BatchOutcome shares(std::span<const SpecularPlace> points, const BoundedShares& to, float where_none) const;
  const Rgb& scale() const { return scale_; }  // cd/m2

  class Light;  // sdk/src/eval/specular_within_batch.cpp

 private:
  SpecularWithinBatch(double tolerance, std::shared_ptr<const Light> light, const Rgb& scale)
      : tolerance_(tolerance), light_(std::move(light)), scale_(scale) {}
  template <class Fill>
  std::size_t over(std::size_t count, const Vec3d& origin, const Fill& fill, const BoundedShares& to, float where_none) const;

  double tolerance_;
  std::shared_ptr<const Light> light_;
  Rgb scale_;
};

}  // namespace etendue::eval
