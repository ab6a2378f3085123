#include "lobe_slopes.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {

HalfSlopes half_slopes(const Vec3d& view, double alpha, const Arc& arc, double s) {
  const double cs = std::cos(s), sn = std::sin(s);
  Vec3d l = arc.centre + arc.u * cs + arc.v * sn, speed = arc.v * cs - arc.u * sn;
  if (!arc.unit) {
    const double inverse = 1 / length(l);
    l = l * inverse;
    speed = (speed - l * dot(l, speed)) * inverse;
  }
  const Vec3d h = view + l;
  const double over = 1 / (alpha * h.z);
  const Vec2d q{h.x * over, h.y * over};
  return {q, {(speed.x - alpha * q.x * speed.z) * over, (speed.y - alpha * q.y * speed.z) * over}};
}

// The best of a few places (at grazing views the lobe is a ridge along the plane of incidence), then steps of Gauss and Newton, which take
// an outline that is straight in q there in one.
double nearest_to_lobe(const Vec3d& view, double alpha, const Arc& arc) {
  constexpr int most_steps = 8;
  constexpr double near_enough = 1e-4;  // squared, of the way over which the lobe falls
  double best = 0.5 * (arc.begin + arc.end);
  HalfSlopes at = half_slopes(view, alpha, arc, best);
  const auto try_at = [&](double s) {
    const HalfSlopes other = half_slopes(view, alpha, arc, s);
    if (squared(other.q) < squared(at.q)) best = s, at = other;
  };
  try_at(arc.begin), try_at(arc.end);
  const Crossings in_plane = crossings(arc, normalised(Vec3d{-view.y, view.x, 1e-30}));
  for (std::size_t i = 0; i < in_plane.count; ++i) try_at(in_plane.s[i]);
  if (arc.unit) try_at(nearest_to(arc, {-view.x, -view.y, view.z}).s);
  for (int step = 0; step < most_steps; ++step) {
    const double speed2 = squared(at.speed), before = squared(at.q);
    if (!(speed2 > 0)) break;
    const double to = std::clamp(best - (at.q.x * at.speed.x + at.q.y * at.speed.y) / speed2, arc.begin, arc.end);
    if ((to - best) * (to - best) * speed2 < near_enough * (1 + before)) break;
    try_at(to);
    if (!(squared(at.q) < before)) break;
  }
  return best;
}

}  // namespace etendue::eval
