// Ray intersections in double with the curved and planar shapes of lights and with spheres. The smallest distance in (t_min, t_max) or
// none.
#pragma once

#include "etendue/eval.h"
#include "etendue/vec.h"

#include <optional>
#include <variant>

namespace etendue::rendering {

struct Ray {
  Vec3d origin, direction;  // the direction is a unit vector
};

// The box that contains a shape.
struct Box {
  Vec3d min, max;
};

using Shape = std::variant<eval::SphereEmitter, eval::DiskEmitter, eval::PolygonEmitter, eval::TubeEmitter>;

std::optional<double> intersect(const Shape& shape, const Ray& ray, double t_min, double t_max);
// Unit normal on the emitting side (outwards for closed shapes) at a point of the surface.
Vec3d normal_at(const Shape& shape, const Vec3d& point);
Box box_of(const Shape& shape);

}  // namespace etendue::rendering
