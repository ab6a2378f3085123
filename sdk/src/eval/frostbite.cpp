// Lagarde and de Rousiers, "Moving Frostbite to Physically Based Rendering 3.0" (2014), 4.7.2 and appendix E.
#include "representative_point.h"
#include "solid_angle.h"

namespace etendue::eval {
namespace {

// Listing 12: the solid angle times the mean of the clamped cosines towards the corners and the centre.
double mean_cosine(const RectView& rect, const Vec3d& n) {
  double sum = cosine_towards(rect.centre, n);
  for (const Vec3d& p : rect.corners()) sum += cosine_towards(p, n);
  return sum / 5;
}
double listing_12(const RectView& rect, const Vec3d& n) { return solid_angle_printed(rect) * mean_cosine(rect, n); }
// Where one of the five points is the shading point itself, which has no direction, the solid angle is 0.
double listing_12_mended(const RectView& rect, const Vec3d& n) {
  const double omega = solid_angle(rect.corners());
  return omega > 0 ? omega * mean_cosine(rect, n) : 0;
}

// Listing E.1 over corners in the order that it gives them, counter-clockwise about cross(left, up).
double form_factor(const std::array<Vec3d, 4>& corners, const Vec3d& n) {
  Vec3d sum;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3d a = shader_normalise(corners[i]), b = shader_normalise(corners[(i + 1) % 4]);
    sum += shader_normalise(cross(a, b)) * std::acos(dot(a, b));
  }
  // As printed: no sum above 1 passes, where that of a whole sky is 2 pi.
  return pi / (2 * pi) * saturate(dot(n, sum));
}
double listing_e1(const RectView& rect, const Vec3d& n) { return form_factor(rect.corners(), n); }
double listing_e1_right_handed(const RectView& rect, const Vec3d& n) {
  std::array<Vec3d, 4> corners = rect.corners();
  std::reverse(corners.begin(), corners.end());
  return form_factor(corners, n);
}
double listing_e1_mended(const RectView& rect, const Vec3d& n) {
  double sum = 0;
  const std::array<Vec3d, 4> corners = rect.corners();
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3d &a = corners[i], &b = corners[(i + 1) % 4];
    const Vec3d m = cross(a, b - a);
    const double sine = length(m);
    if (sine > 0) sum += std::atan2(sine, dot(a, b)) * dot(m, n) / sine;
  }
  return std::max(0.5 * sum, 0.0);
}

// Listing E.2: a direction half way between the light's plane and the normal, cut with the plane, clamped to the rectangle.
Vec3d listing_e2_point(const RectView& rect, const Vec3d& n) {
  const double clamped = 0.001 + saturate(dot(n, rect.normal));
  const Vec3d d0 = shader_normalise(n * clamped - rect.normal), d1 = shader_normalise(n - rect.normal * clamped);
  const Vec3d half = shader_normalise(d0 + d1);
  return rect.closest(half * (dot(rect.normal, rect.centre) / dot(rect.normal, half)));
}
double listing_e2(const RectView& rect, const Vec3d& n) { return solid_angle_printed(rect) * cosine_towards(listing_e2_point(rect, n), n); }
double listing_e2_above(const RectView& rect, const Vec3d& n) {
  return solid_angle_above(rect, n) * cosine_towards(listing_e2_point(rect, n), n);
}

double reference_point(const RectView& rect, const Vec3d& n) {
  return solid_angle_printed(rect) * cosine_towards(most_representative(rect, n), n);
}
double reference_point_pyramid(const RectView& rect, const Vec3d& n) {
  return right_pyramid(rect) * cosine_towards(most_representative(rect, n), n);
}
double reference_point_above(const RectView& rect, const Vec3d& n) {
  return solid_angle_above(rect, n) * cosine_towards(most_representative(rect, n), n);
}
double light_position(const RectView& rect, const Vec3d& n) { return solid_angle_printed(rect) * cosine_towards(rect.centre, n); }
double light_position_pyramid(const RectView& rect, const Vec3d& n) { return right_pyramid(rect) * cosine_towards(rect.centre, n); }
double light_position_above(const RectView& rect, const Vec3d& n) { return solid_angle_above(rect, n) * cosine_towards(rect.centre, n); }

constexpr std::string_view e1 = "Lagarde and de Rousiers 2014, listing E.1";
constexpr std::string_view row = "Lagarde and de Rousiers 2014, table E.1";
constexpr DiffuseMethod methods[] = {
    {"frostbite-12", "Lagarde and de Rousiers 2014, listing 12",
     "Solid angle (listing 11) times the mean clamped cosine of corners and centre; 3 % off above the horizon, as much as the light itself "
     "across it; half of a close large light is lost. Printed: 0 for a side without length.",
     listing_12},
    {"frostbite-12-mended", "Lagarde and de Rousiers 2014, listing 12",
     "The same with a solid angle that is defined everywhere and keeps its digits far away.", listing_12_mended},
    {"frostbite-e1", e1,
     "Lambert's sum over the sides, exact above the horizon up to the printed saturate(), which cuts it at 1/2; what is below the horizon "
     "counts negative. For left x up = -normal, which the listing presumes.",
     listing_e1},
    {"frostbite-e1-right-handed", e1,
     "The listing as printed for left x up = normal: the sum's sign turns and it is 0 wherever the light is seen.",
     listing_e1_right_handed},
    {"frostbite-e1-mended", e1, "Exact above the horizon: no cut at 1/2, angles by atan2, the winding from the side that is seen.",
     listing_e1_mended},
    {"frostbite-e2", "Lagarde and de Rousiers 2014, listing E.2",
     "Drobot's point in a simpler form, solid angle of the whole rectangle: 20 % off above the horizon, four times the light across it.",
     listing_e2},
    {"frostbite-e2-horizon", row, "Listing E.2 with the solid angle above the horizon: as much as the light itself across it.",
     listing_e2_above},
    {"frostbite-reference-point", row,
     "The point where cos(theta) / r^2 is highest, found by brute force there and in closed form here, times the solid angle: 19 % off "
     "above "
     "the horizon, five times the light across it.",
     reference_point},
    {"frostbite-reference-point-pyramid", row, "The same with a right pyramid's solid angle, which no tilt of the light lessens.",
     reference_point_pyramid},
    {"frostbite-reference-point-horizon", row, "The same with the solid angle above the horizon.", reference_point_above},
    {"frostbite-light-position", row,
     "The light's centre, times the solid angle: 4.5 % off above the horizon, 60 % across it; no light from a centre that has set.",
     light_position},
    {"frostbite-light-position-pyramid", row, "The same with a right pyramid's solid angle, which no tilt of the light lessens.",
     light_position_pyramid},
    {"frostbite-light-position-horizon", row, "The same with the solid angle above the horizon.", light_position_above},
};

}  // namespace

std::span<const DiffuseMethod> frostbite_methods() { return methods; }

}  // namespace etendue::eval
