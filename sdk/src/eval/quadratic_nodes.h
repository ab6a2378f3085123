// Polynomials of second degree by their values at Gauss and Legendre's three places in [-1, 1].
#pragma once

#include <array>

namespace etendue::eval {

inline constexpr std::array<double, 3> quadratic_nodes{-0.7745966692414834, 0.0, 0.7745966692414834};  // +-sqrt(3 / 5)

// At t the three that are 1 at one of the places and 0 at the others.
constexpr std::array<double, 3> quadratics(double t) {
  constexpr double over = 5.0 / 6, root = quadratic_nodes[2];
  return {over * t * (t - root), 1 - 2 * over * t * t, over * t * (t + root)};
}

}  // namespace etendue::eval
