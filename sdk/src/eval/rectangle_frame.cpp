#include "rectangle_frame.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {

bool fills_its_frame(const PolygonEmitter& polygon) {
  if (polygon.vertices.size() != 4) return false;
  const auto& [origin, u, v] = polygon.uv_frame;
  const double limit = 1e-9 * std::max(dot(u, u), dot(v, v));
  Vec3d sum;
  for (const Vec3d& p : polygon.vertices) {
    sum += p;
    const Vec3d d = p - origin;
    const double a = dot(d, u) / dot(u, u), b = dot(d, v) / dot(v, v);
    const Vec3d off = d - u * std::round(a) - v * std::round(b);
    if (!(dot(off, off) <= limit) || std::abs(a - 0.5) > 0.6 || std::abs(b - 0.5) > 0.6) return false;
  }
  const Vec3d off = sum / 4.0 - (origin + (u + v) * 0.5);
  return dot(off, off) <= limit;
}

}  // namespace etendue::eval
