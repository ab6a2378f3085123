// A number as the unevaluated sum of two doubles, hi + lo with |lo| <= ulp(hi)/2: about 106 bits. Chains of constants, products and
// quotients keep their digits in it and are rounded once, where they become a double.
// Dekker 1971, A floating-point technique for extending the available precision; fma gives the error of a product exactly.
#pragma once

#include <cmath>

namespace etendue {

struct Wide {
  double hi = 0, lo = 0;

  constexpr Wide() = default;
  constexpr Wide(double x) : hi(x) {}
  constexpr Wide(double high, double low) : hi(high), lo(low) {}
  constexpr explicit operator double() const { return hi + lo; }
};
inline constexpr Wide wide_pi{3.141592653589793116, 1.2246467991473532072e-16};

// hi + lo where |lo| is at most about ulp(hi). An infinite or NaN hi stands alone: its error has no meaning.
inline Wide normalised(double hi, double lo) {
  if (!std::isfinite(hi)) return {hi};
  const double sum = hi + lo;
  return {sum, lo - (sum - hi)};
}

// Relative error below 2^-100, as that of all four.
inline Wide operator*(Wide a, Wide b) {
  const double product = a.hi * b.hi;
  return normalised(product, std::fma(a.hi, b.hi, -product) + (a.hi * b.lo + a.lo * b.hi));
}
// For terms of one sign, which is all that is needed here. The error of a sum without knowing the larger term: Knuth, TAOCP 2, 4.2.2.
inline Wide operator+(Wide a, Wide b) {
  const double sum = a.hi + b.hi, part = sum - a.hi;
  return normalised(sum, (a.hi - (sum - part)) + (b.hi - part) + (a.lo + b.lo));
}
inline Wide operator/(Wide a, Wide b) {
  const double quotient = a.hi / b.hi;
  if (!std::isfinite(quotient)) return {quotient};
  const double rest = std::fma(-quotient, b.hi, a.hi) + (a.lo - quotient * b.lo);
  return normalised(quotient, rest / b.hi);
}
inline Wide squared(Wide a) { return a * a; }

}  // namespace etendue
