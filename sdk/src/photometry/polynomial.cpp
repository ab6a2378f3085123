#include "polynomial.h"

#include <cmath>

namespace etendue::photometry {
namespace {

// 2 sum of (-1)^n h^(power + 2n) / ((shift + 2n)! (power + 2n)): both kinds of moments. They fall faster than 1/n!: 14 terms reach 1e-17 at
// h = pi/2, and what follows the last one taken is less than it.
double moment(double h, double h_to_power, int power, int shift) {
  double term = h_to_power, sum = 0;
  for (int n = 0; n < 14 && term * term > 1e-34 * sum * sum; ++n) {
    sum += term / (power + 2 * n);
    term *= -h * h / ((shift + 2 * n + 1) * (shift + 2 * n + 2));
  }
  return 2 * sum;
}

}  // namespace

SineMoments sine_moments(double h) {
  // s^k cos(s): powers k + 1 + 2n over (2n)!; s^k sin(s): powers k + 2 + 2n over (2n + 1)!.
  const double cube = h * h * h;
  return {moment(h, h, 1, 0), moment(h, cube, 3, 1), moment(h, cube, 3, 0), moment(h, cube * h * h, 5, 1)};
}

std::array<double, 4> cubic_between(double left, double right, double left_slope, double right_slope, double h) {
  // Hermite on -h..h: p = a + b s + c s^2 + d s^3 with p(+-h) and p'(+-h) given.
  const double mean = 0.5 * (left + right), chord = 0.5 * (right - left) / h;
  const double mean_slope = 0.5 * (left_slope + right_slope), bend = 0.5 * (right_slope - left_slope);
  const double c2 = bend / (2 * h), c3 = (mean_slope - chord) / (2 * h * h);
  return {mean - c2 * h * h, chord - c3 * h * h, c2, c3};
}

double integral_with_sine(const std::array<double, 4>& c, double middle, double h) {
  const SineMoments m = sine_moments(h);
  return std::sin(middle) * (c[0] * m.e0 + c[2] * m.e2) + std::cos(middle) * (c[1] * m.o1 + c[3] * m.o3);
}

}  // namespace etendue::photometry
