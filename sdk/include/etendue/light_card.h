// Pictures on rectangular lights, ready to be integrated: means over halves, quarters, ... of their sides.
//   LightCardBuilder builder(width, height);  for each row: builder.add_row(rgba);
//   LightCard card = std::move(builder).finish();
//   CardEstimate light = by_patches(emitter, card, point, {0.01});
#pragma once

#include "etendue/eval.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace etendue::eval {

// A picture over [0, 1]^2 whose texels are joined bilinearly, those at the border up to it, as `sample` of picture.h does with Wrap::clamp.
// Level k has 2^k cells along u and v, u along rows; level 0 is the mean of all.
class LightCard {
 public:
  struct Cell {
    Vec3f mean;       // exact integral of the picture over the cell, over its area
    float deviation;  // root of the mean square from that, in the channel where it is largest; rather too high, by what texels join
  };
  // The finest level that is kept: 2^10 cells a side. What a larger picture has beyond is averaged.
  static constexpr int most_levels = 10;

  int finest() const { return static_cast<int>(levels_.size()) - 1; }
  const Cell& cell(int level, std::uint32_t x, std::uint32_t y) const {
    return levels_[static_cast<std::size_t>(level)][(std::size_t{y} << level) + x];
  }
  // Bilinear between the middles of a level's cells and linear between levels; 0 is the whole card. Outside, what is at the border.
  Rgb lookup(Vec2d uv, double level) const;

 private:
  friend class LightCardBuilder;
  std::vector<std::vector<Cell>> levels_;
};

// Takes a picture row by row, from the top (v = 0): no more than the finest level stands in memory.
class LightCardBuilder {
 public:
  LightCardBuilder(std::uint32_t width, std::uint32_t height);
  // 4 * width numbers, linear; alpha is not looked at. What comes after `height` rows is ignored; rows that never came are black.
  void add_row(std::span<const float> rgba);
  LightCard finish() &&;

 private:
  std::uint32_t width_, height_, row_ = 0;
  int level_;
  std::vector<std::array<double, 6>> sums_;  // of the finest cells: three channels, and their squares
};

struct PatchOptions {
  double tolerance = 0.01;  // relative, of the estimate below
  int most_patches = 1024;
};
struct PatchEstimate {
  Rgb value;        // cd/m2 towards the view
  Rgb error;        // what is expected to be left of the picture's detail; what the lobe itself is off by comes on top
  int patches = 0;  // closed forms that were evaluated
};
// The light of a picture on a rectangle, as the sum over patches of a patch's mean times the closed form of its light: Lambert's, or the
// moments of GGX (specular_methods.h). Patches are split where the picture and the lobe both vary (sdk/docs/textured-lights.md). Nothing
// for other shapes and other BRDFs than Lambert and round correlated GGX, and where the emitter has a window. The emitter's own pattern is
// not asked.
std::optional<PatchEstimate> by_patches(const Emitter& emitter, const LightCard& card, const ShadingPoint& point,
                                        const PatchOptions& options = {});

}  // namespace etendue::eval
