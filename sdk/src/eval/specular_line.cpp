#include "specular_line.h"

#include "gauss_rule.h"
#include "kernels.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace etendue::eval {

const LineEmitter* plain_line(const Emitter& emitter) {
  return is_window(emitter.window) ? nullptr : std::get_if<LineEmitter>(&emitter.shape);
}

std::optional<LineView> seen_line(const LineEmitter& line, const LocalFrame& frame, const Horizons& horizons) {
  std::optional<LineView> view = line_view(frame.point(line.a), frame.point(line.b));
  if (!view) return std::nullopt;
  clip(*view, {0, 0, 1});
  if (horizons.distinct) clip(*view, horizons.surface);
  return view->end > view->begin ? view : std::nullopt;
}

namespace {

// b(psi) = M (v + l), with M = diag(1 / alpha, 1 / alpha, 1): the lobe goes with |b|^-4.
class Bent {
 public:
  Bent(const LineView& line, const Vec3d& view, double alpha) : line_(line), view_(view), alpha_(alpha) {}
  Vec3d at(double psi) const { return linear(view_ + line_.at(psi)); }
  Vec3d speed(double psi) const { return linear(line_.axis * std::cos(psi) - line_.foot * std::sin(psi)); }

 private:
  Vec3d linear(const Vec3d& v) const { return {v.x / alpha_, v.y / alpha_, v.z}; }
  const LineView& line_;
  Vec3d view_;
  double alpha_;
};

struct Peak {
  double psi, width;
};
// Where |b| is least, kept to the line, and how wide it is about there: |b| over its speed. Steps of Gauss and Newton's from the best of a
// few places, as |b|^2 has two hollows at most.
Peak peak_of(const Bent& bent, double begin, double end) {
  constexpr int places = 8, steps = 4;
  double best = begin;
  const auto squared = [&](double psi) {
    const Vec3d b = bent.at(psi);
    return dot(b, b);
  };
  for (int i = 0; i <= places; ++i) {
    const double psi = begin + (end - begin) * i / places;
    if (squared(psi) < squared(best)) best = psi;
  }
  for (int i = 0; i < steps; ++i) {
    const Vec3d b = bent.at(best), speed = bent.speed(best);
    best = std::clamp(best - dot(b, speed) / std::max(dot(speed, speed), 1e-300), begin, end);
  }
  const Vec3d b = bent.at(best), speed = bent.speed(best);
  return {best, std::max(length(cross(b, speed)) / std::max(dot(speed, speed), 1e-300), 1e-9)};
}

}  // namespace

// With psi = psi_0 + w sinh u the lobe, |b|^-4 of a square that is close to (psi - psi_0)^2 + w^2, is a hill in u of the width of 1
// whatever alpha: cosh^-3 u. Gauss's rule of four over pieces of at most 1. Where the horizon cuts the line, masking falls within n.l of
// about alpha: there pieces shrink to a third each until they are as short.
Rgb line_by_moments(const LineEmitter& line, const ShadingPoint& point, const GgxLobe& lobe) {
  const LocalFrame frame(point);
  const Vec3d view = frame.vector(point.view);
  const std::optional<LineView> seen = seen_line(line, frame, horizons_of(frame, point.normal, point.surface_normal));
  if (!seen || !(view.z > 0)) return {};
  const Brdf brdf = lobe;
  const double alpha = std::clamp(lobe.alpha, min_alpha, 1.0);
  const Peak peak = peak_of(Bent(*seen, view, alpha), seen->begin, seen->end);
  const auto place = [&](double u) { return std::clamp(peak.psi + peak.width * std::sinh(u), seen->begin, seen->end); };
  const auto turned = [&](double psi) { return std::asinh((psi - peak.psi) / peak.width); };
  const double first = turned(seen->begin), last = turned(seen->end);
  const int pieces = std::max(1, static_cast<int>(std::ceil(last - first)));
  std::vector<double> breaks;
  for (int i = 0; i <= pieces; ++i) breaks.push_back(first + (last - first) * i / pieces);
  const auto graded = [&](double end, double next) {
    if (seen->at(end).z > alpha) return;
    for (double off = (next - end) / 3; std::abs(off) > 0.3 * alpha; off /= 3) breaks.push_back(turned(end + off));
  };
  graded(seen->begin, place(breaks[1]));
  graded(seen->end, place(breaks[static_cast<std::size_t>(pieces) - 1]));
  std::sort(breaks.begin(), breaks.end());
  const Gauss<4>& rule = gauss<4>();
  Rgb sum;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const double step = breaks[i + 1] - breaks[i];
    for (std::size_t k = 0; k < 4; ++k) {
      const double u = breaks[i] + rule.x[k] * step, psi = place(u);
      sum += brdf_cos(brdf, view, seen->at(psi)) * (std::cos(psi) * std::cosh(u) * rule.weight[k] * step);
    }
  }
  return sum * (peak.width * seen->scale);
}

// With p = h (foot + tan(psi) axis) on the line, x along it and P = M^-1 p, whose D has |det| P.z d^3 / (pi |P|^4), d = |p|, and
// cos psi dpsi = h^2 dx / d^3:
//   integral of cos psi D P / P.z dpsi = h^2 |det| / pi  integral of P / |P|^4 dx.
// On the straight line of P, with l = k x along it, k = |M^-1 axis|, from its foot F at the distance c,
//   integral of (F + l t) / (c^2 + l^2)^2 dl = F / 2 (l / (c^2 (c^2 + l^2)) + atan(l / c) / c^3) - t / 2 / (c^2 + l^2).
Vec3d cosine_along(const LineView& view, const Transform& linear) {
  const auto end = [&](double psi) { return linear.vector((view.foot + view.axis * std::tan(psi)) * view.height); };
  Vec3d a = end(view.begin), b = end(view.end);
  if (!(a.z > 0 || b.z > 0)) return {};
  if (a.z < 0) a = a + (b - a) * (a.z / (a.z - b.z));
  if (b.z < 0) b = b + (a - b) * (b.z / (b.z - a.z));
  const Vec3d speed = linear.vector(view.axis);
  const double k = length(speed);
  const Vec3d t = speed / k;
  const double from = dot(a, t), to = dot(b, t);
  const Vec3d foot = a - t * from;
  const double c2 = dot(foot, foot), c = std::sqrt(c2), r0 = c2 + from * from, r1 = c2 + to * to;
  if (!(c > 0)) return {};
  // Differences by one term each: of l / (c^2 + l^2), of the angles, of 1 / (c^2 + l^2).
  const double ratio = (to - from) * (c2 - from * to) / (r0 * r1), angle = std::atan2(c * (to - from), c2 + from * to);
  const Vec3d integral = foot * (0.5 * (ratio + angle / c) / c2) + t * (0.5 * (to - from) * (to + from) / (r0 * r1));
  return integral * (view.scale * view.height * view.height * std::abs(linear.determinant()) / (pi * k));
}

}  // namespace etendue::eval
