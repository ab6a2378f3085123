// Levenberg-Marquardt within bounds for the Disney parameters of two colours.
#include "etendue/material_fit.h"

#include "metal_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace etendue {
namespace {

constexpr std::size_t unknowns = 5, equations = 6;  // reflectance, metal, base colour; f0, diffuse
using Unknowns = std::array<double, unknowns>;

// The six differences, and their derivatives by the unknowns (listing D.1).
struct Linearised {
  std::array<double, equations> difference{};
  std::array<Unknowns, equations> jacobian{};
  double squares() const {
    double sum = 0;
    for (const double x : difference) sum += x * x;
    return sum;
  }
};

Linearised at(const Unknowns& x, const std::array<MetalProfile::Channel, 3>& channels) {
  const double r = x[0], m = x[1], s = 1 - m, dielectric = largest_dielectric_f0 * r * r;
  Linearised out;
  for (std::size_t c = 0; c < 3; ++c) {
    const double b = x[2 + c];
    out.difference[c] = dielectric * s + m * b - channels[c].f;
    out.jacobian[c][0] = 2 * largest_dielectric_f0 * r * s;
    out.jacobian[c][1] = b - dielectric;
    out.jacobian[c][2 + c] = m;
    out.difference[3 + c] = s * b - channels[c].d;
    out.jacobian[3 + c][1] = -b;
    out.jacobian[3 + c][2 + c] = s;
  }
  return out;
}

// Solves a x = b, a symmetric and positive definite, by Cholesky's factors.
Unknowns solved(std::array<Unknowns, unknowns> a, Unknowns b) {
  for (std::size_t i = 0; i < unknowns; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
      a[i][j] = i == j ? std::sqrt(std::max(sum, 1e-300)) : sum / a[j][j];
    }
  }
  for (std::size_t i = 0; i < unknowns; ++i) {
    for (std::size_t k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  for (std::size_t i = unknowns; i-- > 0;) {
    for (std::size_t k = i + 1; k < unknowns; ++k) b[i] -= a[k][i] * b[k];
    b[i] /= a[i][i];
  }
  return b;
}

// (J^T J + damping D) step = -J^T difference, D the diagonal, over the unknowns that are not at a bound which the slope pushes them
// against.
Unknowns step_of(const Linearised& here, const Unknowns& x, double damping) {
  Unknowns slope{};
  std::array<Unknowns, unknowns> normal{};
  for (std::size_t e = 0; e < equations; ++e)
    for (std::size_t i = 0; i < unknowns; ++i) {
      slope[i] += here.jacobian[e][i] * here.difference[e];
      for (std::size_t j = 0; j < unknowns; ++j) normal[i][j] += here.jacobian[e][i] * here.jacobian[e][j];
    }
  for (std::size_t i = 0; i < unknowns; ++i) {
    if ((x[i] <= 0 && slope[i] > 0) || (x[i] >= 1 && slope[i] < 0)) {
      for (std::size_t j = 0; j < unknowns; ++j) normal[i][j] = normal[j][i] = 0;
      normal[i][i] = 1, slope[i] = 0;
    }
    normal[i][i] += damping * std::max(normal[i][i], 1e-9);
  }
  for (double& g : slope) g = -g;
  return solved(normal, slope);
}

}  // namespace

LocalFit fit_disney_from(const DisneyColours& start, const ColourPair& pair) {
  const auto channels = MetalProfile::channels_of(pair);
  const auto within = [](double value) { return std::clamp(MetalProfile::held(value), 0.0, 1.0); };
  Unknowns x{within(start.reflectance), within(start.metal), within(start.base_colour.x), within(start.base_colour.y),
             within(start.base_colour.z)};
  Linearised here = at(x, channels);
  double damping = 1e-3;
  constexpr int most_steps = 200;
  constexpr double heaviest = 1e10, settled = 1e-15;
  int steps = 0;
  for (; steps < most_steps && damping < heaviest; ++steps) {
    const Unknowns step = step_of(here, x, damping);
    Unknowns next;
    for (std::size_t i = 0; i < unknowns; ++i) next[i] = std::clamp(x[i] + step[i], 0.0, 1.0);
    const Linearised there = at(next, channels);
    const double before = here.squares(), after = there.squares();
    if (!(after < before)) {
      damping *= 8;
      continue;
    }
    x = next, here = there, damping = std::max(damping / 8, 1e-12);
    if (before - after <= settled * before) break;
  }
  return {{{x[2], x[3], x[4]}, x[1], x[0]}, here.squares(), steps};
}

}  // namespace etendue
