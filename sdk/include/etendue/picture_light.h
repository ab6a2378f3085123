// The light of a picture on a rectangle to an asked tolerance, whatever the picture's detail: quadrature whose weights are the picture's
// own.
//   const PictureMoments picture(emitter.pattern, width, height);   // once a light
//   std::optional<Estimate> light = picture_luminance(emitter, picture, point, {1e-3, 0});
#pragma once

#include "etendue/eval.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace etendue::eval {

// Moments of a picture over [0, 1]^2 and its halves, quarters, ... : level k has 2^k cells along u and v.
class PictureMoments {
 public:
  static constexpr int finest = 8;
  // weights[3 b + a]: integral over the cell, by its area, of the picture times the polynomial of second degree in u and in v that is 1 at
  // the cell's node (a, b) and 0 at the others, nodes being Gauss and Legendre's. They sum up to the cell's mean.
  struct Cell {
    std::array<Vec3f, 9> weights;
    Vec3f deviation;  // root of the mean square from the mean
  };
  // Of a picture of width * height texels joined bilinearly, as `sample` of picture.h does without a transform, in any wrap mode: exact but
  // for the rounding to floats. Takes some 50 ns a texel.
  PictureMoments(const Pattern& pattern, std::uint32_t width, std::uint32_t height);

  const Cell& cell(int level, std::uint32_t x, std::uint32_t y) const {
    return levels_[static_cast<std::size_t>(level)][(std::size_t{y} << level) + x];
  }
  Rgb mean() const;

 private:
  std::vector<std::vector<Cell>> levels_;
};

// Towards the view, cd/m2. |error| <= max(tolerance.relative value, tolerance.absolute) in every channel, by an estimate that is told
// (sdk/docs/textured-lights.md has what is known of it). Nothing where that is not reached with the cells there are (narrow lobes, points
// in the light's plane or closer than a few hundredths of its sides, tolerances below 1e-6), and for lights that carry no picture. The
// emitter's own pattern is not asked: `picture` is it.
std::optional<Estimate> picture_luminance(const Emitter& emitter, const PictureMoments& picture, const ShadingPoint& point,
                                          const Tolerance& tolerance);
// Whether it is a rectangle that fills its uv frame, without a window.
bool carries_picture(const Emitter& emitter);
// alpha of the narrowest lobe; 1 of diffuse ones.
double narrowest_alpha(const Brdf& brdf);

}  // namespace etendue::eval
