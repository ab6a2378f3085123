// What one light sends towards the eye: from its own surface, reflected without anything in between, and what shadows take away from that.
#pragma once

#include "probe.h"

#include "etendue/eval.h"

namespace etendue::rendering {

inline constexpr int replicates = 8;  // independent estimates that a variance is computed from

// The estimate of a pixel's reflected light minus beta times its unblocked light, both from the same samples (see sdk/docs/rendering.md).
struct Sampled {
  Rgb mean, variance;                   // of the mean
  double visible_sum = 0, all_sum = 0;  // of the samples' light with and without shadows
};

// Where the samples of a pixel lie: over its area, or on one plane that fills it.
struct PixelTarget {
  std::uint32_t x = 0, y = 0;
  const SurfacePoint* plane = nullptr;  // set: a flat, untextured surface fills the whole pixel
};

class Lighting {
 public:
  Lighting(const Stage& stage, const PinholeCamera& camera) : stage_(stage), camera_(camera) {}

  // Luminance of the light's own surface, or of the environment behind everything.
  Rgb emitted(const StageLight& light, const std::optional<SurfacePoint>& point, const Ray& ray) const;
  // Reflected luminance with nothing in between; a punctual light's with its shadow. Only for analytic and delta lights.
  Rgb reflected(const StageLight& light, const SurfacePoint& point, const Vec3d& view, const eval::Tolerance& tolerance,
                RayCounts& counts) const;
  // The mean of (V - beta) times reflected light over pixel and light; V is 1 where the light is seen and else 0.
  Sampled sample(const StageLight& light, const PixelTarget& target, double beta, int points_a_replicate, std::uint64_t seed,
                 RayCounts& counts) const;

 private:
  std::optional<SurfacePoint> target_point(const PixelTarget& target, const Ray& ray, RayCounts& counts) const;

  const Stage& stage_;
  const PinholeCamera& camera_;
};

}  // namespace etendue::rendering
