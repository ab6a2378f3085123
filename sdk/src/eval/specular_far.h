// Rectangles that are far (far_places.h) from some points of a block: what a few places of them say, in vectors of doubles.
#pragma once

#include "far_places.h"
#include "specular_cells.h"

#include <array>
#include <cstddef>

namespace etendue::eval {

// Relative to the origin of the points.
struct FarRectangle {
  std::array<Vec3d, 4> corners;  // counter-clockwise about the directions between them, as seen from the front
  Vec3d normal;
  bool two_sided;
  bool separable;  // masking; else height-correlated
};

// How far away a side has to be for each order to keep half of a tolerance.
struct FarOrders {
  explicit FarOrders(double tolerance);

  std::array<double, most_far_order> largest;  // size for each order
  double tolerance;
  // 0: none is enough.
  std::size_t order(double size) const {
    for (std::size_t n = 0; n < most_far_order; ++n)
      if (size <= largest[n]) return n + 1;
    return 0;
  }
};

// Of a luminance of 1, and a bound as a part of it; below 0 where the light is not far.
struct FarShares {
  std::array<double, points_at_once> of_f0, of_f90, bound;
};
void far_shares(const FarRectangle& light, const PlaceBlock& places, std::size_t count, const FarOrders& orders, FarShares& to);

}  // namespace etendue::eval
