// What Karis' methods share with those that take them over.
#pragma once

#include "views.h"

namespace etendue::eval {

// Eq 16: a line with the intensity of 1 cd in all directions as a whole; `floor` is its + 2, which bounds it near the line.
double line_irradiance(const TubeView& tube, const Vec3d& n, double floor);
// Intensity (cd) of a tube of 1 cd/m2 across its axis: its profile's area 2 R l + pi R^2.
double intensity_across(const TubeView& tube);

}  // namespace etendue::eval
