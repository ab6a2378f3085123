// Drobot, "Physically Based Area Lights", GPU Pro 5 (2014). 1.3.3: one point of a flat light that stands for all of it. 1.3.4 and 1.6: the
// part of a light that a cone or pyramid about the mirrored view meets, as a small light at its middle.
#include "cones.h"
#include "drobot_point.h"
#include "representative_point.h"
#include "solid_angle.h"
#include "specular_view.h"

namespace etendue::eval {
namespace {

// Eq 1.16 with the cosine at the light that eq 1.3 has.
template <class Flat>
double small_area(const Flat& light, const Vec3d& point, const Vec3d& n) {
  const double r2 = dot(point, point);
  return cosine_towards(point, n) * light.area() * light.height() / (r2 * std::sqrt(r2));
}
// Eq 1.16 as its text has it: theta_o is the angle between the surface's normal and the light's.
template <class Flat>
double equation_16(const Flat& light, const Vec3d& n) {
  const Vec3d point = plain_point(light, n);
  return cosine_towards(point, n) * light.area() * saturate(-dot(n, light.normal)) / dot(point, point);
}
template <class Flat>
double equation_16_mended(const Flat& light, const Vec3d& n) {
  return small_area(light, plain_point(light, n), n);
}
template <class Flat>
double equation_16_clamped(const Flat& light, const Vec3d& n) {
  return small_area(light, clamped_point(light, n), n);
}
double point(const RectView& rect, const Vec3d& n) { return solid_angle(rect.corners()) * cosine_towards(clamped_point(rect, n), n); }
double point_above(const RectView& rect, const Vec3d& n) { return solid_angle_above(rect, n) * cosine_towards(clamped_point(rect, n), n); }
double simplified(const RectView& rect, const Vec3d& n) { return solid_angle(rect.corners()) * cosine_towards(plain_point(rect, n), n); }
double simplified_above(const RectView& rect, const Vec3d& n) {
  return solid_angle_above(rect, n) * cosine_towards(plain_point(rect, n), n);
}

constexpr std::string_view chapter = "Drobot 2014 (GPU Pro 5), 1.3.3";
constexpr std::string_view equation = "Drobot 2014 (GPU Pro 5), eq 1.16";
constexpr DiffuseMethod methods[] = {
    {"drobot-point", chapter,
     "The point half way between the light's nearest and its most frontal one, times the solid angle: 15 % off above the horizon, twice "
     "the "
     "light across it.",
     point},
    {"drobot-point-horizon", chapter, "The same with the solid angle above the horizon: 60 % off across it.", point_above},
    {"drobot-simplified", chapter,
     "The point from the plane instead of the light: 20 % off above the horizon, four times the light across it.", simplified},
    {"drobot-simplified-horizon", chapter, "The same with the solid angle above the horizon.", simplified_above},
    {"drobot-1-16", equation,
     "Area times both cosines over r^2 at the simplified point, the light's cosine taken, as printed, between both normals: wrong at any "
     "distance unless the light stands straight above.",
     equation_16<RectView>, equation_16<DiskView>},
    {"drobot-1-16-mended", equation,
     "The same with the cosine at the light, as eq 1.3 has it: right far away; grows without bound near the light, because the area over "
     "r^2 does.",
     equation_16_mended<RectView>, equation_16_mended<DiskView>},
    {"drobot-1-16-clamped-mended", equation, "The same at the point of the first form.", equation_16_clamped<RectView>,
     equation_16_clamped<DiskView>},
};

// ---- Specular, 1.3.4 ----

// The cone cut with the light's plane, as a disk about where the mirrored view meets it; nothing if it does not.
struct ConeDisk {
  Vec3d centre;
  double radius;
};
template <class Flat>
std::optional<ConeDisk> cone_disk(const Flat& light, const Vec3d& mirror, double half_angle) {
  const double falling = -dot(mirror, light.normal);
  if (!(falling > 0)) return std::nullopt;
  const double distance = light.height() / falling;
  return ConeDisk{mirror * distance, half_angle < 0.5 * pi ? distance * std::tan(half_angle) : 1e300};
}

// Eq 1.21 and 1.22.
std::optional<LightPart> covered(const DiskView& disk, const ConeDisk& cone) {
  const Vec3d across = cone.centre - disk.centre;
  const double apart = length(across);
  const DiskOverlap overlap = disk_overlap(disk.radius, cone.radius, apart);
  if (!(overlap.share > 0)) return std::nullopt;
  const double smaller = std::min(disk.radius, cone.radius);
  return LightPart{overlap.share * pi * smaller * smaller, disk.centre + (apart > 0 ? across * (overlap.middle / apart) : Vec3d{})};
}
// Eq 1.23: the square of the disk's area, its sides along the light's, cut with it.
struct ConeSquare {
  ConeSquare(const RectView& rect, const ConeDisk& cone) {
    const double half = 0.5 * std::sqrt(pi) * cone.radius;
    const Vec3d at = cone.centre - rect.centre;
    const double s = dot(at, rect.x), t = dot(at, rect.y);
    s0 = std::max(-rect.half_x, s - half), s1 = std::min(rect.half_x, s + half);
    t0 = std::max(-rect.half_y, t - half), t1 = std::min(rect.half_y, t + half);
  }
  double width() const { return s1 - s0; }  // negative where they are apart
  double height() const { return t1 - t0; }
  Vec3d middle(const RectView& rect) const { return rect.at(0.5 * (s0 + s1), 0.5 * (t0 + t1)); }
  double s0, s1, t0, t1;
};
std::optional<LightPart> covered(const RectView& rect, const ConeDisk& cone) {
  const ConeSquare shared(rect, cone);
  if (!(shared.width() > 0 && shared.height() > 0)) return std::nullopt;
  return LightPart{shared.width() * shared.height(), shared.middle(rect)};
}

// Eq 1.19 with eq 1.3's solid angle.
template <class Flat>
Rgb as_small_light(const Flat& light, const LobeView& lobe, const std::optional<LightPart>& part) {
  if (!part) return {};
  const double r2 = dot(part->middle, part->middle);
  return lobe(part->middle) * (part->area * light.height() / (r2 * std::sqrt(r2)));
}
template <class Flat>
Rgb through_cone(const Flat& light, const LobeView& lobe, double half_angle) {
  const auto cone = cone_disk(light, lobe.mirror, half_angle);
  return cone ? as_small_light(light, lobe, covered(light, *cone)) : Rgb{};
}
// In angles: the cone over the sphere and that of the lobe.
Rgb through_cone(const SphereView& sphere, const LobeView& lobe, double half_angle) {
  const double distance = length(sphere.centre), half = std::asin(sphere.radius / distance);
  const Vec3d axis = sphere.centre / distance, across = lobe.mirror - axis * dot(lobe.mirror, axis);
  const double sine = length(across), apart = std::atan2(sine, dot(lobe.mirror, axis));
  const DiskOverlap overlap = disk_overlap(half, half_angle, apart);
  const Vec3d middle = sine > 0 ? axis * std::cos(overlap.middle) + across * (std::sin(overlap.middle) / sine) : axis;
  return lobe(middle) * (overlap.share * cone_solid_angle(std::min(half, half_angle)));
}
template <class Light>
Rgb equation_20_mended(const Light& light, const LobeView& lobe) {
  return through_cone(light, lobe, printed_cone(lobe.alpha()));
}
template <class Light>
Rgb fitted(const Light& light, const LobeView& lobe) {
  return through_cone(light, lobe, fitted_cone(lobe.lobe.distribution, lobe.alpha()));
}

// As printed: A_S divides, eq 1.21 has a bracket too few, the middle of eq 1.22 is taken also where one disk contains the other, and the
// corners of eq 1.23 are exchanged, so that what two rectangles share is 0 and what lies between them is not.
Rgb equation_20(const DiskView& disk, const LobeView& lobe) {
  const auto cone = cone_disk(disk, lobe.mirror, printed_cone(lobe.alpha()));
  if (!cone) return {};
  const double r0 = disk.radius, r1 = cone->radius, smaller = std::min(r0, r1), inner = std::abs(r0 - r1);
  const Vec3d across = cone->centre - disk.centre;
  const double x = saturate(1 - length(across) - inner / (r0 + r1 - inner));
  const Vec3d middle = disk.centre + across * ((r0 - r1) / (2 * length(across)) + 0.5);
  return lobe(middle) / (pi * smaller * smaller * x * x * (3 - 2 * x));
}
Rgb equation_20(const RectView& rect, const LobeView& lobe) {
  const auto cone = cone_disk(rect, lobe.mirror, printed_cone(lobe.alpha()));
  if (!cone) return {};
  const ConeSquare shared(rect, *cone);
  return lobe(shared.middle(rect)) / (std::max(-shared.width(), 0.0) * std::max(-shared.height(), 0.0));
}

// ---- Specular, 1.6: the heuristic for lobes that are no cones ----

// Lobes of half vectors are as wide as the cone in the plane of incidence and n.v of it across: the half vector moves by half of what the
// light moves by, and by 1 / (2 n.v) of it. Its rectangle has the area of that ellipse. Corner rays, of any length.
std::array<Vec3d, 4> lobe_corners(const LobeView& lobe) {
  constexpr double widest = 1.5;  // rad
  const double half = 0.5 * std::sqrt(pi) * std::tan(std::min(fitted_cone(lobe.lobe.distribution, lobe.alpha()), widest));
  const double cosine = dot(lobe.normal, lobe.view);
  const Vec3d sideways = cross(lobe.normal, lobe.view),
              across = length(sideways) > 1e-12 ? normalised(sideways) : basis_around(lobe.mirror).tangent;
  const Vec3d x = cross(across, lobe.mirror) * half, y = across * (lobe.lobe.distribution == Distribution::phong ? half : half * cosine);
  return {lobe.mirror - x - y, lobe.mirror + x - y, lobe.mirror + x + y, lobe.mirror - x + y};
}

Rgb elongated(const RectView& rect, const LobeView& lobe) { return as_small_light(rect, lobe, pyramid_on(rect, lobe_corners(lobe))); }

constexpr std::string_view specular_equation = "Drobot 2014 (GPU Pro 5), eq 1.20";
constexpr SpecularRules rules_20{.rect = equation_20, .disk = equation_20, .lobes = Lobes::every};
constexpr SpecularRules rules_elongated{.rect = elongated, .lobes = Lobes::every};
constexpr SpecularRules rules_20_mended{.rect = equation_20_mended<RectView>,
                                        .disk = equation_20_mended<DiskView>,
                                        .sphere = equation_20_mended<SphereView>,
                                        .sun = equation_20_mended<SphereView>,
                                        .lobes = Lobes::every};
constexpr SpecularRules rules_fitted{
    .rect = fitted<RectView>, .disk = fitted<DiskView>, .sphere = fitted<SphereView>, .sun = fitted<SphereView>, .lobes = Lobes::every};
constexpr SpecularMethod specular[] = {
    {"drobot-1-20", specular_equation,
     "What a cone of half angle alpha meets of the light, as a small light. Printed: A_S divides, so that the answer changes with the unit "
     "of "
     "length, and eq 1.21 to 1.23 have slips of their own; rectangles are dark where they should be lit.",
     published<rules_20>},
    {"drobot-1-20-mended", specular_equation,
     "With the solid angle of A_S and eq 1.21 to 1.23 as they are meant. A cone of half angle alpha takes in a quarter of what a lobe of "
     "facets "
     "mirrors; at grazing views the round cone takes in too much.",
     published<rules_20_mended>},
    {"drobot-1-20-fitted", "Drobot 2014 (GPU Pro 5), eq 1.17, 1.18",
     "The same with the cone at whose edge the lobe has fallen to 1 / e: right seen from above, too bright at grazing views.",
     published<rules_fitted>},
    {"drobot-elongated", "Drobot 2014 (GPU Pro 5), 1.6",
     "Rectangles: the fitted cone as a pyramid that is n.v as wide across the plane of incidence, cut with the light, its area and its "
     "middle. "
     "No light from lobes' tails.",
     published<rules_elongated>},
};

}  // namespace

std::span<const DiffuseMethod> drobot_methods() { return methods; }
std::span<const SpecularMethod> drobot_specular_methods() { return specular; }

}  // namespace etendue::eval
