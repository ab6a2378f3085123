#include "shapes.h"

#include <algorithm>
#include <cmath>

namespace etendue::rendering {
namespace {

// Keeps the smallest admissible distance of several candidates.
class Nearest {
 public:
  Nearest(double t_min, double t_max) : t_min_(t_min), best_(t_max) {}
  void offer(double t) {
    if (t > t_min_ && t < best_) best_ = t, found_ = true;
  }
  std::optional<double> result() const { return found_ ? std::optional(best_) : std::nullopt; }

 private:
  double t_min_, best_;
  bool found_ = false;
};

// |o + t d - c|^2 = r^2. With b = (o - c).d and the part of o - c across the ray, a, the roots are -b -+ sqrt(r^2 - a^2): no cancellation
// of large squares.
struct Roots {
  double near, far;
};
std::optional<Roots> sphere_roots(const Vec3d& centre, double radius, const Ray& ray) {
  const Vec3d to_origin = ray.origin - centre;
  const double b = dot(to_origin, ray.direction);
  const Vec3d across = to_origin - ray.direction * b;
  const double discriminant = radius * radius - dot(across, across);
  if (discriminant < 0) return std::nullopt;
  const double s = std::sqrt(discriminant);
  return Roots{-b - s, -b + s};
}

std::optional<double> plane_distance(const Vec3d& point, const Vec3d& normal, const Ray& ray) {
  const double towards = dot(normal, ray.direction);
  if (towards == 0) return std::nullopt;
  return dot(normal, point - ray.origin) / towards;
}

void offer(const eval::SphereEmitter& s, const Ray& ray, Nearest& nearest) {
  if (const auto roots = sphere_roots(s.centre, s.radius, ray)) nearest.offer(roots->near), nearest.offer(roots->far);
}

void offer(const eval::DiskEmitter& d, const Ray& ray, Nearest& nearest) {
  const auto t = plane_distance(d.centre, d.normal, ray);
  if (!t) return;
  const Vec3d from_centre = ray.origin + ray.direction * *t - d.centre;
  if (dot(from_centre, from_centre) <= d.radius * d.radius) nearest.offer(*t);
}

// Crossing number in the coordinate plane that the polygon's normal leans away from least.
bool inside(const eval::PolygonEmitter& polygon, const Vec3d& point) {
  const Vec3d n{std::abs(polygon.normal.x), std::abs(polygon.normal.y), std::abs(polygon.normal.z)};
  const int dropped = n.x > n.y && n.x > n.z ? 0 : n.y > n.z ? 1 : 2;
  const int i = (dropped + 1) % 3, j = (dropped + 2) % 3;
  bool in = false;
  const auto& v = polygon.vertices;
  for (std::size_t k = 0, last = v.size() - 1; k < v.size(); last = k++) {
    const bool above = v[k][j] > point[j], last_above = v[last][j] > point[j];
    if (above == last_above) continue;
    const double crossing = v[k][i] + (point[j] - v[k][j]) * (v[last][i] - v[k][i]) / (v[last][j] - v[k][j]);
    if (point[i] < crossing) in = !in;
  }
  return in;
}

void offer(const eval::PolygonEmitter& p, const Ray& ray, Nearest& nearest) {
  if (p.vertices.empty()) return;
  const auto t = plane_distance(p.vertices.front(), p.normal, ray);
  if (t && inside(p, ray.origin + ray.direction * *t)) nearest.offer(*t);
}

struct Axis {
  Vec3d direction;
  double length;
};
Axis axis_of(const eval::TubeEmitter& t) {
  const Vec3d along = t.b - t.a;
  const double l = length(along);
  return {l > 0 ? along / l : Vec3d{1, 0, 0}, l};
}

// The side is a circle's quadratic across the axis, kept where the place along the axis lies between the caps.
void offer_side(const eval::TubeEmitter& tube, const Axis& axis, const Ray& ray, Nearest& nearest) {
  const Vec3d from_a = ray.origin - tube.a;
  const double d_along = dot(ray.direction, axis.direction), o_along = dot(from_a, axis.direction);
  const Vec3d d_across = ray.direction - axis.direction * d_along, o_across = from_a - axis.direction * o_along;
  const double a = dot(d_across, d_across);
  if (a < 1e-24) return;
  const double b = dot(o_across, d_across) / a;
  const Vec3d closest = o_across - d_across * b;
  const double discriminant = (tube.radius * tube.radius - dot(closest, closest)) / a;
  if (discriminant < 0) return;
  const double s = std::sqrt(discriminant);
  for (const double t : {-b - s, -b + s}) {
    const double place = o_along + t * d_along;
    if (place >= 0 && place <= axis.length) nearest.offer(t);
  }
}

void offer_cap(const eval::TubeEmitter& tube, const Vec3d& centre, const Vec3d& outward, const Ray& ray, Nearest& nearest) {
  if (tube.caps == Caps::flat) {
    offer(eval::DiskEmitter{centre, outward, {}, tube.radius}, ray, nearest);
  } else if (tube.caps == Caps::round) {
    const auto roots = sphere_roots(centre, tube.radius, ray);
    if (!roots) return;
    for (const double t : {roots->near, roots->far}) {
      if (dot(ray.origin + ray.direction * t - centre, outward) >= 0) nearest.offer(t);
    }
  }
}

void offer(const eval::TubeEmitter& tube, const Ray& ray, Nearest& nearest) {
  const Axis axis = axis_of(tube);
  offer_side(tube, axis, ray, nearest);
  offer_cap(tube, tube.a, -axis.direction, ray, nearest);
  offer_cap(tube, tube.b, axis.direction, ray, nearest);
}

Vec3d normal(const eval::SphereEmitter& s, const Vec3d& point) { return normalised(point - s.centre); }
Vec3d normal(const eval::DiskEmitter& d, const Vec3d&) { return d.normal; }
Vec3d normal(const eval::PolygonEmitter& p, const Vec3d&) { return p.normal; }
Vec3d normal(const eval::TubeEmitter& tube, const Vec3d& point) {
  const Axis axis = axis_of(tube);
  const double place = dot(point - tube.a, axis.direction);
  const Vec3d across = point - tube.a - axis.direction * place;
  if (tube.caps == Caps::round) return normalised(point - tube.a - axis.direction * std::clamp(place, 0.0, axis.length));
  // On a flat cap a point lies well inside the radius and at one of the ends.
  const double margin = 1e-6 * tube.radius;
  const bool on_cap = tube.caps == Caps::flat && length(across) < tube.radius - margin && (place < margin || place > axis.length - margin);
  if (on_cap) return place < axis.length / 2 ? -axis.direction : axis.direction;
  return normalised(across);
}

Box around(const Vec3d& p, double radius) { return {p - Vec3d{radius, radius, radius}, p + Vec3d{radius, radius, radius}}; }
Box joined(const Box& a, const Box& b) {
  return {{std::min(a.min.x, b.min.x), std::min(a.min.y, b.min.y), std::min(a.min.z, b.min.z)},
          {std::max(a.max.x, b.max.x), std::max(a.max.y, b.max.y), std::max(a.max.z, b.max.z)}};
}
Box box(const eval::SphereEmitter& s) { return around(s.centre, s.radius); }
Box box(const eval::DiskEmitter& d) { return around(d.centre, d.radius); }
Box box(const eval::TubeEmitter& t) { return joined(around(t.a, t.radius), around(t.b, t.radius)); }
Box box(const eval::PolygonEmitter& p) {
  Box all = p.vertices.empty() ? Box{} : around(p.vertices.front(), 0);
  for (const Vec3d& v : p.vertices) all = joined(all, around(v, 0));
  return all;
}

}  // namespace

std::optional<double> intersect(const Shape& shape, const Ray& ray, double t_min, double t_max) {
  Nearest nearest(t_min, t_max);
  std::visit([&](const auto& s) { offer(s, ray, nearest); }, shape);
  return nearest.result();
}

Vec3d normal_at(const Shape& shape, const Vec3d& point) {
  return std::visit([&](const auto& s) { return normal(s, point); }, shape);
}

Box box_of(const Shape& shape) {
  return std::visit([](const auto& s) { return box(s); }, shape);
}

}  // namespace etendue::rendering
