// Line lights seen from a point. A line of length l sends I sin(theta) in all, each of its elements I sin(theta) / l.
#pragma once

#include "etendue/eval.h"

#include <optional>

namespace etendue::eval {

// Seen from the point, the element dx at distance d gives I sin(theta) dx / (l d^2) on a plane facing it. With h the distance to the
// line's foot and psi the angle from the foot: d = h / cos psi, dx = h dpsi / cos^2 psi, sin(theta) = cos psi, so that
//   dE = I / (l h) cos psi dpsi  from the direction  cos psi foot + sin psi axis.
struct LineView {
  Vec3d foot, axis;   // unit, perpendicular
  double height;      // of the point over the line
  double begin, end;  // psi of both ends
  double scale;       // 1 / (l h)
  Vec3d at(double psi) const { return foot * std::cos(psi) + axis * std::sin(psi); }
};
// a and b relative to the point. Nothing if the point is on the line (an element sends nothing along the line), or it has no length.
std::optional<LineView> line_view(const Vec3d& a, const Vec3d& b);

// The part with n.direction >= 0: an interval, because the arc is shorter than half a turn.
void clip(LineView& view, const Vec3d& n);

// Integral of cos psi (direction) dpsi: foot (psi / 2 + sin 2 psi / 4) + axis sin^2 psi / 2 between the ends, times the scale.
Vec3d direction_integral(const LineView& view);

}  // namespace etendue::eval
