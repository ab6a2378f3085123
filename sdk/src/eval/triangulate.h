// Simple polygons as triangles.
#pragma once

#include "etendue/vec.h"

#include <cstdint>
#include <vector>

namespace etendue::eval {

// Triangles with the polygon's winding that cover it, as indices; fewer than n - 2 only where the polygon is degenerate.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<Vec2d>& polygon);

double signed_area(const std::vector<Vec2d>& polygon);

}  // namespace etendue::eval
