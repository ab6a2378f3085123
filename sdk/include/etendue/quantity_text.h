// What people write about lights, cameras and colours, in one line:
//   "1200 lm"  "15 klx @ 2 m"  "60 W at 15 lm/W"                                          a quantity of a light
//   "f/2.8 1/60 s ISO 400"  "T2.8 180 deg @ 24 fps ND 0.9"  "f/16 1/125 ISO100 +1.5 stop"  a camera
//   "3000 K Duv -0.003"  "3200 K + 137 mired"  "xy .3127 .329"  "#ffb46b"  "rgb 1 .5 .2"   a colour
#pragma once

#include "etendue/camera.h"
#include "etendue/colour.h"
#include "etendue/unit_names.h"

#include <variant>

namespace etendue {

// A number in the unit that was written, and what was written beside it.
struct WrittenQuantity {
  double number = 0;
  NamedUnit unit{};
  std::optional<double> distance_m{};     // behind an illuminance: "@ 2 m"
  std::optional<double> efficacy_lm_W{};  // behind a radiometric quantity: "at 15 lm/W"

  AnyQuantity quantity() const { return {unit.dimension, unit.to_si(number)}; }
};

// A temperature without Duv is a quantity. Rgb is linear Rec.709; "#ffb46b" is sRGB (IEC 61966-2-1), decoded.
using Written = std::variant<WrittenQuantity, CameraSettings, ColourTemperature, Chromaticity, Rgb>;

// The order of camera settings is free; blanks between a name and its number are, too; filters (ND) add up. "1/60" and "180 deg" beside
// "@ 24 fps" are shutters. Errors carry the column (where.column, from 1): NUMBER_INVALID, UNIT_MISSING, UNIT_UNKNOWN (with the nearest
// spellings), DIMENSION_MISMATCH (a distance behind anything but an illuminance), CAMERA_SETTING_INVALID, CAMERA_SETTING_AMBIGUOUS (given
// twice), TEMPERATURE_OUT_OF_RANGE, COLOUR_INVALID, TEXT_UNEXPECTED (what is left over). About 40 ns for "1200 lm".
Result<Written> parse(std::string_view text);
// The same, but a temperature above 0 K that is beyond the range counts as the nearest end of it, and `clamped` gets a warning
// TEMPERATURE_CLAMPED with both.
Result<Written> parse(std::string_view text, Diagnostics& clamped);

// Shortest text that parse() reads back as the same numbers.
std::string to_string(const Written& written);

}  // namespace etendue
