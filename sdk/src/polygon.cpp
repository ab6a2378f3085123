#include "polygon.h"

#include <algorithm>

namespace etendue {
namespace {

// Twice the signed area of a, b, c: positive if counter-clockwise.
double orientation(const Vec2d& a, const Vec2d& b, const Vec2d& c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }
int sign(double x) { return (x > 0) - (x < 0); }

// c, known to be on the line through a and b, lies between them.
bool between(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return std::min(a.x, b.x) <= c.x && c.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= c.y && c.y <= std::max(a.y, b.y);
}

bool segments_meet(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d) {
  const int abc = sign(orientation(a, b, c)), abd = sign(orientation(a, b, d));
  const int cda = sign(orientation(c, d, a)), cdb = sign(orientation(c, d, b));
  if (abc * abd < 0 && cda * cdb < 0) return true;
  return (abc == 0 && between(a, b, c)) || (abd == 0 && between(a, b, d)) || (cda == 0 && between(c, d, a)) ||
         (cdb == 0 && between(c, d, b));
}

}  // namespace

bool is_simple(const std::vector<Vec2d>& points) {
  const std::size_t n = points.size();
  if (n < 3) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2d &a = points[i], &b = points[(i + 1) % n], &next = points[(i + 2) % n];
    // Neighbours: no edge without length, none that turns back onto the one before.
    const bool collinear = orientation(a, b, next) == 0;
    if (a == b || (collinear && (a.x - b.x) * (next.x - b.x) + (a.y - b.y) * (next.y - b.y) > 0)) return false;
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;  // neighbours around the end
      if (segments_meet(a, b, points[j], points[(j + 1) % n])) return false;
    }
  }
  return true;
}

}  // namespace etendue
