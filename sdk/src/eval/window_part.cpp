// Which shape takes which way.
#include "window_part.h"

#include "line.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue::eval {
namespace {

// Weight: Taken or Kept.
template <class Weight>
struct Parts {
  const Emitter& emitter;
  const LocalFrame& frame;
  const Horizons& horizons;
  const Weight weight{emitter.window};
  const double unit = weight.unit_m;

  Vec3d place(const Vec3d& p) const { return frame.point(p) / unit; }
  static WindowPart part(double value) { return {value, Weight::is_left, false}; }
  static WindowPart nothing() { return {0, Weight::is_left, true}; }

  using Part = std::optional<WindowPart>;
  Part operator()(const DiskEmitter& e) const {
    const Vec3d centre = place(e.centre), normal = frame.vector(e.normal);
    return flat_part(clipped(disk_silhouette(centre, normal, e.radius / unit, emitter.two_sided), horizons), centre, normal, weight);
  }
  Part operator()(const PolygonEmitter& e) const {
    std::vector<Vec3d> vertices;
    vertices.reserve(e.vertices.size());
    for (const Vec3d& v : e.vertices) vertices.push_back(place(v));
    if (vertices.empty()) return part(0);
    const Vec3d normal = frame.vector(e.normal);
    return flat_part(clipped(polygon_silhouette(vertices, normal, emitter.two_sided), horizons), vertices[0], normal, weight);
  }
  Part operator()(const MeshEmitter& e) const {
    WindowPart sum = nothing();
    for (const auto& triangle : e.triangles) {
      const std::array<Vec3d, 3> t{place(triangle[0]), place(triangle[1]), place(triangle[2])};
      const Vec3d normal = normalised(cross(t[1] - t[0], t[2] - t[0]));
      const Contour seen = clipped(polygon_silhouette(t, normal, emitter.two_sided), horizons);
      if (seen.empty()) continue;
      const WindowPart loss = flat_part(seen, t[0], normal, weight);
      sum.nothing_left = sum.nothing_left && loss.nothing_left;
      sum.value += value_of(loss, seen);
    }
    return sum;
  }
  Part operator()(const LineEmitter& e) const {
    auto view = line_view(frame.point(e.a), frame.point(e.b));
    if (!view) return part(0);
    clip(*view, {0, 0, 1});
    if (horizons.distinct) clip(*view, horizons.surface);
    return line_part(*view, weight);
  }
  Part operator()(const SphereEmitter& e) const {
    const Vec3d centre = place(e.centre);
    const double radius = e.radius / unit, distance = length(centre);
    if (horizons.distinct || !(distance > radius)) return std::nullopt;
    if (distance - radius >= weight.end()) return nothing();
    return part(ball_part(centre, radius, weight, std::nullopt));
  }
  Part operator()(const TubeEmitter& e) const {
    const Vec3d a = place(e.a), b = place(e.b), span = b - a;
    const double radius = e.radius / unit, l = length(span);
    if (horizons.distinct || inside_tube(a, b, radius, e.caps)) return std::nullopt;
    const Vec3d nearest = a + span * (l > 0 ? std::clamp(-dot(a, span) / (l * l), 0.0, 1.0) : 0);
    if (length(nearest) - radius >= weight.end()) return nothing();
    if (!(l > 0)) return part(e.caps == Caps::round ? ball_part(a, radius, weight, std::nullopt) : 0);
    const Vec3d axis = span / l;
    double sum = tube_side_part(a, b, radius, weight);
    for (const auto& [centre, outwards] : {std::pair{a, -axis}, {b, axis}}) {
      if (e.caps == Caps::round) sum += ball_part(centre, radius, weight, outwards);
      if (e.caps == Caps::flat) sum += face(centre, outwards, radius);
    }
    return part(sum);
  }
  double face(const Vec3d& centre, const Vec3d& outwards, double radius) const {
    const Contour seen = clipped(disk_silhouette(centre, outwards, radius, false), horizons);
    if (seen.empty()) return 0;
    return value_of(flat_part(seen, centre, outwards, weight), seen);
  }
  static double value_of(const WindowPart& one, const Contour& seen) {
    return one.nothing_left && !one.of_left ? direction_integral(seen).z : one.value;
  }
  template <class Other>
  Part operator()(const Other&) const {
    return std::nullopt;
  }
};

}  // namespace

std::optional<WindowPart> window_part(const Emitter& emitter, const LocalFrame& frame, const Horizons& horizons) {
  if (Taken::suits(emitter.window)) return std::visit(Parts<Taken>{emitter, frame, horizons}, emitter.shape);
  return std::visit(Parts<Kept>{emitter, frame, horizons}, emitter.shape);
}

}  // namespace etendue::eval
