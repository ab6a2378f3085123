// Gauss and Legendre's rules, and what they can tell of the highest degrees.
#pragma once

#include "etendue/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace etendue::eval {

// P_n(x) and P_{n-1}(x), Legendre's, by their recurrence.
struct Legendre {
  double last, before;
};
inline Legendre legendre(std::size_t n, double x) {
  Legendre p{n == 0 ? 1 : x, 1};
  for (std::size_t k = 2; k <= n; ++k) {
    const auto degree = static_cast<double>(k);
    p = {((2 * degree - 1) * x * p.last - (degree - 1) * p.before) / degree, p.last};
  }
  return p;
}

// The rule on [0, 1]. high[i][k] is 2 d + 1 times P_d there, d = N - 1 - k: sums of weighted values with them are the
// coefficients of the highest degrees that the rule can tell (0 where it has fewer), in the same unit as the sum of the weighted values
// itself.
inline constexpr std::size_t told = 4;
template <std::size_t N>
struct Gauss {
  std::array<double, N> x{}, weight{};
  std::array<std::array<double, told>, N> high{};
  Gauss() {
    constexpr double n = N;
    for (std::size_t i = 0; i < N; ++i) {
      // Newton's steps from Tricomi's first guess at a zero; P_n' = n (x P_n - P_{n-1}) / (x^2 - 1).
      double at = std::cos(pi * (static_cast<double>(i) + 0.75) / (n + 0.5)), slope = 1;
      for (int turn = 0; turn < 6; ++turn) {
        const Legendre p = legendre(N, at);
        slope = n * (at * p.last - p.before) / (at * at - 1);
        at -= p.last / slope;
      }
      x[i] = 0.5 * (1 + at);
      weight[i] = 1 / ((1 - at * at) * slope * slope);
      for (std::size_t k = 0; k < std::min(told, N); ++k)
        high[i][k] = (2 * static_cast<double>(N - 1 - k) + 1) * legendre(N - 1 - k, at).last;
    }
  }
};

template <std::size_t N>
const Gauss<N>& gauss() {
  static const Gauss<N> rule;
  return rule;
}

}  // namespace etendue::eval
