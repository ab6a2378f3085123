// Chromaticity of lights in linear Rec.709 (D65), in double.
#pragma once

#include "etendue/result.h"
#include "etendue/vec.h"

namespace etendue {

// Luminance of linear Rec.709, Y = .2126 R + .7152 G + .0722 B.
constexpr double luminance_of(const Rgb& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

// CIE 1931 chromaticity.
struct Chromaticity {
  double x = 0, y = 0;
};

// Planckian radiator, c2 of SI 2019, CIE 1931 2 degree observer, 360-830 nm summed at 1 nm. Domain: 100 K to 100000 K;
// TEMPERATURE_OUT_OF_RANGE.
Result<Chromaticity> planckian(double temperature_K);
// CIE daylight (CIE 015): 4000 K to 25000 K; TEMPERATURE_OUT_OF_RANGE.
Result<Chromaticity> daylight(double temperature_K);

// Linear Rec.709 with luminance_of = 1 exactly (up to rounding), no adaptation, negative channels kept. The matrix is derived from the
// primaries and D65 = (.3127, .3290). Black for a chromaticity without luminance (y <= 0).
Rgb to_rgb(const Chromaticity& xy);
// (0, 0) for black.
Chromaticity to_chromaticity(const Rgb& rgb);

// A colour moved into the gamut (no negative channel) at the same Y: clipped, then rescaled. Black if Y <= 0.
Rgb clipped_keeping_luminance(const Rgb& rgb);

}  // namespace etendue
