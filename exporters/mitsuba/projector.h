// Pictures that Mitsuba's projector throws: what punctual lights with a pattern have in common.
#pragma once

#include "lights.h"

#include <cmath>
#include <vector>

namespace etendue::mitsuba {

// A function of the direction (x left, y up, 1 forward) on the square |x|, |y| <= extent, row 0 at the top, columns from the left.
template <class F>
std::vector<float> tabulate(std::uint32_t width, std::uint32_t height, double x_extent, double y_extent, const F& rgb_at) {
  std::vector<float> rgb;
  rgb.reserve(std::size_t{width} * height * 3);
  for (std::uint32_t row = 0; row < height; ++row) {
    const double y = (1 - 2 * (row + 0.5) / height) * y_extent;
    for (std::uint32_t column = 0; column < width; ++column) {
      const double x = (1 - 2 * (column + 0.5) / width) * x_extent;
      const Rgb value = rgb_at(x, y);
      for (int c = 0; c < 3; ++c) rgb.push_back(static_cast<float>(value[c]));
    }
  }
  return rgb;
}

// I / I(0) of a spot towards a direction whose cosine to the axis is given.
double spot_falloff(const SpotShape& spot, double cosine);

// Mitsuba's projector sends pi t / cos^3 for a texture value t: t = I cos^3 / pi, with cos = 1 / sqrt(1 + x^2 + y^2) of the direction
// (x, y, 1).
Rgb projector_value(const Rgb& intensity, double x, double y);

pugi::xml_node add_clamped_bitmap(pugi::xml_node parent, const char* name, const std::string& file);
// Moves the outermost texel centres of a square bitmap onto its edges, u' = (1/2 + (n - 1) u) / n: bilinear interpolation then reaches the
// edge of a projector's field, beyond which it sends nothing, instead of stopping half a texel before.
void put_texels_on_edges(pugi::xml_node bitmap, std::uint32_t texels);

// The emitter. `to_world`: left, up and forward as columns.
pugi::xml_node add_projector(Writer& writer, const std::string& id, const std::string& file, double fov_rad, const Transform& to_world);

}  // namespace etendue::mitsuba
