// Where rays meet the shapes of lights. Directions are unit vectors; distances are positive.
#pragma once

#include "etendue/eval.h"

#include <optional>

namespace etendue::eval {

// The nearest point of the sphere, from outside or inside.
std::optional<double> hit_sphere(const Vec3d& centre, double radius, const Vec3d& position, const Vec3d& direction);
std::optional<double> hit_disk(const Vec3d& centre, const Vec3d& normal, double radius, const Vec3d& position, const Vec3d& direction);
// Vertices in order, either winding; even-odd rule.
std::optional<double> hit_polygon(const PolygonEmitter& polygon, const Vec3d& position, const Vec3d& direction);
// The nearest point; without caps, of the side.
std::optional<double> hit_tube(const TubeEmitter& tube, const Vec3d& position, const Vec3d& direction);
std::optional<double> hit_triangle(const std::array<Vec3d, 3>& triangle, const Vec3d& position, const Vec3d& direction);

}  // namespace etendue::eval
