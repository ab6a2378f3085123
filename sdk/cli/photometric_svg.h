// A polar diagram of a web as an SVG picture.
#pragma once

#include <string>

#include "etendue/intensity_web.h"

namespace etendue::cli {

// Four half planes: C0 and C180 drawn through, C90 and C270 dashed; C0 and C90 to the right; the nadir down.
std::string polar_svg(const IntensityWeb& web, const std::string& title);

}  // namespace etendue::cli
