// W at many places of the disk at once, in vectors.
#pragma once

#include "lobe_cells.h"

#include <array>
#include <cstddef>

namespace etendue::eval {

// Places of a cell one after the other: p = ratio |q| on the ray through q. What stands beyond `count` up to a whole vector is evaluated
// too.
struct LobeNodes {
  static constexpr std::size_t most = 80, longest_vector = 8;
  alignas(64) std::array<double, most> ratio, q2, view_q;  // |q|^2; view.q
  alignas(64) std::array<double, most> factor;             // of ratio (1 - p^2) / (1 + p^2)^3
  std::size_t count;

  LobeNodes() : count(0) {}  // the arrays are written as far as they are read
  void add(double at_ratio, double at_q2, double at_view_q, double times) {
    ratio[count] = at_ratio, q2[count] = at_q2, view_q[count] = at_view_q, factor[count] = times;
    ++count;
  }
  void fill_up() {
    const std::size_t end = (count + longest_vector - 1) / longest_vector * longest_vector;
    for (std::size_t n = count; n < end; ++n) ratio[n] = q2[n] = view_q[n] = factor[n] = 0;
  }
};
// (1 - w) W / F - level.plain and w W / F - level.risen, times the factor and ratio (1 - p^2) / (1 + p^2)^3.
void evaluate(const DiskLobe& lobe, const Risen& level, LobeNodes& nodes, double* plain, double* risen);

}  // namespace etendue::eval
