// Outlines sent through a matrix: planes stay planes and cones over circles become cones over ellipses, which are cones over other circles.
#pragma once

#include "contour.h"

namespace etendue::eval {

// `linear` keeps the sense of turning (its determinant is positive).
Contour transformed(const Contour& contour, const Transform& linear);

}  // namespace etendue::eval
