// The area lights of the Eden engine: Karis' and Frostbite's put together. Its luminosity is a free number; here it is the intensity (cd)
// of the light of 1 cd/m2 across it. The point of the light that the mirrored view is closest to gives the distance; the view is along the
// normal, the range that its falloffs end at is none.
#include "karis.h"
#include "representative_point.h"
#include "solid_angle.h"

namespace etendue::eval {
namespace {

// The closest point of a sphere to the ray along the unit vector r.
Vec3d closest_to_ray(const SphereView& sphere, const Vec3d& r) {
  const Vec3d to_ray = r * dot(sphere.centre, r) - sphere.centre;
  const double distance = length(to_ray);
  return distance > sphere.radius ? sphere.centre + to_ray * (sphere.radius / distance) : sphere.centre + to_ray;
}
double falloff(const Vec3d& point) { return 1 / (dot(point, point) + 1); }

double sphere_light(const SphereView& sphere, const Vec3d& n) {
  const Vec3d point = closest_to_ray(sphere, n);
  return pi * sphere.radius * sphere.radius * cosine_towards(point, n) * falloff(point);
}

Vec3d closest_to_ray(const TubeView& tube, const Vec3d& r) {
  const Vec3d span = tube.b - tube.a;
  const double along = dot(r, span);
  const double t = (dot(r, tube.a) * along - dot(tube.a, span)) / (dot(span, span) - along * along);
  return closest_to_ray(SphereView{tube.a + span * saturate(t), tube.radius}, r);
}
// Printed: its cosine is Karis' eq 16, which has the falloff in it already.
double tube_light(const TubeView& tube, const Vec3d& n) {
  return intensity_across(tube) * line_irradiance(tube, n, 2) * falloff(closest_to_ray(tube, n));
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

}  // namespace

std::span<const DiffuseMethod> eden_methods() { return methods; }

}  // namespace etendue::eval
