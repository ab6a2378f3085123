#include "line.h"

#include "etendue/units.h"

#include <cmath>

namespace etendue::eval {

std::optional<LineView> line_view(const Vec3d& a, const Vec3d& b) {
  const Vec3d span = b - a;
  const double l = length(span);
  if (!(l > 0)) return std::nullopt;
  const Vec3d axis = span / l;
  const Vec3d foot = a - axis * dot(axis, a);
  const double height = length(foot);
  if (!(height > 1e-14 * (std::abs(dot(a, axis)) + l))) return std::nullopt;
  return LineView{foot / height, axis, height, std::atan2(dot(a, axis), height), std::atan2(dot(b, axis), height), 1 / (l * height)};
}

// n.direction = A cos psi + B sin psi = r cos(psi - phase) is positive within a quarter turn of its phase.
void clip(LineView& view, const Vec3d& n) {
  const double phase = std::atan2(dot(n, view.axis), dot(n, view.foot));
  // Both ends lie within (-pi/2, pi/2) and the phase within (-pi, pi]: two turns of the window can reach them.
  double begin = view.end, end = view.begin;
  for (const double turn : {-2 * pi, 0.0, 2 * pi}) {
    const double lo = std::max(view.begin, phase + turn - pi / 2), hi = std::min(view.end, phase + turn + pi / 2);
    if (hi > lo && hi - lo > end - begin) begin = lo, end = hi;
  }
  view.begin = begin;
  view.end = std::max(begin, end);
}

Vec3d direction_integral(const LineView& view) {
  const double s0 = std::sin(view.begin), s1 = std::sin(view.end);
  const double along_foot = 0.5 * (view.end - view.begin) + 0.25 * (std::sin(2 * view.end) - std::sin(2 * view.begin));
  return (view.foot * along_foot + view.axis * (0.5 * (s1 - s0) * (s1 + s0))) * view.scale;
}

}  // namespace etendue::eval
