// The transfer function of sRGB, IEC 61966-2-1, exactly: no power of 2.2 (which is off by up to .0335), no NaN for what is negative.
#pragma once

#include <cmath>

namespace etendue {

// Linear light of an encoded value. Below 0 the straight part goes on; above 1 the power does.
inline double srgb_to_linear(double encoded) { return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4); }
// Its inverse, but for a gap of 1e-7 at .0031308, where the standard's rounded constants do not meet.
inline double linear_to_srgb(double linear) { return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1 / 2.4) - 0.055; }

}  // namespace etendue
