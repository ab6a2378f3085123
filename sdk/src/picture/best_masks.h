// The metal masks that metal_rough_of() searches, of many pairs of colours at once.
#pragma once

#include "etendue/material_conversion.h"

#include <span>

namespace etendue {

// What a mask costs (metal_rough_cost) with the best base colour and dielectric f0.
struct MaskCost {
  double metal = 0, cost = 0;
};

// Of as many pairs as there are places in `out`, their numbers held() (metal_rough_colours.h). The same bits on every instruction set.
void best_masks(std::span<const ColourPair> pairs, double weight, std::span<MaskCost> out);

}  // namespace etendue
