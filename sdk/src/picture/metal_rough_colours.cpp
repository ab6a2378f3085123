// Base colour, metal mask and dielectric f0 for two readers at once.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "etendue/material_conversion.h"

namespace etendue {
namespace {

constexpr double core_f0 = 0.04;
constexpr double weight_of_full = 1000;
constexpr double as_good = 6e-8;  // 6 x (1e-4)^2

double squared(const ColourPair& a, const ColourPair& b) {
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    const double diffuse = a.diffuse[c] - b.diffuse[c], f0 = a.f0[c] - b.f0[c];
    sum += diffuse * diffuse + f0 * f0;
  }
  return sum;
}

// fit_disney's rule: within the range of half floats, NaN counts as 0.
double held(double x) { return std::isnan(x) ? 0 : std::clamp(x, -65504.0, 65504.0); }
ColourPair held(const ColourPair& pair) {
  ColourPair out;
  for (int c = 0; c < 3; ++c) out.diffuse[c] = held(pair.diffuse[c]), out.f0[c] = held(pair.f0[c]);
  return out;
}

ColourPair pair_with(const MetalRoughColours& m, const Rgb& k) { return {m.base * (1 - m.metal), k * (1 - m.metal) + m.base * m.metal}; }

// In a full reader f0 is exact where 0 <= k = (f - m b) / (1 - m). With the diffuse colour exact too, b = d / (1 - m), that is
// d m / (1 - m) <= f: m / (1 - m) <= f / d in each channel.
double largest_exact_metal(const ColourPair& pair) {
  double ratio = std::numeric_limits<double>::infinity();
  for (int c = 0; c < 3; ++c)
    if (pair.diffuse[c] > 0) ratio = std::min(ratio, std::max(pair.f0[c], 0.0) / pair.diffuse[c]);
  return ratio < std::numeric_limits<double>::infinity() ? ratio / (1 + ratio) : 1;
}

}  // namespace

double metal_rough_cost(const MetalRoughColours& colours, const ColourPair& pair) {
  return squared(in_core_reader(colours), pair) + weight_of_full * squared(in_full_reader(colours), pair);
}

ColourPair in_core_reader(const MetalRoughColours& colours) { return pair_with(colours, {core_f0, core_f0, core_f0}); }
ColourPair in_full_reader(const MetalRoughColours& colours) { return pair_with(colours, colours.dielectric_f0); }

// For a given m each channel stands alone. Where k is free the full reader's f0 is exact, and what is left is
//   (1 + w) ((1 - m) b - d)^2 + (m b - g)^2,  g = f - .04 (1 - m),  w = 1000,
// a parabola in b. Where its least b asks for a k = (f - m b) / (1 - m) below 0 or above 1, k stands at that end and f0's difference in the
// full reader comes in: + w (m b - (f - (1 - m) k))^2. The least over k is convex in b, so that b is held within [0, 1] by clamping.
MetalRoughColours metal_rough_at(double metal, const ColourPair& given) {
  const ColourPair pair = held(given);
  MetalRoughColours out;
  const double m = out.metal = std::clamp(held(metal), 0.0, 1.0), left = 1 - m, w = weight_of_full;
  for (int c = 0; c < 3; ++c) {
    const double d = pair.diffuse[c], f = pair.f0[c];
    const double towards = (1 + w) * left * d + m * (f - core_f0 * left), across = (1 + w) * left * left + m * m;
    const double base = towards / across, k = left > 0 ? (f - m * base) / left : f - m * base;
    const double end = k > 0 ? 1 : 0, bound = k < 0 || k > 1 || left == 0 ? w : 0;
    out.base[c] = std::clamp((towards + bound * m * (f - left * end)) / (across + bound * m * m), 0.0, 1.0);
    out.dielectric_f0[c] = left > 0 ? std::clamp((f - m * out.base[c]) / left, 0.0, 1.0) : core_f0;
  }
  return out;
}

MetalRoughColours metal_rough_of(const ColourPair& given) {
  const ColourPair pair = held(given);
  const double core = fit_disney(pair, DielectricF0::core).value.metal;
  const std::array<double, 4> masks{0, 1, core, std::min(core, largest_exact_metal(pair))};
  std::array<MetalRoughColours, 4> found;
  std::array<double, 4> costs{};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < masks.size(); ++i) {
    found[i] = metal_rough_at(masks[i], pair);
    costs[i] = metal_rough_cost(found[i], pair);
    least = std::min(least, costs[i]);
  }
  const auto first = std::find_if(costs.begin(), costs.end(), [&](double c) { return c <= least + as_good; });
  return found[static_cast<std::size_t>(first - costs.begin())];
}

}  // namespace etendue
