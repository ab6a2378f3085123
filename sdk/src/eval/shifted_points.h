// Points of the unit square for integrals by sampling, and what their scatter says of the error.
#pragma once

#include "etendue/vec.h"

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue::eval {

// SplitMix64 (Steele et al. 2014): the state's successor, mixed.
inline std::uint64_t mixed_successor(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15u;
  std::uint64_t z = state;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

// A Kronecker sequence (multiples of 1 / g and 1 / g^2, g^3 = g + 1, g = 1.3247...), shifted at random: the mean over each shift is an
// unbiased estimate of an integral, independent of the others'.
class ShiftedPoints {
 public:
  ShiftedPoints(std::size_t shifts, std::uint64_t seed) {
    const auto uniform = [&] { return static_cast<double>(mixed_successor(seed) >> 11) * 0x1p-53; };
    for (std::size_t i = 0; i < shifts; ++i) {
      const double x = uniform();
      shifts_.push_back({x, uniform()});
    }
  }
  Vec2d operator()(std::size_t shift, std::uint64_t index) const {
    const auto fraction = [](double x) { return x - std::floor(x); };
    const auto i = static_cast<double>(index);
    return {fraction(shifts_[shift].x + i * 0.7548776662466927), fraction(shifts_[shift].y + i * 0.5698402909980532)};
  }

 private:
  std::vector<Vec2d> shifts_;
};

// The mean of independent estimates and its standard deviation, from their scatter: (mean - truth) / deviation has a t-distribution of one
// degree of freedom less than there are estimates, as far as each is normal.
struct ScatteredMean {
  Rgb value, deviation;
};
inline ScatteredMean mean_of(std::span<const Rgb> estimates) {
  ScatteredMean mean;
  const auto n = static_cast<double>(estimates.size());
  for (int c = 0; c < 3; ++c) {
    double square = 0;
    for (const Rgb& e : estimates) mean.value[c] += e[c] / n;
    for (const Rgb& e : estimates) square += (e[c] - mean.value[c]) * (e[c] - mean.value[c]);
    mean.deviation[c] = std::sqrt(square / (n * (n - 1)));
  }
  return mean;
}

}  // namespace etendue::eval
