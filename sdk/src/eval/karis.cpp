// Karis, "Real Shading in Unreal Engine 4" (2013): area lights as points and lines.
#include "karis.h"

#include "cones.h"
#include "etendue/directional_albedo.h"

#include "representative_point.h"

namespace etendue::eval {

double line_irradiance(const TubeView& tube, const Vec3d& n, double floor) {
  const double a = length(tube.a), b = length(tube.b);
  return 2 * saturate(dot(n, tube.a) / (2 * a) + dot(n, tube.b) / (2 * b)) / (a * b + dot(tube.a, tube.b) + floor);
}

double intensity_across(const TubeView& tube) { return 2 * tube.radius * length(tube.b - tube.a) + pi * tube.radius * tube.radius; }

Vec3d closest_to_ray(const SphereView& sphere, const Vec3d& r) {
  const Vec3d to_ray = r * dot(sphere.centre, r) - sphere.centre;
  const double distance = length(to_ray);
  return distance > sphere.radius ? sphere.centre + to_ray * (sphere.radius / distance) : sphere.centre + to_ray;
}

SphereView nearest_sphere(const TubeView& tube, const Vec3d& r) {
  const Vec3d span = tube.b - tube.a;
  const double along = dot(r, span), across2 = dot(span, span) - along * along;
  const double t = across2 > 0 ? (dot(r, tube.a) * along - dot(tube.a, span)) / across2 : 0;
  return {tube.a + span * saturate(t), tube.radius};
}

SphereView picott_sphere(const TubeView& tube, const Vec3d& r) {
  const Vec3d span = tube.b - tube.a;
  const double a_span = dot(tube.a, span), r_a = dot(r, tube.a), r_span = dot(r, span);
  const double divisor = a_span * r_span - dot(span, span) * r_a;
  const double t = divisor != 0 ? (a_span * r_a - dot(tube.a, tube.a) * r_span) / divisor : 0;
  return {tube.a + span * saturate(t), tube.radius};
}

namespace {

// Eq 10: the alpha of a lobe as wide as one and a light of that radius at that distance together.
double widened(double alpha, double radius, double distance) { return saturate(alpha + radius / (3 * distance)); }

}  // namespace

double sphere_normalisation(const SphereView& sphere, const LobeView& lobe) {
  const double ratio = lobe.alpha() / widened(lobe.alpha(), sphere.radius, length(sphere.centre));
  return ratio * ratio;
}
double line_normalisation(const TubeView& tube, const SphereView& nearest, const LobeView& lobe) {
  return lobe.alpha() / widened(lobe.alpha(), length(tube.b - tube.a), length(nearest.centre));
}

namespace {

// lx facing a sphere of 1 cd/m2, as that of a point.
double facing(const SphereView& sphere) { return pi * sphere.radius * sphere.radius / dot(sphere.centre, sphere.centre); }
double punctual_sphere(const SphereView& sphere, const Vec3d& n) { return facing(sphere) * cosine_towards(sphere.centre, n); }
// Eq 9 without a range.
double punctual_sphere_9(const SphereView& sphere, const Vec3d& n) {
  return pi * sphere.radius * sphere.radius / (dot(sphere.centre, sphere.centre) + 1) * cosine_towards(sphere.centre, n);
}

// The right side of eq 15 is the integral over a segment divided by its length. Per metre a tube has the intensity 2 R across its axis.
double equation_15(const TubeView& tube, const Vec3d& n) { return 2 * tube.radius * line_irradiance(tube, n, 0); }
double equation_15_mended(const TubeView& tube, const Vec3d& n) { return length(tube.b - tube.a) * equation_15(tube, n); }
double equation_16(const TubeView& tube, const Vec3d& n) { return intensity_across(tube) * line_irradiance(tube, n, 2); }

constexpr DiffuseMethod methods[] = {
    {.name = "karis-sphere",
     .source = "Karis 2013, sphere lights",
     .note = "A point of the same intensity: exact for a sphere above the horizon; dark once its centre has set, without bound inside.",
     .sphere = punctual_sphere},
    {.name = "karis-sphere-9",
     .source = "Karis 2013, eq 9",
     .note = "The same with 1 / (d^2 + 1): half of the light at 1 m, whatever the sphere's size.",
     .sphere = punctual_sphere_9},
    {.name = "karis-15",
     .source = "Karis 2013, eq 15",
     .note =
         "A line that emits alike in all directions, in closed form above the horizon, cut where the mean cosine is negative. Printed: the "
         "length is missing.",
     .tube = equation_15},
    {.name = "karis-15-mended",
     .source = "Karis 2013, eq 15",
     .note = "The same times the length: far away too bright along the axis, where a tube's profile shrinks, and without its caps.",
     .tube = equation_15_mended},
    {.name = "karis-16",
     .source = "Karis 2013, eq 16",
     .note = "Eq 15 as a point's falloff 1 / (d^2 + 1): half of the light at 1 m, whatever the tube's size; right far away.",
     .tube = equation_16},
};

// ---- Specular ----

// D of the wider lobe in the place of D, towards the centre.
Rgb equation_10(const SphereView& sphere, const LobeView& lobe) {
  const double wider = widened(lobe.alpha(), sphere.radius, length(sphere.centre));
  return lobe(sphere.centre) * (lobe.density_ratio(sphere.centre, wider) * facing(sphere));
}

// As eq 11 prints it the vector leads from the ray to the centre, and the point lies on the sphere's far side from the ray.
Rgb equation_11(const SphereView& sphere, const LobeView& lobe) {
  const Vec3d from_ray = sphere.centre - lobe.mirror * dot(sphere.centre, lobe.mirror);
  return lobe(sphere.centre + from_ray * saturate(sphere.radius / length(from_ray))) * facing(sphere);
}
Rgb equation_11_mended(const SphereView& sphere, const LobeView& lobe) {
  return lobe(closest_to_ray(sphere, lobe.mirror)) * facing(sphere);
}
Rgb equation_14(const SphereView& sphere, const LobeView& lobe) {
  return equation_11_mended(sphere, lobe) * sphere_normalisation(sphere, lobe);
}

// lx facing the line of eq 15 without its cosine, times the tube's width. No caps.
double facing(const TubeView& tube) {
  return 4 * tube.radius * length(tube.b - tube.a) / (length(tube.a) * length(tube.b) + dot(tube.a, tube.b));
}
Rgb point_of(const TubeView& tube, const SphereView& sphere, const LobeView& lobe) {
  return lobe(closest_to_ray(sphere, lobe.mirror)) * facing(tube);
}
Rgb equation_19(const TubeView& tube, const LobeView& lobe) { return point_of(tube, nearest_sphere(tube, lobe.mirror), lobe); }
// Eq 14 for the radius. Eq 20 prints no alpha' for the length.
Rgb equation_20(const TubeView& tube, const LobeView& lobe) {
  const SphereView sphere = nearest_sphere(tube, lobe.mirror);
  return point_of(tube, sphere, lobe) * sphere_normalisation(sphere, lobe);
}
// Both, the length taken for a radius in eq 10.
Rgb normalised_point(const TubeView& tube, const SphereView& sphere, const LobeView& lobe) {
  return point_of(tube, sphere, lobe) * (sphere_normalisation(sphere, lobe) * line_normalisation(tube, sphere, lobe));
}
Rgb equation_18(const TubeView& tube, const LobeView& lobe) { return normalised_point(tube, picott_sphere(tube, lobe.mirror), lobe); }
Rgb equation_20_mended(const TubeView& tube, const LobeView& lobe) {
  return normalised_point(tube, nearest_sphere(tube, lobe.mirror), lobe);
}

// A cone of light of one luminance gives what the lobe reflects of a white sky (eq 8).
Rgb environment_brdf(const LobeView& lobe) { return reflectance(lobe.lobe, lobe.frame.vector(lobe.view), 1e-4).value; }

// The image of the light, blurred by a square of the cone's area where the mirrored view meets its plane.
Rgb billboard(const RectView& rect, const LobeView& lobe) {
  const double falling = -dot(lobe.mirror, rect.normal);
  if (!(falling > 0)) return {};
  const Vec3d at = lobe.mirror * (rect.height() / falling) - rect.centre;
  const double half = 0.5 * std::sqrt(pi) * length(at + rect.centre) * std::tan(printed_cone(lobe.alpha()));
  const auto seen = [half](double x, double half_side) {
    return std::max(std::min(x + half, half_side) - std::max(x - half, -half_side), 0.0) / (2 * half);
  };
  return environment_brdf(lobe) * (seen(dot(at, rect.x), rect.half_x) * seen(dot(at, rect.y), rect.half_y));
}
// Of the cone about the mirrored view the part that the sphere covers (Oat 2006).
Rgb cone_intersection(const SphereView& sphere, const LobeView& lobe) {
  const double distance = length(sphere.centre), half = std::asin(sphere.radius / distance), cone = printed_cone(lobe.alpha());
  const double apart = std::atan2(length(cross(sphere.centre, lobe.mirror)), dot(sphere.centre, lobe.mirror));
  const double share = disk_overlap(half, cone, apart).share * cone_solid_angle(std::min(half, cone)) / cone_solid_angle(cone);
  return share > 0 ? environment_brdf(lobe) * share : Rgb{};
}

constexpr SpecularRules rules_10{.sphere = equation_10, .sun = equation_10};
constexpr SpecularRules rules_11{.sphere = equation_11, .sun = equation_11};
constexpr SpecularRules rules_11_mended{.sphere = equation_11_mended, .sun = equation_11_mended};
constexpr SpecularRules rules_14{.sphere = equation_14, .sun = equation_14};
constexpr SpecularRules rules_18{.tube = equation_18};
constexpr SpecularRules rules_19{.tube = equation_19};
constexpr SpecularRules rules_20{.tube = equation_20};
constexpr SpecularRules rules_20_mended{.tube = equation_20_mended};
constexpr SpecularRules rules_billboard{.rect = billboard};
constexpr SpecularRules rules_cone{.sphere = cone_intersection, .sun = cone_intersection};
constexpr SpecularMethod specular[] = {
    {"karis-10", "Karis 2013, eq 10",
     "A point at the centre, with D of a lobe that is wider by the light's size: what is polished looks rough under a large light.",
     published<rules_10>},
    {"karis-11", "Karis 2013, eq 11",
     "The sphere's point closest to the mirrored view. Printed: the vector to the ray has the wrong sign, so that it is the farthest "
     "one, and the highlight is all but lost.",
     published<rules_11>},
    {"karis-11-mended", "Karis 2013, eq 11",
     "The point that is meant, and no account of the light being gathered there: up to (size / alpha)^2 too bright.",
     published<rules_11_mended>},
    {"karis-14", "Karis 2013, eq 14", "The same times (alpha / alpha')^2, his sphere light. Too bright at grazing views.",
     published<rules_14>},
    {"karis-18", "Karis 2013, eq 18",
     "Tubes: the axis' point at the smallest angle to the mirrored view (Picott 1992), then as a sphere, and all of karis-20-mended. Taken "
     "for a line, a view that leads away is met behind, and the wrong end is taken.",
     published<rules_18>},
    {"karis-19", "Karis 2013, eq 19",
     "Tubes: the axis' point closest to the mirrored view's line, then as a sphere; no account of the gathering.", published<rules_19>},
    {"karis-20", "Karis 2013, eq 20",
     "The same times (alpha / alpha')^2 for the radius. Printed: no alpha' for the length, so that alpha / alpha' of it is left out.",
     published<rules_20>},
    {"karis-20-mended", "Karis 2013, eq 20", "The same times alpha / alpha' for the length too, taken for a radius in eq 10.",
     published<rules_20_mended>},
    {"karis-billboard", "Karis 2013, billboard reflections",
     "The share that a rectangle has of a cone about the mirrored view, times the lobe's albedo: no shape of the lobe, no light where the "
     "mirrored view leads away.",
     published<rules_billboard>},
    {"karis-cone", "Karis 2013, cone intersection", "The same of a sphere, by Oat's intersection of two cones.", published<rules_cone>},
};

}  // namespace

std::span<const DiffuseMethod> karis_methods() { return methods; }
std::span<const SpecularMethod> karis_specular_methods() { return specular; }

}  // namespace etendue::eval
