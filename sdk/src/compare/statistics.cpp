#include "statistics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace etendue::compare_detail {

double two_sided_quantile(double probability) {
  // erfc(x / sqrt 2) = probability. The logarithm of erfc falls and is concave: Newton on it from the right falls steadily to the root.
  // erfc(x / sqrt 2) <= exp(-x^2 / 2) gives the start.
  double x = std::sqrt(-2 * std::log(probability));
  for (int i = 0; i < 60; ++i) {
    const double tail = std::erfc(x / std::numbers::sqrt2);
    const double slope = std::sqrt(2 / std::numbers::pi) * std::exp(-x * x / 2) / tail;
    const double step = std::log(tail / probability) / slope;
    x += step;
    if (std::abs(step) < 1e-14) break;
  }
  return x;
}

double sidak_rate(double family_rate, double tests) { return -std::expm1(std::log1p(-family_rate) / std::max(tests, 1.0)); }

double normal_from_t(double t, double nu) {
  const double z = (8 * nu + 1) / (8 * nu + 3) * std::sqrt(nu * std::log1p(t * t / nu));
  return std::copysign(z, t);
}

double without_skewness(double t, double skewness) {
  return t + skewness * t * t / 3 + skewness * skewness * t * t * t / 27 + skewness / 6;
}

}  // namespace etendue::compare_detail
