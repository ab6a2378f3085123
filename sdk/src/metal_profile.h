// What is left of the six residuals of material_fit.h when the metal mask m is given: a convex problem with an exact solution.
#pragma once

#include "etendue/material_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue {

// s = 1 - m. The residuals of channel c are s b - d and m b + k - f, with the base colour b in [0, 1] and the dielectric part
// k = .16 reflectance^2 s, common to the channels, in [lowest s, highest s].
class MetalProfile {
 public:
  struct Channel {
    double d = 0, f = 0;
  };
  struct Point {
    double m = 0, k = 0, residual = 0;
  };

  static double held(double x) { return std::isnan(x) ? 0 : std::clamp(x, -65504.0, 65504.0); }
  static std::array<Channel, 3> channels_of(const ColourPair& pair) {
    std::array<Channel, 3> out;
    for (int c = 0; c < 3; ++c) out[static_cast<std::size_t>(c)] = {held(pair.diffuse[c]), held(pair.f0[c])};
    return out;
  }

  MetalProfile(const std::array<Channel, 3>& channels, DielectricF0 dielectric)
      : channels_(channels),
        lowest_(dielectric == DielectricF0::core ? largest_dielectric_f0 / 4 : 0),
        highest_(dielectric == DielectricF0::core ? largest_dielectric_f0 / 4 : largest_dielectric_f0) {}

  const std::array<Channel, 3>& channels() const { return channels_; }
  double lowest() const { return lowest_; }
  double highest() const { return highest_; }

  // The best b of a channel: by the derivative in b, held within its bounds.
  static double base(const Channel& c, double m, double k) {
    const double s = 1 - m;
    return std::clamp((s * c.d + m * (c.f - k)) / (s * s + m * m), 0.0, 1.0);
  }

  double residual(double m, double k) const {
    double sum = 0;
    for (const Channel& c : channels_) {
      const double b = base(c, m, k), diffuse = (1 - m) * b - c.d, f0 = m * b + k - c.f;
      sum += diffuse * diffuse + f0 * f0;
    }
    return sum;
  }

  Point operator()(double m) const {
    const double k = dielectric(m);
    return {m, k, residual(m, k)};
  }

 private:
  // Half the derivative in k, with the best b (which is stationary or at a bound, and so does not appear): the sum of the f0 residuals. It
  // grows with k, in straight pieces that meet where a b reaches a bound. Between the last such place that is not above zero and the first
  // that is not below it is straight, and its root is exact.
  double dielectric(double m) const {
    const double s = 1 - m, n = s * s + m * m, low = lowest_ * s, high = highest_ * s;
    if (low >= high) return low;
    const auto slope = [&](double k) {
      double sum = 0;
      for (const Channel& c : channels_) sum += m * base(c, m, k) + k - c.f;
      return sum;
    };
    double left = low, right = high, at_left = slope(low), at_right = slope(high);
    if (at_left >= 0) return low;
    if (at_right <= 0) return high;
    if (m > 0) {
      for (const Channel& c : channels_) {
        for (const double k : {c.f + s * c.d / m, c.f + (s * c.d - n) / m}) {
          if (!(k > left && k < right)) continue;
          const double y = slope(k);
          if (y <= 0)
            left = k, at_left = y;
          else
            right = k, at_right = y;
        }
      }
    }
    return std::clamp(left + (right - left) * (-at_left / (at_right - at_left)), low, high);
  }

  std::array<Channel, 3> channels_;
  double lowest_, highest_;
};

}  // namespace etendue
