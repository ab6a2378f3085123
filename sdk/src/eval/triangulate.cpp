#include "triangulate.h"

namespace etendue::eval {
namespace {

double turn(const Vec2d& a, const Vec2d& b, const Vec2d& c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

}  // namespace

double signed_area(const std::vector<Vec2d>& polygon) {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) twice += turn(polygon[0], polygon[i], polygon[i + 1]);
  return 0.5 * twice;
}

// Ear clipping (Meisters 1975): a corner that turns inwards and holds no other vertex is cut off, until a triangle is left.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<Vec2d>& polygon) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  if (polygon.size() < 3) return triangles;
  const double sign = signed_area(polygon) < 0 ? -1 : 1;
  std::vector<std::uint32_t> left(polygon.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = static_cast<std::uint32_t>(i);
  std::size_t i = 0, failures = 0;
  while (left.size() > 3 && failures < left.size()) {
    const std::size_t n = left.size();
    const std::uint32_t ia = left[(i + n - 1) % n], ib = left[i % n], ic = left[(i + 1) % n];
    const Vec2d &a = polygon[ia], &b = polygon[ib], &c = polygon[ic];
    bool ear = sign * turn(a, b, c) > 0;
    for (std::size_t j = 0; ear && j < n; ++j) {
      const std::uint32_t ip = left[j];
      if (ip == ia || ip == ib || ip == ic) continue;
      const Vec2d& p = polygon[ip];
      ear = !(sign * turn(a, b, p) >= 0 && sign * turn(b, c, p) >= 0 && sign * turn(c, a, p) >= 0);
    }
    if (ear) {
      triangles.push_back({ia, ib, ic});
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(i % n));
      failures = 0;
    } else {
      ++failures;
      ++i;
    }
    i %= left.size();
  }
  if (left.size() == 3) triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

}  // namespace etendue::eval
