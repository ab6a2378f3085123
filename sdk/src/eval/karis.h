// What Karis' methods share with those that take them over.
#pragma once

#include "specular_view.h"
#include "views.h"

namespace etendue::eval {

// Eq 16: a line with the intensity of 1 cd in all directions as a whole; `floor` is its + 2, which bounds it near the line.
double line_irradiance(const TubeView& tube, const Vec3d& n, double floor);
// Intensity (cd) of a tube of 1 cd/m2 across its axis: its profile's area 2 R l + pi R^2.
double intensity_across(const TubeView& tube);

// The point of a sphere that is closest to the ray along the unit vector r (eq 11): on the ray where the sphere meets it.
Vec3d closest_to_ray(const SphereView& sphere, const Vec3d& r);
// The sphere about the point of a tube's axis that is closest to the line along r (eq 19, clamped); about the first end if the axis has no
// length or runs along r.
SphereView nearest_sphere(const TubeView& tube, const Vec3d& r);
// About the point that is seen at the smallest angle to r (Picott 1992; eq 18).
SphereView picott_sphere(const TubeView& tube, const Vec3d& r);

// What gathering a sphere's or a line's light in one point brightens, taken back (eq 14; eq 20, with the length for a radius in eq 10).
double sphere_normalisation(const SphereView& sphere, const LobeView& lobe);
double line_normalisation(const TubeView& tube, const SphereView& nearest, const LobeView& lobe);

}  // namespace etendue::eval
