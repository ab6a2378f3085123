// Sides of lights and cells of lobe_cells.h for many points: what those that lay them out (specular_outline.h, specular_first_cells.h), the
// kernel of specular_cells_batch.cpp and specular_within_batch.cpp share.
#pragma once

#include "etendue/specular_batch.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace etendue::eval {

inline constexpr std::size_t points_at_once = 64;

// Points of a block: position, normal and view, three numbers each, and alpha.
struct PlaceBlock {
  alignas(64) std::array<std::array<double, points_at_once>, 10> numbers;
};

// Sides of the lights of a block as arcs about the place tau = 0 where they are nearest to the middle of the lobe (lobe_cells.h). With
// q = (x, y) / z, x = x0 + x1 tau + x2 tau^2 and so on, and q x dq/dtau = (turn0 + turn1 tau + turn2 tau^2) / z^2. `begin` and `end` are
// tau there, and the same of a side that is not seen. `lowest`: n.l of its lower end; `rim`: 1 - p of the end that is farther out.
// The rim of a disk is a circle in space, b = c + u cos s + v sin s of any length. b (1 + tau^2) is a quadratic, and so is b^2 (1 + tau^2)
// but for another 1 + tau^2: of h' = v |b| + b, times 1 + tau^2, the first part is v times a root of the fourth degree. It is W + r,
//     W = w0 + w1 tau + w2 tau^2,   r = tau^3 (w3 + w4 tau) / (sqrt(W^2 + tau^3 (w3 + w4 tau)) + W),
// so that v W and b, whose difference is small where the lobe is, are one quadratic as above, and to q x dq/dtau is added what
// specular_curve-inl.h says.
struct SideBlock {
  enum OfSide { x0, x1, x2, y0, y1, y2, z0, z1, z2, turn0, turn1, turn2, kappa, begin, end, lowest, rim, w0, w1, w2, w3, w4, side_numbers };
  // G / (4 n.v n.l) = 1 / (2 (of_height n.l + of_root S(n.l))).
  enum OfPoint { alpha, view_x, view_z, of_height, of_root, base, rest, level, level_risen, floor, doubt, point_numbers };
  // Those of a block: `sides` for each place of a point, one side of all points after the other; from `first_horizon` on along the horizon.
  std::size_t sides = 0, first_horizon = 0;
  bool rims = false;  // w0 to w4 are there
  std::array<std::vector<float>, side_numbers> side;
  std::array<std::array<float, points_at_once>, point_numbers> point;

  void make_room(std::size_t along_light, std::size_t along_horizon, bool of_rims) {
    sides = along_light + along_horizon, first_horizon = along_light, rims = of_rims;
    for (std::size_t k = 0; k < (rims ? side_numbers : w0); ++k) side[k].resize(sides * points_at_once);
  }
};

// A part of a side from one x to another, tau = kappa x / (1 - x^2), |x| < 1. A long side passes the lobe within some 1e-6 of its ends,
// which floats about 1 do not tell apart: x is told from `origin`, -1, 0 or 1.
struct SpanOfX {
  float origin, from, to;
};
inline SpanOfX span_of_x(double from, double to) {
  const double origin = from >= 0.5 ? 1 : to <= -0.5 ? -1 : 0;
  return {static_cast<float>(origin), static_cast<float>(from - origin), static_cast<float>(to - origin)};
}

// Cells of a round, one after the other, those of a point together.
struct CellList {
  static constexpr std::size_t most = 16384, longest_vector = 16;
  std::array<std::int32_t, most> point, side;                               // indices into SideBlock
  std::array<float, most> origin, x0, x1, t0, t1;                           // SpanOfX
  std::array<float, most> shape, risen, shape_error, risen_error, along_t;  // what they measure
  std::size_t count = 0;
  bool full = false;  // and cells are missing

  void clear() { count = 0; }
  void add(std::int32_t p, std::int32_t s, const SpanOfX& x, float ta, float tb) {
    point[count] = p, side[count] = s, origin[count] = x.origin, x0[count] = x.from, x1[count] = x.to, t0[count] = ta, t1[count] = tb;
    if (count + 1 < most - longest_vector) {
      ++count;
    } else {
      full = true;
    }
  }
  // Up to a whole vector: cells of no size.
  void fill_up() {
    for (std::size_t i = count; i < count + longest_vector; ++i)
      point[i] = point[count - 1], side[i] = side[count - 1], origin[i] = x0[i] = x1[i] = t0[i] = 0, t1[i] = 1;
  }
};

// What a rule for the tolerance says of every cell.
void measure(const SideBlock& block, double tolerance, CellList& cells);

}  // namespace etendue::eval
