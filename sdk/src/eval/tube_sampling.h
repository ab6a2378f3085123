// Directions towards a tube: a mixture of the quadrilateral between its two tangent lines and of its ends.
#pragma once

#include "etendue/eval.h"
#include "silhouette.h"
#include "triangle_sampling.h"

#include <array>
#include <optional>

namespace etendue::eval {

// A cone of directions, uniform: sine and cosine of its half angle.
struct Cone {
  Vec3d axis;
  double sine, cosine;
};
Cone cone_around(const Vec3d& centre, double radius);
double solid_angle_of(const Cone& cone);
Vec3d sample(const Cone& cone, const Vec2d& u);
bool contains(const Cone& cone, const Vec3d& direction);

// What is seen of a tube lies within the union of the parts; each is chosen in proportion to its weight and the densities add up. A
// direction of the mixture may miss the tube; the caller's ray decides.
class TubeSampler {
 public:
  TubeSampler(const TubeEmitter& tube, const Vec3d& position);

  Vec3d sample(Vec2d u) const;
  double pdf(const Vec3d& direction) const;

 private:
  double end_pdf(std::size_t end, const Vec3d& direction) const;

  std::array<Vec3d, 2> end_;  // centres of the caps, relative to the point
  Vec3d axis_;
  double radius_ = 0;
  bool round_ = true;
  std::optional<TriangleSampler> side_;
  std::array<Vec3d, 4> corner_{};
  std::array<double, 3> weight_{};  // end a, end b, side; they add up to 1, or are all 0
};

}  // namespace etendue::eval
