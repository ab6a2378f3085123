// Plane polygons.
#pragma once

#include "etendue/vec.h"

#include <vector>

namespace etendue {

// No two edges meet but neighbours at their common corner. Quadratic in the number of points.
bool is_simple(const std::vector<Vec2d>& points);

}  // namespace etendue
