// Angles in degrees without the calls and the range reductions of the general functions.
#pragma once

#include <algorithm>
#include <cmath>

namespace etendue::photometry {

inline constexpr double degree = 3.14159265358979323846 / 180;

// atan2(y, x) in degrees, within 1e-13 of it; 0 for (0, 0). The shorter leg over the longer one is at most 1; beyond tan(pi/8) the
// difference to 45 degrees is taken, atan(r) = pi/4 + atan((r - 1) / (r + 1)), so that q^2 <= 3 - 2 sqrt(2), where a polynomial of degree
// 11 in q^2 (interpolated in Chebyshev's nodes) is within 3e-18 of atan(q) / q.
inline double atan2_deg(double y, double x) {
  const double ax = std::abs(x), ay = std::abs(y), longer = std::max(ax, ay), shorter = std::min(ax, ay);
  constexpr double tan_eighth = 0.41421356237309503;
  // Choices as arithmetic: directions are as good as random, and a wrongly predicted branch costs as much as all of the rest.
  const double far = shorter > tan_eighth * longer ? 1.0 : 0.0;
  const double numerator = shorter - far * longer, denominator = longer + far * shorter;
  const double q = denominator > 0 ? numerator / denominator : 0;
  const double z = q * q, z2 = z * z, z4 = z2 * z2, z8 = z4 * z4;
  const double low = (1 - 0.3333333333333312 * z) + (0.19999999999940454 - 0.14285714279209863 * z) * z2;
  const double middle = (0.11111110742994133 - 0.09090896756216268 * z) + (0.07692044442205753 - 0.06662942367829736 * z) * z2;
  const double high = (0.05846814660543541 - 0.05034839194788839 * z) + (0.037959161322152546 - 0.01779935362015956 * z) * z2;
  const double octant = 45 * far + q * (low + middle * z4 + high * z8) * (1 / degree);
  const double steep = ay > ax ? 1.0 : 0.0, back = std::copysign(0.5, x);
  const double quadrant = 90 * steep + (1 - 2 * steep) * octant;
  return std::copysign(90 - 180 * back + 2 * back * quadrant, y);
}

struct SineCosine {
  double sine, cosine;
};

// Of |x| <= pi/4 by Taylor's series, whose next terms are below 5e-18 (sine) and 1e-18 (cosine), summed in pairs.
inline SineCosine sine_cosine_small(double x) {
  const double q = x * x, q2 = q * q, q4 = q2 * q2;
  const double sine = (-1.0 / 6 + q * (1.0 / 120)) + q2 * (-1.0 / 5040 + q * (1.0 / 362880)) +
                      q4 * ((-1.0 / 39916800 + q * (1.0 / 6227020800)) + q2 * (-1.0 / 1307674368000));
  const double cosine = (-0.5 + q * (1.0 / 24)) + q2 * (-1.0 / 720 + q * (1.0 / 40320)) +
                        q4 * ((-1.0 / 3628800 + q * (1.0 / 479001600)) + q2 * (-1.0 / 87178291200 + q * (1.0 / 20922789888000)));
  return {x + x * (q * sine), 1 + q * cosine};
}

// Exact at multiples of 90 degrees.
inline SineCosine sine_cosine_deg(double angle_deg) {
  if (!(std::abs(angle_deg) < 1e6)) angle_deg = std::fmod(angle_deg, 360);
  const int quarter = static_cast<int>(angle_deg / 90 + (angle_deg < 0 ? -0.5 : 0.5));
  const SineCosine s = sine_cosine_small((angle_deg - 90.0 * quarter) * degree);
  switch (quarter & 3) {
    case 0:
      return s;
    case 1:
      return {s.cosine, -s.sine};
    case 2:
      return {-s.sine, -s.cosine};
    default:
      return {-s.cosine, s.sine};
  }
}

}  // namespace etendue::photometry
