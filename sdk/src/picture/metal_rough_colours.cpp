// Base colour, metal mask and dielectric f0 for two readers at once.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "etendue/material_conversion.h"
#include "metal_rough_colours.h"

namespace etendue {
namespace {

ColourPair pair_with(const MetalRoughColours& m, const Rgb& k) { return {m.base * (1 - m.metal), k * (1 - m.metal) + m.base * m.metal}; }

}  // namespace

double metal_rough_cost(const MetalRoughColours& colours, const ColourPair& pair, double weight) {
  return costs_of_held(colours, pair).sum(weight);
}

double full_reader_limit(int bits) { return bits == 8 ? 1e-3 : 1e-4; }

ColourPair in_core_reader(const MetalRoughColours& colours) { return pair_with(colours, {core_f0, core_f0, core_f0}); }
ColourPair in_full_reader(const MetalRoughColours& colours) { return pair_with(colours, colours.dielectric_f0); }

MetalRoughColours metal_rough_at(double metal, const ColourPair& pair, double weight) {
  return metal_rough_of_held(std::clamp(held(metal), 0.0, 1.0), held(pair), weight);
}

namespace {

// What a mask costs with the best base colour and dielectric f0.
struct MaskCost {
  double metal = 0, cost = std::numeric_limits<double>::infinity();
};

// Where a bound begins to hold. With s = 1 - m a full reader's b = d / s and k = (f - m b) / s are exact while b <= 1, that is s >= d; k >=
// 0, that is m <= f / (f + d); and k <= 1, that is s^2 - (f + d) s + d >= 0.
class Kinks {
 public:
  explicit Kinks(const ColourPair& pair) {
    for (int c = 0; c < 3; ++c) {
      const double d = pair.diffuse[c], f = pair.f0[c], half = (f + d) / 2, square = half * half - d;
      add(1 - d);
      if (f > 0 && d > 0) add(f / (f + d));
      if (square <= 0) continue;
      add(1 - half - std::sqrt(square));
      add(1 - half + std::sqrt(square));
    }
    std::sort(places_.begin(), places_.begin() + static_cast<std::ptrdiff_t>(count_));
  }
  std::span<const double> sorted() const { return std::span(places_).first(count_); }

 private:
  void add(double m) {
    if (m > 0 && m < 1) places_[count_++] = m;
  }
  std::array<double, 12> places_{};
  std::size_t count_ = 0;
};

// A function of m with several valleys, which a large weight makes narrow: from the best point of a grid, and from the best of the kinks
// and the middles between these, in steps that halve.
MaskCost best_mask(const ColourPair& pair, double weight) {
  const auto consider = [&](MaskCost& best, double m) {
    const double cost = least_cost_of_held(m, pair, weight);
    if (cost < best.cost) best = {m, cost};
  };
  const auto refine = [&](MaskCost& best, double width) {
    for (int halving = 0; halving < 12; ++halving, width /= 2) {
      const double at = best.metal;
      consider(best, std::max(at - width, 0.0));
      consider(best, std::min(at + width, 1.0));
    }
  };
  MaskCost best, of_kinks;
  constexpr int steps = 20;
  for (int i = 0; i <= steps; ++i) consider(best, static_cast<double>(i) / steps);
  double last = 0, widest = 0;
  const Kinks kinks(pair);
  for (const double kink : kinks.sorted()) {
    consider(of_kinks, kink);
    consider(of_kinks, (last + kink) / 2);
    widest = std::max(widest, kink - last);
    last = kink;
  }
  refine(best, 0.5 / steps);
  if (of_kinks.cost < std::numeric_limits<double>::infinity()) refine(of_kinks, std::min(widest / 4, 0.5 / steps));
  return of_kinks.cost < best.cost ? of_kinks : best;
}

}  // namespace

MetalRoughColours metal_rough_of(const ColourPair& given, double weight) {
  const ColourPair pair = held(given);
  const MaskCost best = best_mask(pair, weight);
  for (const double binary : {0.0, 1.0}) {
    const MetalRoughColours colours = metal_rough_at(binary, pair, weight);
    if (metal_rough_cost(colours, pair, weight) <= best.cost + equal_costs) return colours;
  }
  return metal_rough_at(best.metal, pair, weight);
}

}  // namespace etendue
