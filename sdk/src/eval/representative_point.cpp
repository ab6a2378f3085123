#include "representative_point.h"

namespace etendue::eval {
namespace {

// Where (a + b t) / (c2 + t^2)^(3/2) is highest: b (c2 + t^2) = 3 t (a + b t), the root at which the numerator is positive.
double highest_along(double a, double b, double c2) {
  const double root = std::sqrt(9 * a * a + 8 * b * b * c2);
  if (b == 0) return 0;
  return a > 0 ? 2 * b * c2 / (3 * a + root) : (root - 3 * a) / (4 * b);
}

}  // namespace

// The gradient within the plane vanishes only on the line from the foot of the point along the normal's part in the plane; else the highest
// value is on a side.
Vec3d most_representative(const RectView& rect, const Vec3d& n) {
  const auto value = [&](const Vec3d& p) {
    const double r2 = dot(p, p);
    return r2 > 0 ? dot(n, p) / (r2 * std::sqrt(r2)) : 0;
  };
  Vec3d best = rect.centre;
  const auto consider = [&](const Vec3d& p) {
    if (value(p) > value(best)) best = p;
  };
  const double h = rect.height();
  const Vec3d foot = rect.normal * -h, in_plane = n - rect.normal * dot(n, rect.normal);
  const double across = length(in_plane);
  // A candidate outside is moved to the rectangle, where it does no harm.
  consider(rect.closest(across > 0 ? foot + in_plane * (highest_along(dot(n, foot), across, h * h) / across) : foot));
  const std::array<Vec3d, 4> corners = rect.corners();
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3d side = corners[(i + 1) % 4] - corners[i];
    const double l = length(side);
    if (!(l > 0)) continue;
    const Vec3d along = side / l;
    const double from_foot = dot(corners[i], along);
    const Vec3d side_foot = corners[i] - along * from_foot;
    const double t = highest_along(dot(n, side_foot), dot(n, along), dot(side_foot, side_foot));
    consider(side_foot + along * std::clamp(t, from_foot, from_foot + l));
  }
  return best;
}

}  // namespace etendue::eval
