// Random lights for measurements of the evaluation: sizes log-uniform, a shading point around each at a few sizes of distance.
#pragma once

#include "etendue/eval.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string_view>

namespace etendue::eval::protocol {

enum class Kind { rect, sphere, disk, capsule, flat_tube, open_tube, star, line, point };  // star: a polygon, most of them concave

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double lo, double hi) { return lo + (hi - lo) * unit_(engine_); }
  double log_uniform(double lo, double hi) { return lo * std::pow(hi / lo, uniform(0, 1)); }
  Vec3d direction() {
    const double z = uniform(-1, 1), r = std::sqrt(std::max(1 - z * z, 0.0)), phi = uniform(0, 2 * pi);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }
  Vec2d square() { return {uniform(0, 1), uniform(0, 1)}; }

 private:
  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> unit_{0, 1};
};

inline PolygonEmitter rectangle(const Vec3d& centre, const Vec3d& x, const Vec3d& y, double width, double height) {
  const Vec3d hx = x * (0.5 * width), hy = y * (0.5 * height);
  PolygonEmitter p;
  p.vertices = {centre - hx - hy, centre + hx - hy, centre + hx + hy, centre - hx + hy};
  p.normal = cross(x, y);
  p.uv_frame = {centre - hx - hy, hx * 2, hy * 2};
  p.triangles = {{0, 1, 2}, {0, 2, 3}};
  return p;
}

// A corner at each end of an ellipse's diameters, one nearer to the middle between any two: spikes about a convex middle.
inline PolygonEmitter star(const Vec3d& centre, const Vec3d& x, const Vec3d& y, double width, double height, std::uint32_t spikes,
                           double nearer) {
  PolygonEmitter p = rectangle(centre, x, y, width, height);
  p.vertices.clear(), p.triangles.clear();
  const std::uint32_t corners = 2 * spikes;
  for (std::uint32_t i = 0; i < corners; ++i) {
    const double phi = 2 * pi * i / corners, r = 0.5 * (i % 2 == 0 ? 1 : nearer);
    p.vertices.push_back(centre + x * (width * r * std::cos(phi)) + y * (height * r * std::sin(phi)));
    if (i % 2 == 0) p.triangles.push_back({(i + corners - 1) % corners, i, i + 1});
    if (i % 2 == 1 && i > 1 && i + 2 < corners) p.triangles.push_back({1, i, i + 2});
  }
  return p;
}

// The lowest value of n.p over the light, p relative to the point: positive if it is wholly above the horizon.
inline double lowest(const EmitterShape& shape, const Vec3d& position, const Vec3d& n) {
  if (const auto* s = std::get_if<SphereEmitter>(&shape)) return dot(n, s->centre - position) - s->radius;
  if (const auto* d = std::get_if<DiskEmitter>(&shape)) {
    const double across = dot(n, d->normal);
    return dot(n, d->centre - position) - d->radius * std::sqrt(std::max(1 - across * across, 0.0));
  }
  if (const auto* t = std::get_if<TubeEmitter>(&shape)) return std::min(dot(n, t->a - position), dot(n, t->b - position)) - t->radius;
  if (const auto* p = std::get_if<PunctualEmitter>(&shape)) return dot(n, p->position - position);
  if (const auto* l = std::get_if<LineEmitter>(&shape)) return std::min(dot(n, l->a - position), dot(n, l->b - position));
  double low = 1e300;
  for (const Vec3d& v : std::get<PolygonEmitter>(shape).vertices) low = std::min(low, dot(n, v - position));
  return low;
}

// Of a point light: as far as the centre of a sphere may be.
inline double point_distance(Random& random) {
  const double radius = random.log_uniform(0.1, 2);
  return radius * random.uniform(1.05, 6);
}

inline EmitterShape random_shape(Kind kind, const Vec3d& position, const Vec3d& towards, Random& random) {
  if (kind == Kind::sphere) {
    const double radius = random.log_uniform(0.1, 2);
    return SphereEmitter{position + towards * (radius * random.uniform(1.05, 6)), radius};
  }
  if (kind == Kind::point) return PunctualEmitter{position + towards * point_distance(random), {}, {1, 1, 1}, PointShape{}};
  if (kind == Kind::rect || kind == Kind::star) {
    const double w = random.log_uniform(0.25, 4), h = random.log_uniform(0.25, 4), size = std::max(w, h);
    const double distance = size * random.uniform(0.5, 3);
    Vec3d n = random.direction();
    while (-dot(n, towards) < 0.02 || -dot(n, towards) * distance < 0.02 * size) n = random.direction();
    const Basis b = basis_around(n);
    const double roll = random.uniform(0, 2 * pi);
    const Vec3d x = b.tangent * std::cos(roll) + b.bitangent * std::sin(roll);
    const Vec3d centre = position + towards * distance, y = cross(n, x);
    if (kind == Kind::rect) return rectangle(centre, x, y, w, h);
    return star(centre, x, y, w, h, 3 + static_cast<std::uint32_t>(random.uniform(0, 4)), random.uniform(0.3, 1));
  }
  if (kind == Kind::disk) {
    const double radius = random.log_uniform(0.1, 2), distance = radius * random.uniform(0.5, 6);
    Vec3d n = random.direction();
    while (-dot(n, towards) < 0.02 || -dot(n, towards) * distance < 0.04 * radius) n = random.direction();
    return DiskEmitter{position + towards * distance, n, basis_around(n).tangent, radius};
  }
  const double l = random.log_uniform(0.25, 4), radius = l * random.log_uniform(0.01, 0.25);
  const Vec3d centre = position + towards * (random.uniform(0.5, 3) * (l + 2 * radius));
  const Caps caps = kind == Kind::capsule ? Caps::round : kind == Kind::flat_tube ? Caps::flat : Caps::none;
  for (;;) {
    const Vec3d half = random.direction() * (0.5 * l);
    const Vec3d a = centre - half - position, span = half * 2;
    const double t = std::clamp(-dot(a, span) / (l * l), 0.0, 1.0);
    if (!(length(a + span * t) >= 1.05 * radius)) continue;
    if (kind == Kind::line) return LineEmitter{centre - half, centre + half, {1, 1, 1}};
    return TubeEmitter{centre - half, centre + half, radius, caps};
  }
}

// A point around a light as random_shape puts a light around a point. Nothing where that would not take it.
inline std::optional<Vec3d> point_around(const EmitterShape& shape, Random& random) {
  const Vec3d towards = random.direction();
  if (const auto* s = std::get_if<SphereEmitter>(&shape)) return s->centre - towards * (s->radius * random.uniform(1.05, 6));
  if (const auto* d = std::get_if<DiskEmitter>(&shape)) {
    const double distance = d->radius * random.uniform(0.5, 6), cosine = -dot(d->normal, towards);
    if (cosine < 0.02 || cosine * distance < 0.04 * d->radius) return std::nullopt;
    return d->centre - towards * distance;
  }
  const auto around_axis = [&](const Vec3d& a, const Vec3d& b, double radius) -> std::optional<Vec3d> {
    const Vec3d span = b - a, p = (a + b) * 0.5 - towards * (random.uniform(0.5, 3) * (length(span) + 2 * radius));
    const double share = std::clamp(dot(p - a, span) / dot(span, span), 0.0, 1.0);
    if (length(p - a - span * share) < 1.05 * radius) return std::nullopt;
    return p;
  };
  if (const auto* t = std::get_if<TubeEmitter>(&shape)) return around_axis(t->a, t->b, t->radius);
  if (const auto* l = std::get_if<LineEmitter>(&shape)) return around_axis(l->a, l->b, 0.01 * length(l->b - l->a));
  if (const auto* p = std::get_if<PunctualEmitter>(&shape)) return p->position - towards * point_distance(random);
  const auto& polygon = std::get<PolygonEmitter>(shape);
  const auto& v = polygon.vertices;
  const double size = std::max(length(v[1] - v[0]), length(v[3] - v[0])), distance = size * random.uniform(0.5, 3);
  const double cosine = -dot(polygon.normal, towards);
  if (cosine < 0.02 || cosine * distance < 0.02 * size) return std::nullopt;
  return (v[0] + v[2]) * 0.5 - towards * distance;
}

// As the command names shapes: rect, sphere, disk, tube (a capsule), line, point.
inline Kind kind_named(std::string_view shape) {
  if (shape == "sphere") return Kind::sphere;
  if (shape == "disk") return Kind::disk;
  if (shape == "line") return Kind::line;
  if (shape == "point") return Kind::point;
  return shape == "tube" ? Kind::capsule : Kind::rect;
}

}  // namespace etendue::eval::protocol
