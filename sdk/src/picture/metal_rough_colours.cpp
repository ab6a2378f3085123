// Base colour, metal mask and dielectric f0 for two readers at once.
#include "metal_rough_colours.h"

#include <algorithm>

#include "best_masks.h"
#include "without_search.h"

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

void metal_rough_of_all(std::span<const ColourPair> pairs, double weight, std::vector<MetalRoughColours>& out) {
  out.resize(pairs.size());
  std::vector<ColourPair> open;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (const std::optional<double> mask = mask_without_search(pairs[i], weight)) {
      out[i] = metal_rough_of_held(*mask, pairs[i], weight);
      continue;
    }
    open.push_back(pairs[i]);
    places.push_back(i);
  }
  std::vector<MaskCost> masks(open.size());
  best_masks(open, weight, masks);
  for (std::size_t i = 0; i < open.size(); ++i) out[places[i]] = metal_rough_with(masks[i], open[i], weight);
}

}  // namespace etendue
