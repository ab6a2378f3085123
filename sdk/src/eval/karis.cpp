// Karis, "Real Shading in Unreal Engine 4" (2013): area lights as points and lines.
#include "karis.h"

#include "representative_point.h"

namespace etendue::eval {

double line_irradiance(const TubeView& tube, const Vec3d& n, double floor) {
  const double a = length(tube.a), b = length(tube.b);
  return 2 * saturate(dot(n, tube.a) / (2 * a) + dot(n, tube.b) / (2 * b)) / (a * b + dot(tube.a, tube.b) + floor);
}

double intensity_across(const TubeView& tube) { return 2 * tube.radius * length(tube.b - tube.a) + pi * tube.radius * tube.radius; }

namespace {

double punctual_sphere(const SphereView& sphere, const Vec3d& n) {
  return pi * sphere.radius * sphere.radius / dot(sphere.centre, sphere.centre) * cosine_towards(sphere.centre, n);
}
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

}  // namespace

std::span<const DiffuseMethod> karis_methods() { return methods; }

}  // namespace etendue::eval
