// What a light of luminance 1 cd/m2 throws on a plane that faces it from its axis.
#pragma once

#include "etendue/light.h"
#include "wide.h"

namespace etendue {

// Illuminance over luminance (steradians of projected solid angle) at (0, 0, -d) in the light's frame, on a plane facing the light's
// origin; exact for every shape here, near or far. For tubes the point is opposite the middle. d lies outside of the shape.
Wide facing_factor(const SphereShape& sphere, double d);
Wide facing_factor(const DiskShape& disk, double d);
double facing_factor(const RectShape& rect, double d);
double facing_factor(const PolygonShape& polygon, double d);
double facing_factor(const TubeShape& tube, double d);

// The same of a line, over its intensity perpendicular to itself: 1/m2.
double facing_factor(const LineShape& line, double d);

}  // namespace etendue
