// False-colour views: exposure values, luminances or illuminances as colours whose lightness rises with them.
//   auto counts = false_colour(ev, {.least = 0, .greatest = 16, .bands = 16}, picture);
#pragma once

#include "etendue/result.h"
#include "etendue/vec.h"

#include <cstdint>
#include <span>

namespace etendue {

// From dark blue (0) over green (.5) to pale yellow (1), linear Rec.709; luminance rises all the way, so that prints in grey and eyes with
// few colours can order them. Positions outside count as the ends.
Rgb false_colour(double position);
// What values outside of a scale get: black below, white above, magenta for NaN.
inline constexpr Rgb false_colour_below{0, 0, 0}, false_colour_above{1, 1, 1}, false_colour_of_nan{1, 0, 1};

struct FalseColourScale {
  double least = 0, greatest = 0;
  bool logarithmic = false;  // equal ratios, not equal differences, look equal: for cd/m2 and lx, not for EV
  int bands = 0;             // as many even colours instead of a gradient; 0: a gradient
};
struct FalseColourCounts {
  std::uint64_t below = 0, above = 0, nan = 0;
  friend bool operator==(const FalseColourCounts&, const FalseColourCounts&) = default;
};
// Both ends belong to the scale. BATCH_SIZES_DIFFER; SCALE_INVALID unless least < greatest, finite, above 0 where logarithmic, bands from 0
// to 4096.
Result<FalseColourCounts> false_colour(std::span<const float> values, const FalseColourScale& scale, std::span<Vec3f> colours);

}  // namespace etendue
