// Sides of lights and cells of lobe_cells.h for many points: what the kernels of specular_cells_batch.cpp and specular_within_batch.cpp
// share.
#pragma once

#include "etendue/specular_batch.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace etendue::eval {

struct RectWithin {
  std::array<Vec3d, 4> corners;  // counter-clockwise about the directions between them, as seen from the front
  Vec3d normal;
  bool two_sided;
  bool separable = false;  // masking; else height-correlated
  double least = 0;        // of the floor below which errors are not relative to the value
};

inline constexpr std::size_t points_at_once = 64, most_sides = 5;

// Points of a block: position, normal and view, three numbers each, and alpha.
struct PlaceBlock {
  alignas(64) std::array<std::array<double, points_at_once>, 10> numbers;
};

// Sides of the lights of a block as arcs about the place tau = 0 where they are nearest to the middle of the lobe (lobe_cells.h). With
// q = (x, y) / z, x = x0 + x1 tau + x2 tau^2 and so on, and q x dq/dtau = (turn0 + turn1 tau + turn2 tau^2) / z^2. A side that is not seen
// has begin = end. `lowest`: n.l of its lower end; `rim`: 1 - p of the end that is farther out.
struct SideBlock {
  enum OfSide { x0, x1, x2, y0, y1, y2, z0, z1, z2, turn0, turn1, turn2, kappa, begin, end, lowest, rim, side_numbers };
  // G / (4 n.v n.l) = 1 / (2 (of_height n.l + of_root S(n.l))).
  enum OfPoint { alpha, view_x, view_z, of_height, of_root, base, rest, level, level_risen, floor, doubt, point_numbers };
  std::array<std::array<float, most_sides * points_at_once>, side_numbers> side;
  std::array<std::array<float, points_at_once>, point_numbers> point;
};

// Cells of a round, one after the other, those of a point together.
struct CellList {
  static constexpr std::size_t most = 16384, longest_vector = 16;
  std::array<std::int32_t, most> point, side;  // indices into SideBlock
  std::array<float, most> x0, x1, t0, t1;
  std::array<float, most> shape, risen, shape_error, risen_error, along_t;  // what they measure
  std::size_t count = 0;
  bool full = false;  // and cells are missing

  void clear() { count = 0; }
  void add(std::int32_t p, std::int32_t s, float xa, float xb, float ta, float tb) {
    point[count] = p, side[count] = s, x0[count] = xa, x1[count] = xb, t0[count] = ta, t1[count] = tb;
    if (count + 1 < most - longest_vector) {
      ++count;
    } else {
      full = true;
    }
  }
  // Up to a whole vector: cells of no size.
  void fill_up() {
    for (std::size_t i = count; i < count + longest_vector; ++i)
      point[i] = point[count - 1], side[i] = side[count - 1], x0[i] = x1[i] = t0[i] = 0, t1[i] = 1;
  }
};

// The sides of the first `count` points. What stands beyond them is laid out too.
void lay_sides(const RectWithin& light, const PlaceBlock& places, std::size_t count, SideBlock& block);
// What a rule for the tolerance says of every cell.
void measure(const SideBlock& block, double tolerance, CellList& cells);

}  // namespace etendue::eval
