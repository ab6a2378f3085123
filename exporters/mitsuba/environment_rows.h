// From our rows of a latitude-longitude map to Mitsuba's.
#pragma once

#include "etendue/picture.h"
#include "etendue/vec.h"

#include <vector>

namespace etendue::mitsuba {

// 2 height + 1 rows of RGB, the first and last on the poles: the same function on the sphere, times `factor`.
std::vector<float> rows_aligned_with_poles(const DecodedImage& image, const Rgb& factor);

}  // namespace etendue::mitsuba
