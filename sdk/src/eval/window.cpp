// What multiplies a light by distance. Sources: light.h.
#include "etendue/eval.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {

bool is_window(const Window& window) {
  const Falloff::Law law = window.falloff.law;
  return law != Falloff::Law::inverse_square && (window.range_m > 0 || law == Falloff::Law::karis);
}

double window_at(const Window& window, double distance_m) {
  if (!is_window(window)) return 1;
  const double x = window.range_m > 0 ? std::min(distance_m / window.range_m, 1.0) : 0;
  const auto left = [x](double exponent) { return 1 - std::pow(x, exponent); };
  switch (window.falloff.law) {
    case Falloff::Law::power:
      return left(window.falloff.exponent);
    case Falloff::Law::power_squared:
      return left(window.falloff.exponent) * left(window.falloff.exponent);
    case Falloff::Law::smoothstep:
      return (1 - x) * (1 - x) * (1 + 2 * x);
    case Falloff::Law::scale_bias: {
      const double threshold = 1 / (window.range_m * window.range_m);
      return threshold < 1 ? left(2) / (1 - threshold) : 0;
    }
    case Falloff::Law::karis:
      return left(4) * left(4) / (1 + 1 / (distance_m * distance_m));
    case Falloff::Law::inverse_square:
      break;
  }
  return 1;
}

// Karis' grows first and falls then, the others only fall.
double least_window(const Window& window, double nearest_m, double furthest_m) {
  return std::min(window_at(window, nearest_m), window_at(window, furthest_m));
}

}  // namespace etendue::eval
