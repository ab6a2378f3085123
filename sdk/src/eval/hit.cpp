#include "hit.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {
namespace {

// Smallest positive root of t^2 - 2 h t + c = 0, c formed without cancellation by the caller.
std::optional<double> nearest_root(double h, double c, double discriminant) {
  if (!(discriminant >= 0)) return std::nullopt;
  const double root = std::sqrt(discriminant);
  const double far = h > 0 ? h + root : h - root;
  const double t0 = far, t1 = far != 0 ? c / far : 0;
  const double lo = std::min(t0, t1), hi = std::max(t0, t1);
  if (lo > 0) return lo;
  if (hi > 0) return hi;
  return std::nullopt;
}

std::optional<double> plane_hit(const Vec3d& on_plane, const Vec3d& normal, const Vec3d& position, const Vec3d& direction) {
  const double slope = dot(direction, normal);
  if (slope == 0) return std::nullopt;
  const double t = dot(on_plane - position, normal) / slope;
  return t > 0 && std::isfinite(t) ? std::optional<double>(t) : std::nullopt;
}

void keep_nearer(std::optional<double>& best, const std::optional<double>& other) {
  if (other && (!best || *other < *best)) best = other;
}

}  // namespace

// The discriminant from the distance of the centre to the ray (Haines et al. 2019, Ray Tracing Gems, ch. 7).
std::optional<double> hit_sphere(const Vec3d& centre, double radius, const Vec3d& position, const Vec3d& direction) {
  const Vec3d to = centre - position;
  const double h = dot(to, direction);
  const Vec3d off = to - direction * h;
  const double d = length(to);
  return nearest_root(h, (d - radius) * (d + radius), radius * radius - dot(off, off));
}

std::optional<double> hit_disk(const Vec3d& centre, const Vec3d& normal, double radius, const Vec3d& position, const Vec3d& direction) {
  const auto t = plane_hit(centre, normal, position, direction);
  if (!t) return std::nullopt;
  const Vec3d p = position + direction * *t - centre;
  return dot(p, p) <= radius * radius ? t : std::nullopt;
}

std::optional<double> hit_polygon(const PolygonEmitter& polygon, const Vec3d& position, const Vec3d& direction) {
  if (polygon.vertices.size() < 3) return std::nullopt;
  const auto t = plane_hit(polygon.vertices[0], polygon.normal, position, direction);
  if (!t) return std::nullopt;
  const Vec3d p = position + direction * *t;
  const Basis basis = basis_around(polygon.normal);
  // Crossings of the half line from p along the tangent.
  bool inside = false;
  const std::size_t n = polygon.vertices.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3d a = polygon.vertices[i] - p, b = polygon.vertices[(i + 1) % n] - p;
    const double ay = dot(a, basis.bitangent), by = dot(b, basis.bitangent);
    if ((ay > 0) == (by > 0)) continue;
    const double ax = dot(a, basis.tangent), bx = dot(b, basis.tangent);
    if (ax + (bx - ax) * (ay / (ay - by)) > 0) inside = !inside;
  }
  return inside ? t : std::nullopt;
}

std::optional<double> hit_tube(const TubeEmitter& tube, const Vec3d& position, const Vec3d& direction) {
  std::optional<double> best;
  const Vec3d span = tube.b - tube.a;
  const double l = length(span);
  if (l > 0) {
    const Vec3d axis = span / l;
    const Vec3d to = tube.a - position;
    const Vec3d off = to - axis * dot(to, axis);
    const Vec3d across = direction - axis * dot(direction, axis);
    const double speed2 = dot(across, across);
    if (speed2 > 0) {
      const double h = dot(off, across) / speed2;
      const Vec3d miss = off - across * h;
      const double d = length(off);
      const double c = (d - tube.radius) * (d + tube.radius) / speed2;
      const double discriminant = (tube.radius * tube.radius - dot(miss, miss)) / speed2;
      if (discriminant >= 0) {
        // Both crossings of the infinite cylinder; each counts if it lies between the caps.
        const double root = std::sqrt(discriminant), far = h > 0 ? h + root : h - root;
        for (const double t : {far, far != 0 ? c / far : 0.0}) {
          const double along = dot(position + direction * t - tube.a, axis);
          if (t > 0 && along >= 0 && along <= l) keep_nearer(best, t);
        }
      }
    }
    if (tube.caps == Caps::flat) {
      keep_nearer(best, hit_disk(tube.a, axis, tube.radius, position, direction));
      keep_nearer(best, hit_disk(tube.b, axis, tube.radius, position, direction));
    }
  }
  if (tube.caps == Caps::round) {
    keep_nearer(best, hit_sphere(tube.a, tube.radius, position, direction));
    keep_nearer(best, hit_sphere(tube.b, tube.radius, position, direction));
  }
  return best;
}

// Moeller and Trumbore 1997.
std::optional<double> hit_triangle(const std::array<Vec3d, 3>& triangle, const Vec3d& position, const Vec3d& direction) {
  const Vec3d e1 = triangle[1] - triangle[0], e2 = triangle[2] - triangle[0];
  const Vec3d p = cross(direction, e2);
  const double det = dot(e1, p);
  if (det == 0) return std::nullopt;
  const Vec3d s = position - triangle[0];
  const double u = dot(s, p) / det;
  const Vec3d q = cross(s, e1);
  const double v = dot(direction, q) / det;
  if (!(u >= 0 && v >= 0 && u + v <= 1)) return std::nullopt;
  const double t = dot(e2, q) / det;
  return t > 0 && std::isfinite(t) ? std::optional<double>(t) : std::nullopt;
}

}  // namespace etendue::eval
