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

bool is_modulated(const Emitter& emitter) { return static_cast<bool>(emitter.pattern) || is_window(emitter.window); }

namespace {

// Interpolated by the barycentric coordinates, which are ratios of areas seen along the normal.
Vec2d uv_in_triangle(const std::array<Vec3d, 3>& t, const std::array<Vec2d, 3>& uv, const Vec3d& point) {
  const Vec3d normal = cross(t[1] - t[0], t[2] - t[0]);
  const double twice = dot(normal, normal);
  if (!(twice > 0)) return uv[0];
  const double b1 = dot(cross(point - t[0], t[2] - t[0]), normal) / twice, b2 = dot(cross(t[1] - t[0], point - t[0]), normal) / twice;
  const double b0 = 1 - b1 - b2;
  return {b0 * uv[0].x + b1 * uv[1].x + b2 * uv[2].x, b0 * uv[0].y + b1 * uv[1].y + b2 * uv[2].y};
}

}  // namespace

// uv of a disk: (1 + x / R, 1 + y / R) / 2, y along cross(x, normal), as of the square around it.
Rgb pattern_at(const Emitter& emitter, std::size_t index, const Vec3d& point) {
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
  if (const auto* mesh = std::get_if<MeshEmitter>(&emitter.shape); mesh != nullptr && index < mesh->uvs.size()) {
    return emitter.pattern(uv_in_triangle(mesh->triangles[index], mesh->uvs[index], point));
  }
  return {1, 1, 1};
}

Rgb modulation_along(const Emitter& emitter, std::size_t index, const Vec3d& position, const Vec3d& direction) {
  const double distance = std::visit(Distance{emitter, index, position, direction}, emitter.shape);
  return pattern_at(emitter, index, position + direction * distance) * window_at(emitter.window, distance);
}

}  // namespace etendue::eval
