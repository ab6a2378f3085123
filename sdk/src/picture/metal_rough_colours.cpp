// Base colour, metal mask and dielectric f0 for two readers at once.
#include "metal_rough_colours.h"

#include <algorithm>
#include <span>

#include "best_masks.h"

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

MetalRoughColours metal_rough_of(const ColourPair& given, double weight) {
  const ColourPair pair = held(given);
  MaskCost best;
  best_masks(std::span(&pair, 1), weight, std::span(&best, 1));
  return metal_rough_with(best, pair, weight);
}

MetalRoughColours metal_rough_with(const MaskCost& best, const ColourPair& pair, double weight) {
  for (const double binary : {0.0, 1.0}) {
    const MetalRoughColours colours = metal_rough_of_held(binary, pair, weight);
    if (costs_of_held(colours, pair).sum(weight) <= best.cost + equal_costs) return colours;
  }
  return metal_rough_of_held(best.metal, pair, weight);
}

}  // namespace etendue
