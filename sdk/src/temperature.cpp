#include "etendue/temperature.h"

#include "parameter_error.h"

#include <fmt/format.h>

#include <algorithm>

namespace etendue {

Result<double> checked_temperature(double kelvin) {
  if (kelvin >= coldest_K && kelvin <= hottest_K) return kelvin;
  return parameter_error("kelvin", "TEMPERATURE_OUT_OF_RANGE",
                         fmt::format("expected a temperature between {} K and {} K, found {} K", coldest_K, hottest_K, kelvin));
}

Result<ClampedTemperature> clamped_temperature(double kelvin) {
  if (!(kelvin > 0)) return checked_temperature(kelvin).error();
  const double nearest = std::clamp(kelvin, coldest_K, hottest_K);
  return ClampedTemperature{nearest, nearest != kelvin};
}

}  // namespace etendue
