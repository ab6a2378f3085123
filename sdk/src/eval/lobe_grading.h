// Where cells of lobe_cells.h end because their integrand bends. Derivations: sdk/docs/specular.md, "To a tolerance".
#pragma once

#include <algorithm>
#include <cmath>

namespace etendue::eval {

// In the middle; where one end is much nearer to the rim than the other in the mean of the distances' orders.
template <class T>
T split_towards_rim(T from, T to, T rim) {
  if (to < 0) return -split_towards_rim(-to, -from, rim);
  const T far = rim - from, near = rim - to;
  return from < 0 || !(near < T(0.2) * far) ? T(0.5) * (from + to) : rim - std::max(std::sqrt(far * near), T(0.05) * far);
}

// W bends where the slopes m = alpha q are about 1, alpha away from the rim p = 1: cells of a ray that reach it are made smaller towards
// it, from `from` to `to` away, as long as what is beyond, its area times what W differs there (alpha / distance), is not negligible.
template <class T, class Mark>
void grade_rim(T alpha, T from, T to, T negligible, double tolerance, const Mark& mark) {
  if (!(alpha > T(0.05) * to)) return;
  const T end = std::max(to, T(0.1) * alpha), closer = tolerance >= 5e-4 ? T(0.0625) : T(0.25);
  T at = from;
  while (at > 5 * end && at * std::min(alpha, at) > negligible * from * from) mark(at *= closer);
}

// Masking bends within `layer`, min(alpha, n.v), of the horizon, which a rule does not see that has no node there: heights above it that
// bound cells, from the lowest below which there is something. An outline along the horizon has a layer there, any other, which only ends
// there, the square of it.
template <class T, class Mark>
void grade_heights(T layer, T negligible, T lowest, T highest, bool along, const Mark& mark) {
  T height = std::max(2 * layer, highest * (along ? negligible : std::sqrt(negligible)));
  if (lowest > height) return;
  while (height < T(0.5) * highest) {
    mark(height);
    height *= 4;
  }
}

}  // namespace etendue::eval
