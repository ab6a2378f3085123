// Levenberg's and Marquardt's descent for a few unknowns.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace etendue::eval {

inline double sum_of_squares(const std::vector<double>& r) { return std::inner_product(r.begin(), r.end(), r.begin(), 0.0); }

// Gauss's elimination; the matrix, whose last column is the right side, is positive definite once its diagonal is raised.
template <std::size_t N>
std::array<double, N> damped_step(std::array<std::array<double, N + 1>, N> m, double damping) {
  for (std::size_t i = 0; i < N; ++i) m[i][i] += damping * m[i][i] + 1e-12;
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = i + 1; j < N; ++j) {
      const double factor = m[j][i] / m[i][i];
      for (std::size_t k = i; k <= N; ++k) m[j][k] -= factor * m[i][k];
    }
  }
  std::array<double, N> x{};
  for (std::size_t i = N; i-- > 0;) {
    x[i] = m[i][N];
    for (std::size_t k = i + 1; k < N; ++k) x[i] -= m[i][k] * x[k];
    x[i] /= m[i][i];
  }
  return x;
}

// Makes the sum of the squares of residuals(p), of which there are always as many, smaller until a step takes less than `enough` of it or
// `rounds` are over; returns it. The curvature is that of the residuals' slopes, by steps of 1e-6, its diagonal raised until a step goes
// down.
template <std::size_t N, class Residuals>
double descend(std::array<double, N>& p, const Residuals& residuals, int rounds, double enough) {
  std::vector<double> r = residuals(p);
  double best = sum_of_squares(r), damping = 1e-3;
  constexpr double most_damping = 1e8, step = 1e-6;
  for (int round = 0; round < rounds && damping < most_damping; ++round) {
    std::array<std::vector<double>, N> slope;
    for (std::size_t i = 0; i < N; ++i) {
      std::array<double, N> there = p;
      there[i] += step;
      slope[i] = residuals(there);
      for (std::size_t k = 0; k < r.size(); ++k) slope[i][k] = (slope[i][k] - r[k]) / step;
    }
    std::array<std::array<double, N + 1>, N> normal{};
    for (std::size_t i = 0; i < N; ++i) {
      for (std::size_t j = 0; j < N; ++j) normal[i][j] = std::inner_product(slope[i].begin(), slope[i].end(), slope[j].begin(), 0.0);
      normal[i][N] = -std::inner_product(slope[i].begin(), slope[i].end(), r.begin(), 0.0);
    }
    bool done = true;
    while (damping < most_damping) {
      std::array<double, N> next = p;
      const std::array<double, N> by = damped_step<N>(normal, damping);
      for (std::size_t i = 0; i < N; ++i) next[i] += by[i];
      std::vector<double> there = residuals(next);
      const double value = sum_of_squares(there);
      if (!(value < best)) {
        damping *= 10;
        continue;
      }
      done = best - value < enough * best;
      p = next, r = std::move(there), best = value, damping *= 0.1;
      break;
    }
    if (done) break;
  }
  return best;
}

}  // namespace etendue::eval
