// Flat lights and lines; which shape takes which way. Round ones: round_window_loss.cpp.
#include "window_loss.h"

#include "line.h"
#include "quadrature.h"
#include "sector_rule.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue::eval {
namespace {

// A flat light in the plane at the height h from the point, all in units of the range. The range cuts a circle of the radius
// rho = sqrt(1 - h^2) out of the plane, about the foot of the point. Whatever of the outline lies beyond it is replaced by the arc of that
// circle that is seen from the foot through the same angle: what is enclosed then is the part within the range, signed, so that neither
// has to be convex. What is beyond has the outline's other parts, and those arcs backwards.
//
// With Lambert's formula over the latter, and over the former
//     integral of n.y h (1 - w) / |y|^4 dA,
// a polynomial of the degree 5 in the plane: from a point z of it, y = z + t (s - z) with s on the outline, dA = t (s - z) x ds dt. Gauss's
// three nodes for the weight t are exact, and Gauss and Legendre's three along a side.
class FlatLoss {
 public:
  // `towards`: unit, from the point to the plane.
  FlatLoss(const Vec3d& towards, double height, const Taken& taken)
      : towards_(towards),
        foot_(towards * height),
        height_(height),
        rho_(std::sqrt(std::max((1 - height) * (1 + height), 0.0))),
        taken_(taken) {}

  void add(const Contour& seen) {
    if (seen.empty()) return;
    const Vec3d start = on_plane(seen[0].at(seen[0].begin));
    base_ = dot(start, start) < 1 ? start : foot_;
    for (const Arc& arc : seen) {
      if (arc.great_circle()) {
        add_side(on_plane(arc.at(arc.begin)), on_plane(arc.at(arc.end)));
      } else {
        add_rim(arc);
      }
    }
  }
  WindowLoss result() const {
    if (!within_ && std::abs(turned_) < pi) return {0, true};
    return {beyond_ + height_ * moment_, false};
  }

 private:
  Vec3d on_plane(const Vec3d& direction) const { return direction * (height_ / std::max(dot(direction, towards_), 1e-30)); }
  double turn(const Vec3d& p, const Vec3d& q) const { return dot(towards_, cross(p, q)); }

  double fan_row(const Vec3d& s) const {
    double sum = 0;
    for (const SectorNode& node : nodes_across(3)) {
      const Vec3d y = base_ + (s - base_) * node.x;
      sum += node.weight * y.z * taken_.per_fourth(dot(y, y));
    }
    return sum;
  }

  void add_side(const Vec3d& p, const Vec3d& q) {
    // |p + t (q - p)| = 1
    const Vec3d along = q - p;
    const double a = dot(along, along), b = dot(p, along), c = dot(p, p) - 1, root2 = b * b - a * c;
    std::array<double, 4> ends{0, 1, 1, 1};
    std::size_t count = 1;
    if (root2 > 0) {
      const double k = b > 0 ? -b - std::sqrt(root2) : -b + std::sqrt(root2);
      std::array<double, 2> roots{k / a, c / k};
      if (roots[0] > roots[1]) std::swap(roots[0], roots[1]);
      for (const double t : roots)
        if (t > 0 && t < 1) ends[count++] = t;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3d from = p + along * ends[i], to = i + 1 < count ? p + along * ends[i + 1] : q, middle = (from + to) * 0.5;
      if (dot(middle, middle) < 1) {
        within_ = true;
        double sum = 0;
        for (const SectorNode& node : nodes_along(3)) sum += 0.5 * node.weight * fan_row(middle + (to - from) * (0.5 * node.x));
        moment_ += turn(from - base_, to - from) * sum;
      } else {
        if (const auto arc = great_circle(from, to)) beyond_ += direction_integral(*arc).z;
        const Vec3d e0 = from - foot_, e1 = to - foot_;
        add_range(e0, std::atan2(turn(e0, e1), dot(e0, e1)));
      }
    }
  }

  // |C + u cos s + v sin s|^2 = m + rho cos(s - phase)
  void add_rim(const Arc& arc) {
    const double in_u = dot(arc.centre, arc.u), in_v = dot(arc.centre, arc.v), rho = 2 * std::hypot(in_u, in_v);
    const double m = dot(arc.centre, arc.centre) + dot(arc.u, arc.u), phase = std::atan2(in_v, in_u);
    std::array<double, 4> ends{arc.begin, arc.end, arc.end, arc.end};
    std::size_t count = 1;
    if (std::abs(1 - m) < rho) {
      const double half = std::acos((1 - m) / rho);
      std::array<double, 2> roots{};
      for (std::size_t i = 0; i < 2; ++i) {
        const double root = phase + (i == 0 ? -half : half);
        roots[i] = root + 2 * pi * std::ceil((arc.begin - root) / (2 * pi));
      }
      if (roots[0] > roots[1]) std::swap(roots[0], roots[1]);
      for (const double s : roots)
        if (s > arc.begin && s < arc.end) ends[count++] = s;
    }
    for (std::size_t i = 0; i < count; ++i) {
      Arc part = arc;
      part.begin = ends[i];
      part.end = i + 1 < count ? ends[i + 1] : arc.end;
      const Vec3d middle = part.at(0.5 * (part.begin + part.end));
      if (dot(middle, middle) < 1) {
        within_ = true;
        add_moment(part);
      } else {
        beyond_ += direction_integral(part).z;
        add_range(part.at(part.begin) - foot_, seen_from_foot(part));
      }
    }
  }

  // The angle that a part of a circle about c is seen under. As complex numbers in the plane: c + R e = e (R + c / e), of which the second
  // factor, where c < R, has a positive real part and no jump in its argument; else c (1 + R e / c).
  double seen_from_foot(const Arc& part) const {
    const Vec3d c = part.centre - foot_;
    const bool around = dot(c, c) < dot(part.u, part.u);
    const auto argument = [&](double s) {
      const Vec3d e = part.u * std::cos(s) + part.v * std::sin(s);
      return around ? s + std::atan2(turn(e, c), dot(e, e) + dot(e, c)) : std::atan2(turn(c, e), dot(c, c) + dot(c, e));
    };
    return argument(part.end) - argument(part.begin);
  }

  // A polynomial of the degree 7 in the sine and cosine.
  void add_moment(const Arc& arc) {
    const int pieces = std::max(1, static_cast<int>(std::ceil(std::abs(arc.end - arc.begin) / (pi / 2) - 1e-9)));
    const double half = 0.5 * (arc.end - arc.begin) / pieces;
    const KronrodRule& rule = kronrod15();
    for (int i = 0; i < pieces; ++i) {
      for (const KronrodNode& node : rule.nodes) {
        const double s = arc.begin + half * (2 * i + 1 + node.x), cs = std::cos(s), sn = std::sin(s);
        const Vec3d y = arc.centre + arc.u * cs + arc.v * sn;
        moment_ += half * node.weight * turn(y - base_, arc.v * cs - arc.u * sn) * fan_row(y);
      }
    }
  }

  // An arc of the circle that the range cuts out of the plane. Half the integral of b x db, b = foot + rho e:
  //     (foot x rho (e1 - e0) + rho^2 towards turned) / 2.
  void add_range(const Vec3d& from, double turned) {
    const double size = length(from);
    if (!(size > 0) || turned == 0) return;
    turned_ += turned;
    const Vec3d u = from * (rho_ / size), v = cross(towards_, u);
    const Arc arc{foot_, u, v, 0, turned, false};
    const Vec3d moved = arc.at(turned) - arc.at(0);
    beyond_ -= 0.5 * (cross(foot_, moved).z + rho_ * rho_ * turned * towards_.z);
    add_moment(arc);
  }

  Vec3d towards_, foot_;
  double height_, rho_;
  Taken taken_;
  Vec3d base_;
  double beyond_ = 0, moment_ = 0, turned_ = 0;
  bool within_ = false;
};

WindowLoss flat_loss(const Contour& seen, const Vec3d& on_light, const Vec3d& normal, const Taken& taken) {
  const double height = std::abs(dot(on_light, normal));
  if (!(height < 1)) return {0, true};
  FlatLoss loss(dot(on_light, normal) < 0 ? -normal : normal, height, taken);
  loss.add(seen);
  return loss.result();
}

// An element dx of a line gives I / l h n.y / |y|^4 dx: beyond the range its own integral, within it polynomials of the degree 5.
WindowLoss line_loss(const LineView& view, double range, const Taken& taken) {
  const double height = view.height / range, l = 1 / (view.scale * view.height * range);
  if (!(height < 1)) return {0, true};
  const double reach = std::acos(height), begin = std::max(view.begin, -reach), end = std::min(view.end, reach);
  if (!(begin < end)) return {0, true};
  double loss = 0;
  for (const auto& [from, to] : {std::pair{view.begin, begin}, {end, view.end}}) {
    LineView part = view;
    part.begin = from;
    part.end = to;
    if (from < to) loss += direction_integral(part).z;
  }
  const double x0 = height * std::tan(begin), x1 = height * std::tan(end);
  for (const SectorNode& node : nodes_along(3)) {
    const double x = 0.5 * (x0 + x1) + 0.5 * (x1 - x0) * node.x;
    loss += 0.5 * (x1 - x0) * node.weight * height * (view.foot.z * height + view.axis.z * x) * taken.per_fourth(height * height + x * x) /
            (l * range * range);
  }
  return {loss, false};
}

struct Losses {
  const Emitter& emitter;
  const LocalFrame& frame;
  const Horizons& horizons;
  double range = emitter.window.range_m;
  Taken taken{emitter.window.falloff};

  Vec3d place(const Vec3d& p) const { return frame.point(p) / range; }

  using Loss = std::optional<WindowLoss>;
  Loss operator()(const DiskEmitter& e) const {
    const Vec3d centre = place(e.centre), normal = frame.vector(e.normal);
    return flat_loss(clipped(disk_silhouette(centre, normal, e.radius / range, emitter.two_sided), horizons), centre, normal, taken);
  }
  Loss operator()(const PolygonEmitter& e) const {
    std::vector<Vec3d> vertices;
    vertices.reserve(e.vertices.size());
    for (const Vec3d& v : e.vertices) vertices.push_back(place(v));
    if (vertices.empty()) return WindowLoss{};
    const Vec3d normal = frame.vector(e.normal);
    return flat_loss(clipped(polygon_silhouette(vertices, normal, emitter.two_sided), horizons), vertices[0], normal, taken);
  }
  Loss operator()(const MeshEmitter& e) const {
    WindowLoss sum{0, true};
    for (const auto& triangle : e.triangles) {
      const std::array<Vec3d, 3> t{place(triangle[0]), place(triangle[1]), place(triangle[2])};
      const Vec3d normal = normalised(cross(t[1] - t[0], t[2] - t[0]));
      const Contour seen = clipped(polygon_silhouette(t, normal, emitter.two_sided), horizons);
      if (seen.empty()) continue;
      const WindowLoss loss = flat_loss(seen, t[0], normal, taken);
      sum.all = sum.all && loss.all;
      sum.value += loss.all ? direction_integral(seen).z : loss.value;
    }
    return sum;
  }
  Loss operator()(const LineEmitter& e) const {
    auto view = line_view(frame.point(e.a), frame.point(e.b));
    if (!view) return WindowLoss{};
    clip(*view, {0, 0, 1});
    if (horizons.distinct) clip(*view, horizons.surface);
    return line_loss(*view, range, taken);
  }
  Loss operator()(const SphereEmitter& e) const {
    const Vec3d centre = place(e.centre);
    const double radius = e.radius / range, distance = length(centre);
    if (horizons.distinct || !(distance > radius)) return std::nullopt;
    if (distance - radius >= 1) return WindowLoss{0, true};
    return WindowLoss{ball_loss(centre, radius, taken, std::nullopt), false};
  }
  Loss operator()(const TubeEmitter& e) const {
    const Vec3d a = place(e.a), b = place(e.b), span = b - a;
    const double radius = e.radius / range, l = length(span);
    if (horizons.distinct || inside_tube(a, b, radius, e.caps)) return std::nullopt;
    const Vec3d nearest = a + span * (l > 0 ? std::clamp(-dot(a, span) / (l * l), 0.0, 1.0) : 0);
    if (length(nearest) - radius >= 1) return WindowLoss{0, true};
    if (!(l > 0)) return WindowLoss{e.caps == Caps::round ? ball_loss(a, radius, taken, std::nullopt) : 0, false};
    const Vec3d axis = span / l;
    WindowLoss loss{tube_side_loss(a, b, radius, taken), false};
    for (const auto& [centre, outwards] : {std::pair{a, -axis}, {b, axis}}) {
      if (e.caps == Caps::round) loss.value += ball_loss(centre, radius, taken, outwards);
      if (e.caps == Caps::flat) loss.value += face(centre, outwards, radius);
    }
    return loss;
  }
  double face(const Vec3d& centre, const Vec3d& outwards, double radius) const {
    const Contour seen = clipped(disk_silhouette(centre, outwards, radius, false), horizons);
    if (seen.empty()) return 0;
    const WindowLoss loss = flat_loss(seen, centre, outwards, taken);
    return loss.all ? direction_integral(seen).z : loss.value;
  }
  template <class Other>
  Loss operator()(const Other&) const {
    return std::nullopt;
  }
};

}  // namespace

std::optional<WindowLoss> window_loss(const Emitter& emitter, const LocalFrame& frame, const Horizons& horizons) {
  return std::visit(Losses{emitter, frame, horizons}, emitter.shape);
}

}  // namespace etendue::eval
