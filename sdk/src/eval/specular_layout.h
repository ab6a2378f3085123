// Where first cells of a block of points end, in vectors: what each side, and each part of a side, says of the layers along its rays.
#pragma once

#include "specular_cells.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace etendue::eval {

// Of each side, as SideBlock has them. `low`: it reaches the horizon's layer (1, else 0), `rim`: it reaches the place where slopes are 1;
// n.l at both ends and how it rises from there, along all of the side.
struct SideEnds {
  enum { low, rim, height_begin, slope_begin, height_end, slope_end, numbers };
  std::array<std::array<float, most_sides * points_at_once>, numbers> side;
};
// `negligible`: part of the light that no cell is laid out for.
void find_ends(const SideBlock& block, float negligible, SideEnds& ends);

// Parts of sides: those of a block, which are at most 23 a side.
struct PartList {
  static constexpr std::size_t most = 23 * most_sides * points_at_once, longest_vector = 16;
  std::array<std::int32_t, most + longest_vector> point, side;  // indices into SideBlock
  std::array<float, most + longest_vector> x0, x1;
  // What is found: p on the outline in the middle; the largest n.l of both ends and the middle; n.l at the outer end of the ray that rises
  // most steeply inwards, and how, per part of the ray (0: none rises).
  std::array<float, most + longest_vector> p, highest, low, slope;
  std::size_t count = 0;

  void add(std::int32_t at_point, std::int32_t at_side, float from, float to) {
    point[count] = at_point, side[count] = at_side, x0[count] = from, x1[count] = to;
    ++count;
  }
};
void find_rays(const SideBlock& block, PartList& parts);

}  // namespace etendue::eval
