// False-colour views of pictures: how many cd/m2, lx or EV there are where.
//   auto view = false_colour_view(picture, "", Measure::ev100, *calibration("frostbite"), {.least = 0, .greatest = 16, .bands = 16});
#pragma once

#include "etendue/camera.h"
#include "etendue/false_colour.h"
#include "etendue/picture.h"
#include "etendue/result.h"

#include <string_view>
#include <vector>

namespace etendue {

// What a layer's pixels are taken for. Luminances are cd/m2 times the picture's "whiteLuminance" where it has one; illuminances are lx as
// they are.
enum class Measure {
  luminance,             // cd/m2 of a layer of luminances
  ev100,                 // EV of a layer of luminances: what a spot meter shows
  illuminance,           // lx of a layer of illuminances
  ev100_of_illuminance,  // EV of a layer of illuminances: what an incident-light meter shows
};

// One number a pixel, row 0 at the top, of a layer of one channel or of RGB (by its luminance). Where there is no EV: -infinity for 0 and
// below, +infinity for infinity, NaN for NaN. LAYER_MISSING, with the names that there are.
Result<std::vector<float>> measured(const Picture& picture, std::string_view layer, Measure measure, const Calibration& calibration);

struct FalseColourView {
  Picture picture;  // one layer "", linear Rec.709 from 0 to 1
  FalseColourCounts counts;
};
// Errors: LAYER_MISSING, SCALE_INVALID.
Result<FalseColourView> false_colour_view(const Picture& picture, std::string_view layer, Measure measure, const Calibration& calibration,
                                          const FalseColourScale& scale);

}  // namespace etendue
