// A pixel that more than one thing, or a shadow's edge, shares: its regions by area, found along scanlines inside the pixel.
#pragma once

#include "probe.h"

#include <cstdint>
#include <vector>

namespace etendue::rendering {

// A place in the picture that stands for a part of the pixel.
struct Node {
  double x = 0, y = 0;
  double weight = 0;         // area in pixels
  std::uint32_t region = 0;  // nodes of one region share its number
};

// The weights sum to 1. `area_error`: estimate for the area of any region, in pixels.
struct Regions {
  std::vector<Node> nodes;
  double area_error = 0;
};
// `tolerance`: of the areas, in pixels. `seed`: of the places within regions whose shading varies.
Regions regions_of(const Prober& prober, const Stage& stage, std::uint32_t x, std::uint32_t y, double tolerance, std::uint64_t seed,
                   RayCounts& counts);

}  // namespace etendue::rendering
