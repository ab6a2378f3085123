// Luminance of the opening: intensity by the area that is seen.
#include <algorithm>
#include <cmath>

#include "etendue/photometric_quantities.h"

namespace etendue {
namespace {

// Semi-axes along C0 (x), C90 (y) and the vertical (z), in m, and the unit vector u to the eye. The silhouette of an ellipsoid is an
// ellipse of area pi |(b c ux, a c uy, a b uz)|; a cylinder's side shows its length times the width of its cross-section across u, and each
// end pi a b |u|.
struct Body {
  double a, b, c;
};

double ellipsoid(const Body& s, const Vec3d& u) { return pi * std::hypot(s.b * s.c * u.x, s.a * s.c * u.y, s.a * s.b * u.z); }

double box(const Body& s, const Vec3d& u) {
  return 4 * (s.b * s.c * std::abs(u.x) + s.a * s.c * std::abs(u.y) + s.a * s.b * std::abs(u.z));
}

double upright_cylinder(const Body& s, const Vec3d& u) {
  return pi * s.a * s.b * std::abs(u.z) + 4 * s.c * std::hypot(s.b * u.x, s.a * u.y);
}

double cylinder_along_x(const Body& s, const Vec3d& u) {
  return pi * s.b * s.c * std::abs(u.x) + 4 * s.a * std::hypot(s.c * u.y, s.b * u.z);
}

std::optional<double> seen_of_ies(const IntensityDistribution& distribution, const Vec3d& u) {
  const LuminousOpening opening = opening_of(distribution);
  const Body s{opening.length_m / 2, opening.width_m / 2, opening.height_m / 2};
  switch (opening.shape) {
    case OpeningShape::point:
    case OpeningShape::unknown:
      return {};
    case OpeningShape::rectangle:
    case OpeningShape::box:
      return box(s, u);
    case OpeningShape::disk:
    case OpeningShape::ellipse:
    case OpeningShape::vertical_cylinder:
    case OpeningShape::vertical_elliptical_cylinder:
      return upright_cylinder(s, u);
    case OpeningShape::sphere:
      return pi * s.b * s.b;
    case OpeningShape::ellipsoid:
      return ellipsoid(s, u);
    case OpeningShape::cylinder_along_length:
      return cylinder_along_x(s, u);
    case OpeningShape::cylinder_along_width:
      return cylinder_along_x({s.b, s.a, s.c}, {u.y, u.x, u.z});
    case OpeningShape::vertical_disk:
      return pi * s.b * s.c * std::abs(u.x);
  }
  return {};
}

// The sides that are seen are those towards C0 or C180 and towards C90 or C270; a round opening takes its height from both of them.
std::optional<double> seen_of_eulumdat(const EulumdatRecord& record, const Vec3d& u) {
  const double length = record.opening_length_mm / 1000, width = record.opening_width_mm / 1000;
  const double towards_x = record.opening_height_mm[u.x >= 0 ? 0 : 2] / 1000, towards_y = record.opening_height_mm[u.y >= 0 ? 1 : 3] / 1000;
  if (!(length > 0)) return {};
  if (!(width > 0)) {
    const double level = u.x * u.x + u.y * u.y;
    const double height = level > 0 ? (towards_x * u.x * u.x + towards_y * u.y * u.y) / level : 0;
    return pi / 4 * length * length * std::abs(u.z) + length * height * std::sqrt(level);
  }
  return length * width * std::abs(u.z) + length * towards_x * std::abs(u.x) + width * towards_y * std::abs(u.y);
}

}  // namespace

std::optional<double> projected_opening_m2(const IntensityDistribution& distribution, const IntensityWeb& web, const Vec3d& direction) {
  const double length = std::hypot(direction.x, direction.y, direction.z);
  if (!(length > 0) || !(length < HUGE_VAL)) return {};
  const WebFrame frame{web.frame().clockwise, web.type() == WebType::c ? web.frame().turn_deg : 0};
  const Vec3d u = direction_of(WebType::c, angles_of(WebType::c, direction, frame));
  const auto* const eulumdat = std::get_if<EulumdatRecord>(&distribution.record);
  return eulumdat != nullptr ? seen_of_eulumdat(*eulumdat, u) : seen_of_ies(distribution, u);
}

std::optional<double> opening_luminance(const IntensityDistribution& distribution, const IntensityWeb& web, const Vec3d& direction) {
  const std::optional<double> area = projected_opening_m2(distribution, web, direction);
  if (!area) return {};
  // An area of 1e-9 of the opening's is one seen from its edge to rounding.
  const LuminousOpening opening = opening_of(distribution);
  const double extent = std::max({opening.width_m, opening.length_m, opening.height_m});
  if (!(*area > 1e-9 * extent * extent)) return {};
  return web.towards(direction) / *area;
}

}  // namespace etendue
