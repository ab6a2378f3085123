// The area lights of the Eden engine: Karis' and Frostbite's put together. Its luminosity is a free number; here it is the intensity (cd)
// of the light of 1 cd/m2 across it. The point of the light that the mirrored view is closest to gives the distance, for diffuse light as
// if seen along the normal; the range that its falloffs end at is none.
#include "karis.h"
#include "representative_point.h"
#include "solid_angle.h"

namespace etendue::eval {
namespace {

double falloff(const Vec3d& point) { return 1 / (dot(point, point) + 1); }

double sphere_light(const SphereView& sphere, const Vec3d& n) {
  const Vec3d point = closest_to_ray(sphere, n);
  return pi * sphere.radius * sphere.radius * cosine_towards(point, n) * falloff(point);
}

// Printed: its cosine is Karis' eq 16, which has the falloff in it already.
double tube_light(const TubeView& tube, const Vec3d& n) {
  return intensity_across(tube) * line_irradiance(tube, n, 2) * falloff(closest_to_ray(nearest_sphere(tube, n), n));
}
double tube_light_mended(const TubeView& tube, const Vec3d& n) { return intensity_across(tube) * line_irradiance(tube, n, 2); }

double rect_light(const RectView& rect, const Vec3d& n) { return solid_angle_printed(rect) * mean_cosine(rect, n); }

constexpr DiffuseMethod methods[] = {
    {.name = "eden-sphere",
     .source = "Eden, sphere area lights",
     .note = "A point at the place that the mirrored view is closest to, with 1 / (d^2 + 1): half of the light at 1 m; right far away.",
     .sphere = sphere_light},
    {.name = "eden-tube",
     .source = "Eden, tube area lights",
     .note = "Karis' eq 16 times 1 / (d^2 + 1) once more: falls as d^-4.",
     .tube = tube_light},
    {.name = "eden-tube-mended",
     .source = "Eden, tube area lights",
     .note = "With the falloff once: Karis' eq 16.",
     .tube = tube_light_mended},
    {.name = "eden-rect",
     .source = "Eden, rectangular area lights (one-way)",
     .note = "Frostbite's listing 12; the linear falloff to a range, 1 without one, is left to the caller.",
     .rect = rect_light},
};

// ---- Specular ----

// Eden's GGX has alpha alpha' where alpha^2 stands: a lobe of the geometric mean of both.
double between(double alpha, double radius, const Vec3d& point) {
  return std::sqrt(alpha * saturate(alpha + radius / (2 * length(point))));
}
Rgb sphere_specular(const SphereView& sphere, const LobeView& lobe) {
  const Vec3d point = closest_to_ray(sphere, lobe.mirror);
  return lobe(point) *
         (lobe.density_ratio(point, between(lobe.alpha(), sphere.radius, point)) * pi * sphere.radius * sphere.radius * falloff(point));
}
// The cosine of the lighting is Karis' eq 16 of the normal, whatever the point's is.
Rgb tube_specular_mended(const TubeView& tube, const LobeView& lobe) {
  const Vec3d point = closest_to_ray(nearest_sphere(tube, lobe.mirror), lobe.mirror);
  const double cosine = dot(lobe.normal, normalised(point));
  if (!(cosine > 0)) return {};
  return lobe(point) *
         (lobe.density_ratio(point, between(lobe.alpha(), tube.radius, point)) * tube_light_mended(tube, lobe.normal) / cosine);
}
Rgb tube_specular(const TubeView& tube, const LobeView& lobe) {
  return tube_specular_mended(tube, lobe) * falloff(closest_to_ray(nearest_sphere(tube, lobe.mirror), lobe.mirror));
}
// No lobe: f0 times the illuminance, fading with the distance (m) from the light to where the mirrored view meets its plane.
Rgb rect_specular(const RectView& rect, const LobeView& lobe) {
  const double falling = -dot(lobe.mirror, rect.normal);
  if (!(falling > 0)) return {};
  const Vec3d at = lobe.mirror * (rect.height() / falling);
  const double smooth = 1 - std::sqrt(lobe.alpha());
  const double left = 1 - saturate(length(at - rect.closest(at)) * smooth * smooth * 32);
  return fresnel_reflectance(lobe.lobe, 1) * (left * falling * rect_light(rect, lobe.normal));
}

constexpr SpecularRules sphere_rules{.sphere = sphere_specular};
constexpr SpecularRules tube_rules{.tube = tube_specular};
constexpr SpecularRules tube_rules_mended{.tube = tube_specular_mended};
constexpr SpecularRules rect_rules{.rect = rect_specular};
constexpr SpecularMethod specular[] = {
    {"eden-sphere", "Eden, sphere area lights",
     "The sphere's point closest to the mirrored view, alpha alpha' in the place of alpha^2, alpha' with size / (2 distance), and 1 / (d^2 "
     "+ "
     "1): half of the light at 1 m.",
     published<sphere_rules>},
    {"eden-tube", "Eden, tube area lights", "The same on a tube, with Karis' eq 16 for the cosine. Printed: the falloff twice.",
     published<tube_rules>},
    {"eden-tube-mended", "Eden, tube area lights", "With the falloff once.", published<tube_rules_mended>},
    {"eden-rect", "Eden, rectangular area lights (one-way)",
     "f0 times the illuminance, fading over 1 / (32 (1 - roughness)^2) metres beside the light's mirror image: no lobe.",
     published<rect_rules>},
};

}  // namespace

std::span<const DiffuseMethod> eden_methods() { return methods; }
std::span<const SpecularMethod> eden_specular_methods() { return specular; }

}  // namespace etendue::eval
