#include "cones.h"

#include "microfacet.h"

#include <vector>

namespace etendue::eval {
namespace {

// Where 2 log(1 + t) - t / alpha^2 falls to -1, t the squared tangent: from where it falls (1 + t > 2 alpha^2) Newton's steps from the
// right side approach it from there, as the curve is concave.
double beckmann_tangent2(double alpha) {
  const double a2 = alpha * alpha;
  double t = std::max(a2 * (1 + 2 * std::log1p(4 * a2 + 2)), 4 * a2);
  for (int i = 0; i < 60; ++i) {
    const double step = (2 * std::log1p(t) - t / a2 + 1) / (1 / a2 - 2 / (1 + t));
    t += step;
    if (std::abs(step) < 1e-15 * t) break;
  }
  return t;
}

// Where rays meet the light's plane, in its coordinates from the centre, as (s w, t w, w): those that lead away have a negative w, and no
// place is at infinity.
using Places = std::vector<Vec3d>;
Vec3d place_of(const RectView& rect, const Vec3d& ray) {
  const double falling = -dot(ray, rect.normal);
  return {dot(ray, rect.x) * rect.height() - dot(rect.centre, rect.x) * falling,
          dot(ray, rect.y) * rect.height() - dot(rect.centre, rect.y) * falling, falling};
}
// Liang and Barsky 1984: along an edge the room to a side of the window is linear, q_0 - p u, and the edge crosses the side at u = q_0 / p.
template <class Room>
Places inside(const Places& polygon, const Room& room) {
  Places kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const double q0 = room(from), q1 = room(to);
    if (q0 >= 0) kept.push_back(from);
    if ((q0 > 0 && q1 < 0) || (q0 < 0 && q1 > 0)) kept.push_back(from + (to - from) * (q0 / (q0 - q1)));
  }
  return kept;
}
}  // namespace

double printed_cone(double alpha) { return alpha_of_blinn_phong(blinn_phong_exponent(alpha)); }

// Light at the angle 2 theta from the mirror direction has its half vector at theta.
double fitted_cone(Distribution distribution, double alpha) {
  const double a = std::clamp(alpha, min_alpha, 1.0);
  switch (distribution) {
    case Distribution::ggx: {  // 1 / (1 + (1 / alpha^2 - 1) sin^2)^2
      const double sine2 = (std::exp(0.5) - 1) * a * a / ((1 - a) * (1 + a));
      return 2 * std::asin(std::sqrt(std::min(sine2, 1.0)));
    }
    case Distribution::beckmann:
      return 2 * std::atan(std::sqrt(beckmann_tangent2(a)));
    case Distribution::blinn_phong:  // cos^n = 1 / e: sin^2 = 1 - exp(-2 / n)
      return 2 * std::asin(std::sqrt(-std::expm1(-2 / blinn_phong_exponent(a))));
    default:
      return std::asin(std::sqrt(-std::expm1(-2 / phong_exponent(a))));
  }
}

DiskOverlap disk_overlap(double first, double second, double apart) {
  const double inner = std::abs(first - second), outer = first + second;
  if (!(apart < outer)) return {};
  const double from = std::max(-first, apart - second), to = std::min(first, apart + second);
  const double x = apart <= inner ? 1 : (outer - apart) / (outer - inner);
  return {x * x * (3 - 2 * x), 0.5 * (from + to)};
}

// Gauss' area of a polygon, and its middle.
std::optional<LightPart> pyramid_on(const RectView& rect, const std::array<Vec3d, 4>& rays) {
  Places polygon;
  for (const Vec3d& ray : rays) polygon.push_back(place_of(rect, ray));
  polygon = inside(polygon, [&](const Vec3d& p) { return rect.half_x * p.z - p.x; });
  polygon = inside(polygon, [&](const Vec3d& p) { return rect.half_x * p.z + p.x; });
  polygon = inside(polygon, [&](const Vec3d& p) { return rect.half_y * p.z - p.y; });
  polygon = inside(polygon, [&](const Vec3d& p) { return rect.half_y * p.z + p.y; });
  double twice = 0, s = 0, t = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const Vec3d p = from / from.z, q = to / to.z;
    const double turn = p.x * q.y - q.x * p.y;
    twice += turn, s += turn * (p.x + q.x), t += turn * (p.y + q.y);
  }
  if (!(std::abs(twice) > 0)) return std::nullopt;
  return LightPart{0.5 * std::abs(twice), rect.at(s / (3 * twice), t / (3 * twice))};
}

}  // namespace etendue::eval
