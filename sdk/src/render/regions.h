// A pixel that more than one thing, or a shadow's edge, shares: its regions by area, found along scanlines inside the pixel.
#pragma once

#include "probe.h"

#include <cstdint>
#include <vector>

namespace etendue::rendering {

// A place inside the pixel that stands for a part of it.
struct Node {
  float x = 0, y = 0;        // from the pixel's upper left corner
  float weight = 0;          // area in pixels
  std::uint32_t region = 0;  // nodes of one region share its number
};

// What a region shows. A textured one has places chosen at random, one that only turns has such in `coarse`.
struct SurfaceKind {
  bool varies = false;  // one place cannot stand for all
  bool textured = false;
};

// The weights of either list sum to 1. `area_error`: estimate for the area of any region, in pixels.
struct Regions {
  std::vector<Node> nodes;           // along all scanlines: quadratic variation is integrated exactly along them
  std::vector<Node> kinked;          // for light that fades towards its plane, where that cuts the pixel: see kinks_of(); else empty
  std::vector<Node> coarse;          // one a region, at its centroid (exact where light varies linearly); several where the surface varies
  std::vector<SurfaceKind> kinds;    // by region
  std::vector<std::uint32_t> kinks;  // lights whose plane cuts the pixel, by StageLight::index
  double area_error = 0;
  bool only_lambert = true;  // what is seen is matt, black or a light
};
// `tolerance`: of the areas, in pixels. `seed`: of the places within regions whose shading varies.
Regions regions_of(const Prober& prober, const Stage& stage, std::uint32_t x, std::uint32_t y, double tolerance, std::uint64_t seed,
                   RayCounts& counts);

}  // namespace etendue::rendering
