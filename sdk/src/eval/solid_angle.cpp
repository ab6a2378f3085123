#include "solid_angle.h"

namespace etendue::eval {

double right_pyramid(const RectView& rect) {
  const double a = rect.half_x, b = rect.half_y, h2 = dot(rect.centre, rect.centre);
  return 4 * std::asin(a * b / std::sqrt((a * a + h2) * (b * b + h2)));
}

double solid_angle_printed(const RectView& rect) {
  const std::array<Vec3d, 4> v = rect.corners();
  std::array<Vec3d, 4> n;
  for (std::size_t i = 0; i < 4; ++i) n[i] = shader_normalise(cross(v[i], v[(i + 1) % 4]));
  double sum = -2 * pi;
  for (std::size_t i = 0; i < 4; ++i) sum += std::acos(-dot(n[i], n[(i + 1) % 4]));
  return sum;
}

double solid_angle(std::span<const Vec3d> polygon) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Vec3d &p = polygon[0], &q = polygon[i], &r = polygon[i + 1];
    // The differences keep the digits of a small triangle far away.
    const double volume = dot(p, cross(q - p, r - p)), a = length(p), b = length(q), c = length(r);
    const double rest = a * b * c + a * dot(q, r) + b * dot(r, p) + c * dot(p, q);
    if (volume != 0) sum += 2 * std::atan2(volume, rest);
  }
  return sum;
}

double solid_angle_above(const RectView& rect, const Vec3d& n) { return solid_angle(clipped(rect.corners(), n).polygon()); }

}  // namespace etendue::eval
