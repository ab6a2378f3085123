// Points uniform over the surfaces of lights: the reference mode of Lagarde and de Rousiers 2014, appendix A.
#pragma once

#include "etendue/vec.h"

#include <variant>
#include <vector>

namespace etendue::eval {

struct SurfacePoint {
  Vec3d position, normal;  // normal: unit, of the emitting side
};

// What listing A.3 samples, each for itself, u in [0, 1)^2: the density is 1 / area() everywhere.
struct SpherePart {
  Vec3d centre;
  double radius;
  double area() const;
  SurfacePoint at(const Vec2d& u) const;
};
struct DiskPart {
  Vec3d centre, normal;
  double radius;
  double area() const;
  SurfacePoint at(const Vec2d& u) const;
};
struct ParallelogramPart {
  Vec3d corner, x, y;  // the sides from the corner
  Vec3d normal;
  double area() const;
  SurfacePoint at(const Vec2d& u) const;
};
// The side of a cylinder between the centres of its ends.
struct CylinderPart {
  Vec3d a, b;
  double radius;
  double area() const;
  SurfacePoint at(const Vec2d& u) const;
};
// Both hemispheres of a capsule: a sphere in halves.
struct CapsPart {
  Vec3d a, b;
  double radius;
  double area() const;
  SurfacePoint at(const Vec2d& u) const;
};
// Not in the listing: of polygons and meshes. Counter-clockwise about the emitting side.
struct TrianglePart {
  Vec3d a, b, c;
  double area() const;
  SurfacePoint at(const Vec2d& u) const;
};
using SurfacePart = std::variant<SpherePart, DiskPart, ParallelogramPart, CylinderPart, CapsPart, TrianglePart>;

// Parts that are sampled as one: u.x chooses among them by their areas. Listing A.3 draws from each as many samples as its share of them
// all is, rounded down, which leaves a thin capsule's caps or a short one's side with none and divides by it.
class Surface {
 public:
  explicit Surface(std::vector<SurfacePart> parts);

  double area() const { return running_.empty() ? 0 : running_.back(); }
  struct Sample {
    SurfacePoint point;
    std::size_t part;
  };
  // Only where the area is positive.
  Sample at(const Vec2d& u) const;

 private:
  std::vector<SurfacePart> parts_;
  std::vector<double> running_;  // sums of areas
};

}  // namespace etendue::eval
