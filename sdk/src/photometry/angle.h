// Angles in degrees without the calls and the range reductions of the general functions.
#pragma once

#include <algorithm>
#include <cmath>

namespace etendue::photometry {

inline constexpr double degree = 3.14159265358979323846 / 180;

#if defined(__GNUC__)
// Two doubles at once, where the compiler has them: an arithmetic operation on both costs what one does.
using Pair = double __attribute__((vector_size(16)));
using PairMask = decltype(Pair{} < Pair{});
inline Pair magnitude(Pair x) {
  return reinterpret_cast<Pair>(reinterpret_cast<PairMask>(x) & ~reinterpret_cast<PairMask>(Pair{-0.0, -0.0}));
}
inline Pair where(PairMask mask, Pair x) { return reinterpret_cast<Pair>(reinterpret_cast<PairMask>(x) & mask); }
inline Pair negative_where(PairMask mask, Pair x) {
  return reinterpret_cast<Pair>(reinterpret_cast<PairMask>(x) ^ (mask & reinterpret_cast<PairMask>(Pair{-0.0, -0.0})));
}
#else
struct Pair {
  double first, second;
  double operator[](int i) const { return i == 0 ? first : second; }
};
#endif
inline double magnitude(double x) { return std::abs(x); }
inline double where(bool mask, double x) { return mask ? x : 0; }
inline double negative_where(bool mask, double x) { return mask ? -x : x; }

// The azimuth past the first plane of a table, from -360 to 360 degrees, folded into it: mirrored beyond half_deg, then beyond quarter_deg
// (above 360 where nothing mirrors). Random directions mislead branches; of pairs the compiler makes none.
inline double folded_past(double past_deg, double half_deg, double quarter_deg) {
#if defined(__GNUC__)
  Pair p{past_deg, past_deg};
  p += p < 0 ? Pair{360, 360} : Pair{};
  if (half_deg > 360) return p[0];
  p = p > half_deg ? 360 - p : p;
  p = p > quarter_deg ? 180 - p : p;
  return p[0];
#else
  double p = past_deg < 0 ? past_deg + 360 : past_deg;
  p = p > half_deg ? 360 - p : p;
  return p > quarter_deg ? 180 - p : p;
#endif
}

// atan2(y, x) in degrees, within 1e-13 of it; 0 for (0, 0). The shorter leg over the longer one is at most 1; beyond tan(pi/8) the
// difference to 45 degrees is taken, atan(r) = pi/4 + atan((r - 1) / (r + 1)), so that q^2 <= 3 - 2 sqrt(2), where a polynomial of degree 9
// in q^2 (interpolated in Chebyshev's nodes) is within a relative 1e-15 of atan(q) / q, here in degrees. Choices are arithmetic: directions
// are as good as random, and a wrongly predicted branch costs as much as all of the rest.
template <class T>
T atan2_deg_of(T y, T x) {
  const T zero = T{}, least = zero + 1e-320;
  const T ax = magnitude(x), ay = magnitude(y);
  const auto steep = ay > ax;
  const T longer = steep ? ay : ax, shorter = steep ? ax : ay;
  constexpr double tan_eighth = 0.41421356237309503;
  const auto far = shorter > tan_eighth * longer;
  const T numerator = shorter - where(far, longer), denominator = longer + where(far, shorter);
  const T q = numerator / (denominator > least ? denominator : least);
  const T z = q * q, z2 = z * z, z4 = z2 * z2, z8 = z4 * z4;
  const T low = (57.295779513082266 - 19.098593170963326 * z) + (11.459155890236373 - 8.185110428511402 * z) * z2;
  const T middle = (6.366162052836204 - 5.207917042687507 * z) + (4.396611939790152 - 3.7276536560288953 * z) * z2;
  const T high = 2.8789766247248187 - 1.4505274317065493 * z;
  // From the octant to the circle.
  const auto back = x < zero, below = y < zero;
  const T octant = q * (low + middle * z4 + high * z8) + where(far, zero + 45);
  const T quadrant = negative_where(steep, octant) + where(steep, zero + 90);
  const T half = negative_where(back, quadrant) + where(back, zero + 180);
  return negative_where(below, half);
}
// Of two vectors (x, y), at the price of one.
inline Pair two_atan2_deg(double y0, double x0, double y1, double x1) {
#if defined(__GNUC__)
  return atan2_deg_of(Pair{y0, y1}, Pair{x0, x1});
#else
  return {atan2_deg_of(y0, x0), atan2_deg_of(y1, x1)};
#endif
}
// Of doubles the compiler may make branches of the choices, of pairs it cannot.
inline double atan2_deg(double y, double x) {
#if defined(__GNUC__)
  return atan2_deg_of(Pair{y, y}, Pair{x, x})[0];
#else
  return atan2_deg_of(y, x);
#endif
}

struct SineCosine {
  double sine, cosine;
};

// sin(x) and 1 - cos(x) of |x| <= pi/4 by Taylor's series, whose next terms are below 5e-18 and 1e-18, summed in pairs.
struct SineVersine {
  double sine, versine;
};
inline SineVersine sine_versine_small(double x) {
  const double q = x * x, q2 = q * q, q4 = q2 * q2;
  const double sine = (-1.0 / 6 + q * (1.0 / 120)) + q2 * (-1.0 / 5040 + q * (1.0 / 362880)) +
                      q4 * ((-1.0 / 39916800 + q * (1.0 / 6227020800)) + q2 * (-1.0 / 1307674368000));
  const double versine = (0.5 - q * (1.0 / 24)) + q2 * (1.0 / 720 - q * (1.0 / 40320)) +
                         q4 * ((1.0 / 3628800 - q * (1.0 / 479001600)) + q2 * (1.0 / 87178291200 - q * (1.0 / 20922789888000)));
  return {x + x * (q * sine), q * versine};
}
inline SineCosine sine_cosine_small(double x) {
  const SineVersine s = sine_versine_small(x);
  return {s.sine, 1 - s.versine};
}

// Exact at multiples of 90 degrees. The quarter turn is applied as a multiplication by 0, 1 and -1: random azimuths mislead branches.
inline SineCosine sine_cosine_deg(double angle_deg) {
  if (!(std::abs(angle_deg) < 1e6)) angle_deg = std::fmod(angle_deg, 360);
  const int quarter = static_cast<int>(angle_deg * (1.0 / 90) + std::copysign(0.5, angle_deg));
  const SineCosine s = sine_cosine_small((angle_deg - 90.0 * quarter) * degree);
  constexpr double cosine_of_quarter[] = {1, 0, -1, 0}, sine_of_quarter[] = {0, 1, 0, -1};
  const double c = cosine_of_quarter[quarter & 3], d = sine_of_quarter[quarter & 3];
  return {s.sine * c + s.cosine * d, s.cosine * c - s.sine * d};
}

}  // namespace etendue::photometry
