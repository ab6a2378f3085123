// The environment map and how directions are drawn from it.
#pragma once

#include "etendue/eval.h"

#include <vector>

namespace etendue::eval {

// Directions in the map's own frame. u grows from -Z (the seam) over +X to +Z (the centre column):
//   u = atan2(x, -z) / 2 pi (mod 1),  v = acos(y) / pi, row 0 at the top.
class EnvironmentMap {
 public:
  EnvironmentMap(std::uint32_t width, std::uint32_t height, std::vector<Vec3f> pixels);

  Rgb lookup(const Vec3d& direction) const;
  double mean_luminance() const { return mean_luminance_; }

  // A direction with the density pdf(direction), 1/sr: piecewise constant in (u, v) over the texels.
  Vec3d sample(const Vec2d& u) const;
  double pdf(const Vec3d& direction) const;

 private:
  Rgb texel(std::int64_t column, std::int64_t row) const;

  std::uint32_t width_, height_;
  std::vector<Vec3f> pixels_;
  std::vector<float> conditional_;  // per row, width + 1 running sums ending in 1
  std::vector<double> marginal_;    // height + 1 running sums ending in 1
  std::vector<double> row_weight_;  // of each row, summing to 1
  double mean_luminance_ = 0;
};

// The integral of BRDF x cosine x map above both horizons by multiple importance sampling.
Estimate environment_reference(const Emitter& emitter, const EnvironmentEmitter& environment, const ShadingPoint& point,
                               const Tolerance& tolerance);

}  // namespace etendue::eval
