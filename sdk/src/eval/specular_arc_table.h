// Outlines that are put together point by point: arcs of contours (contour.h), cut at the horizon, for lights whose outline changes its
// kind from place to place.
#pragma once

#include "contour.h"
#include "specular_outline.h"

#include <array>
#include <cstddef>
#include <vector>

namespace etendue::eval {

// Arcs b(s) = centre + u cos s + v sin s about their middle, |s| <= half, in the frame of their point (SideBlock): z along its normal, the
// view at x >= 0, y = 0. `reach` is tan(half / 2), 0 for none.
struct ArcTable {
  enum Number { centre_x, centre_y, centre_z, u_x, u_y, u_z, v_x, v_y, v_z, reach, numbers };
  static constexpr std::size_t most_arcs = 16, along_horizon = 2;  // these come after all others
  std::size_t arcs = 0;                                            // along the light, of the point that has most
  bool rims = false;                                               // some are circles in space, of a size of about 1
  std::array<std::vector<double>, numbers> arc;                    // (most_arcs + along_horizon) * points_at_once
  std::array<double, points_at_once> illuminance;                  // of a luminance of 1, where there are rims
  std::array<bool, points_at_once> inside, doubtful;               // the middle of the lobe is within the light

  // An arc in as many parts, of that point, from `first` on.
  void put(std::size_t first, std::size_t parts, std::size_t point, const Arc& whole);
};
void fill_arcs(const OutlinedLight& light, const PlaceBlock& places, std::size_t count, ArcTable& table);

}  // namespace etendue::eval
