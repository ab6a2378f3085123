// Which temperatures lights have here, and what to do about others.
#pragma once

#include "etendue/result.h"

namespace etendue {

// In K. Colder ones have next to no light (3e-66 cd/m2 at 100 K), hotter ones all but the colour of infinity.
inline constexpr double coldest_K = 100, hottest_K = 100000;

// The temperature itself, or TEMPERATURE_OUT_OF_RANGE with its value and the range.
Result<double> checked_temperature(double kelvin);

// For those who ask for it: the nearest temperature of the range, and whether it is another one. What is no temperature at all, 0 K, a
// negative one or NaN, is TEMPERATURE_OUT_OF_RANGE still.
struct ClampedTemperature {
  double kelvin = 0;
  bool clamped = false;
};
Result<ClampedTemperature> clamped_temperature(double kelvin);

}  // namespace etendue
