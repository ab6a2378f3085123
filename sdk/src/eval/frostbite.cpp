// Lagarde and de Rousiers, "Moving Frostbite to Physically Based Rendering 3.0" (2014), 4.6, 4.7.2, 4.7.5 and appendix E.
#include "contour.h"
#include "karis.h"
#include "punctual.h"
#include "representative_point.h"
#include "silhouette.h"
#include "solid_angle.h"

namespace etendue::eval {
namespace {

// ---- Spheres and disks ----

double listing_7_without_horizon(const SphereView& sphere, const Vec3d& n) {
  const double r2 = sphere.radius * sphere.radius, d2 = dot(sphere.centre, sphere.centre);
  return pi * (r2 / std::max(r2, d2)) * cosine_towards(sphere.centre, n);
}
double listing_7(const SphereView& sphere, const Vec3d& n) {
  const double beta = std::acos(dot(n, shader_normalise(sphere.centre))), h = length(sphere.centre) / sphere.radius;
  if (h * std::cos(beta) > 1) return pi * std::cos(beta) / (h * h);
  const double x = std::sqrt(h * h - 1), y = -x / std::tan(beta), root = std::sin(beta) * std::sqrt(1 - y * y);
  return (std::cos(beta) * std::acos(y) - x * root) / (h * h) + std::atan(root / x);
}

double listing_8_without_horizon(const DiskView& disk, const Vec3d& n) {
  const double h2 = dot(disk.centre, disk.centre) / (disk.radius * disk.radius);
  return pi * cosine_towards(-disk.centre, disk.normal) * cosine_towards(disk.centre, n) / (h2 + 1);
}
double listing_8(const DiskView& disk, const Vec3d& n) {
  const double theta = std::acos(dot(n, shader_normalise(disk.centre))), h = length(disk.centre) / disk.radius, h2 = h * h;
  double factor = std::cos(theta) / (1 + h2);
  if (!(theta < std::atan(h))) {
    const double cot = std::cos(theta) / std::sin(theta), x = std::sqrt(1 - h2 * cot * cot);
    factor = (-h * x * std::sin(theta) / (1 + h2) + std::atan(x * std::sin(theta) / h) +
              std::cos(theta) * (pi - std::acos(h * cot)) / (1 + h2)) /
             pi;
  }
  return factor * pi * cosine_towards(-disk.centre, disk.normal);
}

// Listing 10's function: a cap of directions with the sine squared s2 of its half angle about an axis with the cosine z from the normal.
double sphere_or_disk(double z, double s2) {
  if (z * z > s2) return pi * s2 * saturate(z);
  const double sine = std::sqrt(1 - z * z), x = std::sqrt(1 / s2 - 1), y = -x * (z / sine), root = sine * std::sqrt(1 - y * y);
  return std::max((z * std::acos(y) - x * root) * s2 + std::atan(root / x), 0.0);
}
// The same where rounding leaves the domain of the roots, and for a cap that is a hemisphere: pi / 2 (1 + z).
double cap_above(double z, double s2) {
  if (s2 >= 1) return 0.5 * pi * (1 + z);
  if (!(s2 > 0)) return 0;
  if (z * z > s2) return pi * s2 * saturate(z);
  const double sine = std::sqrt(1 - z * z), x = std::sqrt((1 - s2) / s2), y = std::clamp(-x * z / sine, -1.0, 1.0);
  const double root = sine * std::sqrt(1 - y * y);
  return std::max((z * std::acos(y) - x * root) * s2 + std::atan2(root, x), 0.0);
}

double listing_10_cosine(const SphereView& sphere, const Vec3d& n) {
  return std::clamp(dot(n, shader_normalise(sphere.centre)), -0.999, 0.999);
}
double listing_10_sphere(const SphereView& sphere, const Vec3d& n) {
  const double s2 = std::min(sphere.radius * sphere.radius / dot(sphere.centre, sphere.centre), 0.9999);
  return sphere_or_disk(listing_10_cosine(sphere, n), s2);
}
double listing_10_disk(const DiskView& disk, const Vec3d& n) {
  const double r2 = disk.radius * disk.radius, s2 = r2 / (r2 + std::max(r2, dot(disk.centre, disk.centre)));
  return sphere_or_disk(dot(n, shader_normalise(disk.centre)), s2) * cosine_towards(-disk.centre, disk.normal);
}
// From inside as from the surface next to it.
double sphere_mended(const SphereView& sphere, const Vec3d& n) {
  const double d2 = dot(sphere.centre, sphere.centre), d = std::sqrt(d2), r2 = sphere.radius * sphere.radius;
  if (!(r2 > 0)) return 0;
  return d > 0 ? cap_above(std::clamp(dot(n, sphere.centre) / d, -1.0, 1.0), std::min(r2 / d2, 1.0)) : 0.5 * pi;
}
double listing_10_disk_mended(const DiskView& disk, const Vec3d& n) {
  const double r2 = disk.radius * disk.radius, d2 = dot(disk.centre, disk.centre), d = std::sqrt(d2);
  return cap_above(std::clamp(dot(n, disk.centre) / d, -1.0, 1.0), r2 / (r2 + d2)) * disk.height() / d;
}
// The disk's own vector of illuminance, exact for every tilt, in the place of a facing disk's; the horizon cuts it as a sphere's.
double disk_mended(const DiskView& disk, const Vec3d& n) {
  const Vec3d e = direction_integral(disk_silhouette(disk.centre, disk.normal, disk.radius, false));
  const double facing = length(e);
  return facing > 0 ? cap_above(std::clamp(dot(n, e) / facing, -1.0, 1.0), std::min(facing / pi, 1.0)) : 0;
}

// Listing 14: beyond five times the diameter the inverse square.
double listing_14_sphere(const SphereView& sphere, const Vec3d& n) {
  const double r2 = sphere.radius * sphere.radius, d2 = dot(sphere.centre, sphere.centre);
  return d2 < 100 * r2 ? listing_10_sphere(sphere, n) : pi * r2 * saturate(listing_10_cosine(sphere, n)) / d2;
}
double listing_14_disk(const DiskView& disk, const Vec3d& n) {
  const double r2 = disk.radius * disk.radius, d2 = dot(disk.centre, disk.centre);
  if (d2 < 100 * r2) return listing_10_disk(disk, n);
  return pi * r2 * cosine_towards(disk.centre, n) * cosine_towards(-disk.centre, disk.normal) / d2;
}

// ---- Rectangles ----

// Listing 12: the solid angle times the mean clamped cosine.
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
  std::array<Vec3d, 4> corners = rect.corners();
  std::reverse(corners.begin(), corners.end());  // counter-clockwise about the light's normal
  return std::max(dot(direction_integral(polygon_silhouette(corners, rect.normal, false)), n), 0.0);
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

// ---- Tubes ----

// The cylinder as a rectangle about its axis that faces the point. The point's own distance from the axis gives the direction.
RectView facing_rect(const TubeView& tube) {
  const Vec3d span = tube.b - tube.a, left = shader_normalise(span);
  const Vec3d forward = shader_normalise(tube.a - left * dot(tube.a, left));
  return {(tube.a + tube.b) * 0.5, left, cross(left, forward), -forward, 0.5 * length(span), tube.radius};
}
// The caps as a sphere at the closest point of the axis.
SphereView nearest_sphere(const TubeView& tube) {
  const Vec3d span = tube.b - tube.a;
  return {tube.a + span * saturate(-dot(tube.a, span) / dot(span, span)), tube.radius};
}
double listing_13(const TubeView& tube, const Vec3d& n) {
  const SphereView sphere = nearest_sphere(tube);
  return listing_12(facing_rect(tube), n) +
         pi * cosine_towards(sphere.centre, n) * (tube.radius * tube.radius / dot(sphere.centre, sphere.centre));
}
// On the axis the cylinder is not seen, without a length there is none; inside as on the surface.
double listing_13_mended(const TubeView& tube, const Vec3d& n) {
  const Vec3d span = tube.b - tube.a;
  const bool long_enough = dot(span, span) > 0, aside = length(cross(span, tube.a)) > 1e-12 * length(span) * length(tube.a);
  const double caps = listing_7_without_horizon(long_enough ? nearest_sphere(tube) : SphereView{tube.a, tube.radius}, n);
  const double cylinder = long_enough && aside ? listing_12_mended(facing_rect(tube), n) : 0;
  return std::isfinite(caps) ? cylinder + caps : cylinder;
}

constexpr std::string_view listing_7_name = "Lagarde and de Rousiers 2014, listing 7",
                           listing_8_name = "Lagarde and de Rousiers 2014, listing 8";
constexpr std::string_view listing_10_name = "Lagarde and de Rousiers 2014, listing 10";
constexpr std::string_view e1 = "Lagarde and de Rousiers 2014, listing E.1";
constexpr std::string_view row = "Lagarde and de Rousiers 2014, table E.1";
constexpr DiffuseMethod methods[] = {
    {.name = "frostbite-7-without-horizon",
     .source = listing_7_name,
     .note = "pi (R / d)^2 times the cosine: exact for a sphere above the horizon; dark once its centre has set.",
     .sphere = listing_7_without_horizon},
    {.name = "frostbite-7",
     .source = listing_7_name,
     .note = "Tilted patch to sphere: exact. Printed: no number below the horizon (0 is right there) and inside the sphere.",
     .sphere = listing_7},
    {.name = "frostbite-7-mended",
     .source = listing_7_name,
     .note = "The same, defined everywhere; inside as on the surface next to it.",
     .sphere = sphere_mended},
    {.name = "frostbite-8-without-horizon",
     .source = listing_8_name,
     .note = "Far or facing disks only: the cosine at the light multiplies what a facing disk gives.",
     .disk = listing_8_without_horizon},
    {.name = "frostbite-8",
     .source = listing_8_name,
     .note = "Facing disk over the horizon times the cosine at the light: 98 of 100 tilted disks above the horizon get "
             "between a quarter and 105 % of their light.",
     .disk = listing_8},
    {.name = "frostbite-8-mended",
     .source = listing_8_name,
     .note = "The tilted disk's own vector of illuminance: exact as long as the sphere of the same vector is above the horizon, "
             "which cuts it as that sphere: 15 % off across.",
     .disk = disk_mended},
    {.name = "frostbite-10",
     .source = listing_10_name,
     .note =
         "Sphere and disk as one function; exact for spheres but for clamps of the cosine to .999 and of the sine squared to .9999. Disks "
         "as listing 8; from less than the radius as from the radius.",
     .disk = listing_10_disk,
     .sphere = listing_10_sphere},
    {.name = "frostbite-10-mended",
     .source = listing_10_name,
     .note = "Without the clamps: spheres exact, facing disks at any distance; tilted disks as listing 8.",
     .disk = listing_10_disk_mended,
     .sphere = sphere_mended},
    {.name = "frostbite-14",
     .source = "Lagarde and de Rousiers 2014, listing 14",
     .note = "Listing 10 up to five diameters, the inverse square beyond: 1 % too much for a facing disk there, all of what has half set.",
     .disk = listing_14_disk,
     .sphere = listing_14_sphere},
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
    {.name = "frostbite-13",
     .source = "Lagarde and de Rousiers 2014, listing 13",
     .note =
         "Cylinder as a facing rectangle (listing 12), caps as a sphere at the closest point of the axis: 4 % off above the horizon, from "
         "-22 % to +40 %; half of it across. Printed: no number on the axis.",
     .tube = listing_13},
    {.name = "frostbite-13-mended",
     .source = "Lagarde and de Rousiers 2014, listing 13",
     .note = "The same, defined on the axis, where only a cap is seen, without a length, and inside.",
     .tube = listing_13_mended},
};

// ---- Specular, 4.7.5 and 4.6 ----

// Listing 16: lobes of rough surfaces lie nearer to the normal than the mirrored view.
Vec3d dominant_direction(const LobeView& lobe) { return normalised(lobe.normal * lobe.alpha() + lobe.mirror * (1 - lobe.alpha())); }
Vec3d mirror_direction(const LobeView& lobe) { return lobe.mirror; }

// The light's point closest to where the ray comes closest to its plane: where they meet, or below the shading point.
template <class Flat>
Vec3d closest_by_plane(const Flat& light, const Vec3d& r) {
  const double falling = -dot(r, light.normal);
  return light.closest(falling > 0 ? r * (light.height() / falling) : light.normal * -light.height());
}
// The lobe's BRDF there times the illuminance.
Rgb lit_from(const Vec3d& point, const LobeView& lobe, double lux) {
  const double cosine = dot(lobe.normal, normalised(point));
  return cosine > 0 ? lobe(point) * (lux / cosine) : Rgb{};
}
template <Vec3d (*direction)(const LobeView&)>
Rgb plane_point(const RectView& rect, const LobeView& lobe) {
  return lit_from(closest_by_plane(rect, direction(lobe)), lobe, listing_12_mended(rect, lobe.normal));
}
template <Vec3d (*direction)(const LobeView&)>
Rgb plane_point(const DiskView& disk, const LobeView& lobe) {
  return lit_from(closest_by_plane(disk, direction(lobe)), lobe, listing_10_disk_mended(disk, lobe.normal));
}
// Karis' points and normalisations.
template <Vec3d (*direction)(const LobeView&)>
Rgb sphere_point(const SphereView& sphere, const LobeView& lobe) {
  return lit_from(closest_to_ray(sphere, direction(lobe)), lobe, sphere_mended(sphere, lobe.normal)) * sphere_normalisation(sphere, lobe);
}
template <Vec3d (*direction)(const LobeView&)>
Rgb tube_point(const TubeView& tube, const LobeView& lobe) {
  const SphereView sphere = nearest_sphere(tube, direction(lobe));
  return lit_from(closest_to_ray(sphere, direction(lobe)), lobe, listing_13_mended(tube, lobe.normal)) *
         (sphere_normalisation(sphere, lobe) * line_normalisation(tube, sphere, lobe));
}

// Listing 6: the disk's edge in the direction of the mirrored view, and the illuminance of the centre.
Rgb listing_6(const SphereView& sun, const LobeView& lobe) {
  const double cosine = dot(sun.centre, lobe.mirror), distance = std::sqrt(1 - sun.radius * sun.radius);
  const Vec3d across = lobe.mirror - sun.centre * cosine;
  const Vec3d point = cosine < distance ? sun.centre * distance + shader_normalise(across) * sun.radius : lobe.mirror;
  return lit_from(point, lobe, pi * sun.radius * sun.radius * cosine_towards(sun.centre, lobe.normal));
}

constexpr SpecularRules rules_plane_point{.rect = plane_point<mirror_direction>,
                                          .disk = plane_point<mirror_direction>,
                                          .sphere = sphere_point<mirror_direction>,
                                          .tube = tube_point<mirror_direction>};
constexpr SpecularRules rules_16{.rect = plane_point<dominant_direction>,
                                 .disk = plane_point<dominant_direction>,
                                 .sphere = sphere_point<dominant_direction>,
                                 .tube = tube_point<dominant_direction>};
constexpr SpecularRules rules_6{.sun = listing_6};
constexpr SpecularMethod specular[] = {
    {"frostbite-point", "Lagarde and de Rousiers 2014, 4.7.5",
     "The BRDF at the light's point that the mirrored view comes closest to, times the diffuse illuminance. Spheres and tubes with Karis' "
     "normalisation; rectangles and disks have none and are up to (size / alpha)^2 too bright.",
     published<rules_plane_point>},
    {"frostbite-16", "Lagarde and de Rousiers 2014, listing 16", "The same for a direction between normal and mirrored view, by alpha.",
     published<rules_16>},
    {"frostbite-6", "Lagarde and de Rousiers 2014, listing 6",
     "The sun's point closest to the mirrored view, times its illuminance, not normalised: (size / alpha)^2 too bright on polished "
     "surfaces.",
     published<rules_6>},
};

}  // namespace

std::span<const DiffuseMethod> frostbite_methods() { return methods; }
std::span<const SpecularMethod> frostbite_specular_methods() { return specular; }

double frostbite_disk_cone(const DiskEmitter& disk, const SpotShape& cone, const Vec3d& position) {
  const Vec3d apex = disk.centre - disk.normal * (disk.radius / std::tan(cone.outer_rad));
  return angular_falloff(cone, {0, 0, -dot(disk.normal, normalised(position - apex))});
}

Vec3d frostbite_diffuse_direction(const Vec3d& normal, const Vec3d& view, double roughness) {
  const double a = 1.02341 * roughness - 1.51174, b = -0.511705 * roughness + 0.755868;
  const double share = saturate((dot(normal, view) * a + b) * roughness);
  return normalised(normal + (view - normal) * share);
}

}  // namespace etendue::eval
