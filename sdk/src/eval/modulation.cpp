#include "modulation.h"

#include "hit.h"

#include <cmath>

namespace etendue::eval {
namespace {

double plane_distance(const Vec3d& on_plane, const Vec3d& normal, const Vec3d& position, const Vec3d& direction) {
  const double slope = dot(direction, normal);
  return slope != 0 ? std::abs(dot(on_plane - position, normal) / slope) : length(on_plane - position);
}

struct Distance {
  const Emitter& emitter;
  std::size_t index;
  const Vec3d& position;
  const Vec3d& direction;

  double operator()(const DiskEmitter& e) const { return plane_distance(e.centre, e.normal, position, direction); }
  double operator()(const PolygonEmitter& e) const { return plane_distance(e.vertices[0], e.normal, position, direction); }
  double operator()(const MeshEmitter& e) const {
    const auto& t = e.triangles[index];
    return plane_distance(t[0], cross(t[1] - t[0], t[2] - t[0]), position, direction);
  }
  // A ray that rounding leads past the edge is given the distance of its closest approach.
  double operator()(const SphereEmitter& e) const {
    return hit_sphere(e.centre, e.radius, position, direction).value_or(dot(e.centre - position, direction));
  }
  double operator()(const TubeEmitter& e) const {
    return hit_tube(e, position, direction).value_or(dot((e.a + e.b) * 0.5 - position, direction));
  }
  template <class Other>
  double operator()(const Other&) const {
    return 0;
  }
};

}  // namespace

bool is_modulated(const Emitter& emitter) {
  return static_cast<bool>(emitter.pattern) || (emitter.window.falloff != Falloff::inverse_square && emitter.window.range_m > 0);
}

// uv of a disk: (u, v) = (1 + x / R, 1 + y / R) / 2 along its x axis and the one that makes (x, y, -normal) right-handed, as for a
// rectangle that encloses it.
Rgb pattern_at(const Emitter& emitter, const Vec3d& point) {
  if (!emitter.pattern) return {1, 1, 1};
  if (const auto* polygon = std::get_if<PolygonEmitter>(&emitter.shape)) {
    const auto& [origin, u, v] = polygon->uv_frame;
    const Vec3d p = point - origin;
    return emitter.pattern({dot(p, u) / dot(u, u), dot(p, v) / dot(v, v)});
  }
  if (const auto* disk = std::get_if<DiskEmitter>(&emitter.shape)) {
    const Vec3d p = (point - disk->centre) / disk->radius, y = cross(disk->x, disk->normal);
    return emitter.pattern({0.5 * (1 + dot(p, disk->x)), 0.5 * (1 + dot(p, y))});
  }
  return {1, 1, 1};
}

Rgb modulation_along(const Emitter& emitter, std::size_t index, const Vec3d& position, const Vec3d& direction) {
  const double distance = std::visit(Distance{emitter, index, position, direction}, emitter.shape);
  return pattern_at(emitter, position + direction * distance) * window_at(emitter.window, distance);
}

}  // namespace etendue::eval
