// What metal_rough_of() is made of.
#pragma once

#include "etendue/material_conversion.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace etendue {

inline constexpr double core_f0 = 0.04;

// Two costs (metal_rough_cost) that differ by less count as equal: 6 times the square of an rms of 1e-4.
inline constexpr double equal_costs = 6e-8;

// fit_disney's rule: within the range of half floats, NaN counts as 0. What follows takes numbers that are so already.
inline double held(double x) { return std::isnan(x) ? 0 : std::clamp(x, -65504.0, 65504.0); }
inline ColourPair held(const ColourPair& pair) {
  ColourPair out;
  for (int c = 0; c < 3; ++c) out.diffuse[c] = held(pair.diffuse[c]), out.f0[c] = held(pair.f0[c]);
  return out;
}

// For a given m each channel stands alone. Where k is free the full reader's f0 is exact, and what is left is
//   (1 + w) ((1 - m) b - d)^2 + (m b - g)^2,  g = f - .04 (1 - m),  w the weight,
// a parabola in b. Where its least b asks for a k = (f - m b) / (1 - m) below 0 or above 1, k stands at that end and f0's difference in the
// full reader comes in: + w (m b - (f - (1 - m) k))^2. The least over k is convex in b, so that b is held within [0, 1] by clamping.
inline MetalRoughColours metal_rough_of_held(double m, const ColourPair& pair, double w) {
  MetalRoughColours out;
  out.metal = m;
  const double left = 1 - m, across = (1 + w) * left * left + m * m, per_left = left > 0 ? 1 / left : 1;
  for (int c = 0; c < 3; ++c) {
    const double d = pair.diffuse[c], f = pair.f0[c];
    const double towards = (1 + w) * left * d + m * (f - core_f0 * left);
    double base = towards / across;
    const double k = (f - m * base) * per_left;
    if (k < 0 || k > 1 || left == 0) base = (towards + w * m * (f - (k > 0 ? left : 0))) / (across + w * m * m);
    out.base[c] = std::clamp(base, 0.0, 1.0);
    out.dielectric_f0[c] = left > 0 ? std::clamp((f - m * out.base[c]) / left, 0.0, 1.0) : core_f0;
  }
  return out;
}

// E_core and E_full of metal_rough_cost().
struct ReaderCosts {
  double core = 0, full = 0;
  double sum(double weight) const { return core + weight * full; }
};
inline ReaderCosts costs_of_held(const MetalRoughColours& colours, const ColourPair& pair) {
  const double m = colours.metal, left = 1 - m;
  double core = 0, full = 0, diffuse = 0;
  for (int c = 0; c < 3; ++c) {
    const double d = left * colours.base[c] - pair.diffuse[c], rest = m * colours.base[c] - pair.f0[c];
    const double in_core = left * core_f0 + rest, in_full = left * colours.dielectric_f0[c] + rest;
    diffuse += d * d, core += in_core * in_core, full += in_full * in_full;
  }
  return {diffuse + core, diffuse + full};
}

// metal_rough_of() of a pair that is held, whose best mask is known.
struct MaskCost;
MetalRoughColours metal_rough_with(const MaskCost& best, const ColourPair& pair, double weight);

// metal_rough_of() of pairs that are held; searched together where a search is needed.
void metal_rough_of_all(std::span<const ColourPair> pairs, double weight, std::vector<MetalRoughColours>& out);

}  // namespace etendue
