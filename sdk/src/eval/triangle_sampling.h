// Directions towards flat triangles: uniform over their solid angle, or over their area where the solid angle is too small for that.
#pragma once

#include "etendue/vec.h"

#include <array>
#include <vector>

namespace etendue::eval {

// Solid angle of a triangle, vertices relative to the point: tan(omega / 2) = |a.(b x c)| / (1 + ...) (van Oosterom and Strackee 1983).
double solid_angle_of(const std::array<Vec3d, 3>& triangle);

// Triangles in one plane, relative to the point.
class TriangleSampler {
 public:
  explicit TriangleSampler(std::vector<std::array<Vec3d, 3>> triangles);

  double solid_angle() const { return solid_angle_; }
  // A unit direction; the zero vector if there is none.
  Vec3d sample(Vec2d u) const;
  // Density of a unit direction that meets one of the triangles at the given distance.
  double pdf(const Vec3d& direction, double distance) const;

 private:
  std::vector<std::array<Vec3d, 3>> triangles_;
  std::vector<double> running_;  // sums of solid angle or area
  Vec3d normal_;
  double solid_angle_ = 0, area_ = 0;
  bool by_area_ = false;
};

}  // namespace etendue::eval
