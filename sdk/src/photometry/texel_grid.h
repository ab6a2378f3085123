// Where the texels of a baked web lie: from places to directions and back, what lies beyond a border, what a texel's tent integrates to.
#pragma once

#include "etendue/photometric_bake.h"

#include <cstddef>

namespace etendue::photometry {

class TexelGrid {
 public:
  TexelGrid(BakeLayout layout, std::uint32_t width, std::uint32_t height) : layout_(layout), width_(width), height_(height) {}

  // In texels: (0, 0) is the centre of the first texel of a picture's first row.
  struct Place {
    std::uint32_t picture = 0;
    double column = 0, row = 0;
  };
  Vec3d direction(const Place& place) const;  // unit
  Place place(const Vec3d& direction) const;

  // cd for a value of 1 at a place: 1, or 1 / cos^3 on a cube.
  double candelas_per_value(const Place& place) const;
  // lm for a value of 1 at one texel and 0 elsewhere.
  double weight(std::uint32_t column, std::uint32_t row) const;
  // Columns and rows between which the interpolant runs: -1/2 to width - 1/2, on a cube 0 to width - 1.
  double border() const { return layout_ == BakeLayout::cube ? 0 : 0.5; }

  double interpolated(std::span<const float> values, const Place& place) const;

 private:
  std::size_t texel(std::uint32_t picture, std::ptrdiff_t column, std::ptrdiff_t row) const;

  BakeLayout layout_;
  std::uint32_t width_, height_;
};

}  // namespace etendue::photometry
