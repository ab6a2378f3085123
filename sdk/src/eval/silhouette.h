// What a light covers of the directions around a point, shape by shape. Every position is relative to the point.
#pragma once

#include "contour.h"
#include "etendue/light.h"

#include <array>
#include <span>

namespace etendue::eval {

// Each returns an empty contour where the emitting side is not seen: from behind or within the plane, from inside a closed shape.
Contour sphere_silhouette(const Vec3d& centre, double radius);
Contour disk_silhouette(const Vec3d& centre, const Vec3d& normal, double radius, bool two_sided);
Contour polygon_silhouette(std::span<const Vec3d> vertices, const Vec3d& normal, bool two_sided);

// Tube between the cap centres a and b. Flat caps emit like the side. Without caps only the outer side emits: of the end that is seen,
// the near half of the rim bounds it, and the mouth of the tube is dark.
Contour tube_silhouette(const Vec3d& a, const Vec3d& b, double radius, Caps caps);
// Inside a tube: closer to the axis than the radius, within the caps.
bool inside_tube(const Vec3d& a, const Vec3d& b, double radius, Caps caps);

// The two planes through the point that touch the tube's side along its length, as unit normals pointing out of the tube: none within
// the infinite cylinder.
struct TubeTangents {
  bool exist = false;
  std::array<Vec3d, 2> normal;
};
TubeTangents tube_tangents(const Vec3d& a, const Vec3d& b, double radius);

}  // namespace etendue::eval
