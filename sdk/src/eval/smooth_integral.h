// Integrals to rounding of functions whose only poles are beside one place.
#pragma once

#include "quadrature.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {

// add(x, weight) at the nodes of an integral from begin to end, begin < end, of f, whose poles on the complex plane are at
// peak +- i width or farther from `peak` than twice (end - peak) is. With x = peak + width sinh(w) they are pi / 2 away from all w, and
// over a piece no longer than 4 Gauss and Legendre's rule of 24 nodes leaves (pi / 4 + sqrt((pi / 4)^2 + 1))^-48 = 1e-15. A function that
// grows as x^steepest grows along the ellipse around the piece on which that bound stands: pieces are shorter in proportion.
template <class Add>
void smooth_integral(double begin, double end, double peak, double width, double steepest, Add add) {
  const double w0 = std::asinh((begin - peak) / width), w1 = std::asinh((end - peak) / width);
  const double longest = std::min(3.0, 12 / steepest);
  const int pieces = std::max(1, static_cast<int>(std::ceil((w1 - w0) / longest)));
  const double half = 0.5 * (w1 - w0) / pieces;
  for (int i = 0; i < pieces; ++i) {
    for (const GaussNode& node : gauss24()) {
      const double w = w0 + half * (2 * i + 1 + node.x);
      add(std::clamp(peak + width * std::sinh(w), begin, end), half * node.weight * width * std::cosh(w));
    }
  }
}

}  // namespace etendue::eval
