// Where first cells of a block of points end, in vectors: what each side, and each part of a side, says of the layers along its rays.
#pragma once

#include "specular_cells.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace etendue::eval {

// Of each side, as SideBlock has them. `low`: it reaches the horizon's layer (1, else 0), `rim`: it reaches the place where slopes are 1;
// n.l at both ends and how it rises from there, along all of the side.
struct SideEnds {
  enum { low, rim, height_begin, slope_begin, height_end, slope_end, numbers };
  std::array<std::vector<float>, numbers> side;
};
// Of the first `count` points. `negligible`: part of the light that no cell is laid out for.
void find_ends(const SideBlock& block, std::size_t count, float negligible, SideEnds& ends);

// Parts of sides: those of a block.
struct PartList {
  static constexpr std::size_t most = 8192, longest_vector = 16;
  std::array<std::int32_t, most + longest_vector> point, side;  // indices into SideBlock
  std::array<float, most + longest_vector> origin, x0, x1;      // SpanOfX
  // What is found: 1 - p on the outline in the middle; the largest n.l of both ends and the middle; n.l at the outer end of the ray that
  // rises most steeply inwards, and how, per part of the ray (0: none rises).
  std::array<float, most + longest_vector> u, highest, low, slope;
  std::size_t count = 0;
  bool full = false;  // and parts are missing

  void clear() { count = 0, full = false; }
  void add(std::int32_t at_point, std::int32_t at_side, const SpanOfX& x) {
    if (count == most) {
      full = true;
      return;
    }
    point[count] = at_point, side[count] = at_side, origin[count] = x.origin, x0[count] = x.from, x1[count] = x.to;
    ++count;
  }
};
void find_rays(const SideBlock& block, PartList& parts);

}  // namespace etendue::eval
