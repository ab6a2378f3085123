// Cubature over the unit disk: a node in the middle and rings of equally spaced ones, with a bound on the error from how fast the
// harmonics of the outermost ring fall. Derivations: sdk/docs/evaluation.md.
#pragma once

#include "etendue/vec.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue::eval {

struct DiskValue {
  Rgb mean;   // of the integrand over the disk
  Rgb error;  // bound
};

namespace disk_rule {

// Amplitudes on the outermost ring of the two highest harmonics that its nodes can tell, and how the mean of a ring bends with its radius.
struct Spectrum {
  double highest, next, bend;
};

// 6 nodes: three turns, two turns.
inline Spectrum spectrum(const std::array<double, 6>& g, double bend) {
  constexpr double half_root3 = 0.8660254037844386;
  const double s0 = g[0] + g[3], s1 = g[1] + g[4], s2 = g[2] + g[5];
  const double cosine = s0 - 0.5 * (s1 + s2), sine = half_root3 * (s1 - s2);
  return {std::abs(g[0] - g[1] + g[2] - g[3] + g[4] - g[5]) / 6, std::sqrt(cosine * cosine + sine * sine) / 3, std::abs(bend)};
}
// 8 nodes: four turns, three turns.
inline Spectrum spectrum(const std::array<double, 8>& g, double bend) {
  constexpr double half_root2 = 0.7071067811865476;
  const double d0 = g[0] - g[4], d1 = g[1] - g[5], d2 = g[2] - g[6], d3 = g[3] - g[7];
  const double cosine = d0 - half_root2 * (d1 - d3), sine = half_root2 * (d1 + d3) - d2;
  return {std::abs(g[0] - g[1] + g[2] - g[3] + g[4] - g[5] + g[6] - g[7]) / 8, std::sqrt(cosine * cosine + sine * sine) / 4,
          std::abs(bend)};
}

// Where the k-th harmonic falls like rho^k, so do these: highest and next like rho^3 and rho^2 (rho^4 and rho^3), the bend like rho^2
// (rho^4), the error of the rule like rho^6 (rho^8). The powers make rho^4 (rho^6) of all of them.
template <std::size_t nodes>
double error_from(const Spectrum& s, double mean) {
  if (!(mean > 0)) return s.highest + s.next + s.bend;
  const double highest = s.highest / mean, next = s.next / mean, bend = s.bend / mean;
  if constexpr (nodes == 6) return mean * std::max({highest * std::cbrt(highest), next * next, bend * bend});
  return mean * std::max({highest * std::sqrt(highest), next * next, bend * std::sqrt(bend)});
}

template <std::size_t nodes, class F>
std::array<Rgb, nodes> ring(double radius, const F& f) {
  static const auto turns = [] {
    std::array<Vec2d, nodes> t;
    for (std::size_t i = 0; i < nodes; ++i) {
      const double angle = 2 * 3.141592653589793 * static_cast<double>(i) / static_cast<double>(nodes);
      t[i] = {std::cos(angle), std::sin(angle)};
    }
    return t;
  }();
  std::array<Rgb, nodes> values;
  for (std::size_t i = 0; i < nodes; ++i) values[i] = f(radius * turns[i].x, radius * turns[i].y);
  return values;
}

template <std::size_t nodes>
Rgb mean_of(const std::array<Rgb, nodes>& values) {
  Rgb sum;
  for (const Rgb& v : values) sum += v;
  return sum / static_cast<double>(nodes);
}

template <std::size_t nodes>
DiskValue judged(const Rgb& mean, const std::array<Rgb, nodes>& outermost, const Rgb& bend) {
  DiskValue out{mean, {}};
  for (int c = 0; c < 3; ++c) {
    std::array<double, nodes> g;
    for (std::size_t i = 0; i < nodes; ++i) g[i] = outermost[i][c];
    out.error[c] = error_from<nodes>(spectrum(g, bend[c]), mean[c]);
  }
  return out;
}

}  // namespace disk_rule

// Rgb f(x, y), not negative. Along the squared radius t the nodes are Radau's with 0 among them, which are exact to the degree 2 and 4 in
// t.

// Degree 5: t = 2/3. The bend is the difference of both means.
template <class F>
DiskValue disk_rule7(const F& f) {
  const Rgb middle = f(0, 0);
  const auto ring = disk_rule::ring<6>(std::sqrt(2 / 3.0), f);
  const Rgb around = disk_rule::mean_of(ring);
  return disk_rule::judged(middle * 0.25 + around * 0.75, ring, around - middle);
}

// Degree 7: t = (6 -+ sqrt 6) / 10. The bend is the second divided difference of the means in t.
template <class F>
DiskValue disk_rule17(const F& f) {
  constexpr double root6 = 2.449489742783178, t1 = (6 - root6) / 10, t2 = (6 + root6) / 10;
  const Rgb middle = f(0, 0);
  const auto inner = disk_rule::ring<8>(std::sqrt(t1), f), outer = disk_rule::ring<8>(std::sqrt(t2), f);
  const Rgb m1 = disk_rule::mean_of(inner), m2 = disk_rule::mean_of(outer);
  const Rgb mean = middle * (1 / 9.0) + m1 * ((16 + root6) / 36) + m2 * ((16 - root6) / 36);
  return disk_rule::judged(mean, outer, ((m2 - m1) / (t2 - t1) - (m1 - middle) / t1) / t2);
}

}  // namespace etendue::eval
