// Integrals of polynomials against the sine of an angle: how every interpolant that is polynomial in the polar angle is integrated.
#pragma once

#include <array>

namespace etendue::photometry {

// With theta = m + s and p(s) = c0 + c1 s + c2 s^2 + c3 s^3 on -h..h:
//   integral of p sin(theta) = sin(m) (c0 E0 + c2 E2) + cos(m) (c1 O1 + c3 O3),
//   E_k = integral of s^k cos(s),  O_k = integral of s^k sin(s).
// The Taylor series of both have terms that fall from the first one for h <= pi/2, so no digit cancels, however small h is.
struct SineMoments {
  double e0, o1, e2, o3;
};
SineMoments sine_moments(double half_width);

// Values and slopes (per radian) at both ends of -h..h, as coefficients about the middle.
std::array<double, 4> cubic_between(double left, double right, double left_slope, double right_slope, double half_width);

double integral_with_sine(const std::array<double, 4>& coefficients, double middle, double half_width);

}  // namespace etendue::photometry
