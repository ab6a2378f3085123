// linear_to_srgb() from a table, for the many texels of a picture.
#pragma once

#include "etendue/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace etendue {

// Within 5e-7 of linear_to_srgb() for [0, 1], to which other numbers are held; NaN counts as 0. Over u = sqrt(x) the curve is 12.92 u^2,
// and from u = .056 on 1.055 u^(2/2.4) - .055, whose second derivative is at most 25.9 in size: over a step h = 2^-14 of u a straight line
// is off by at most 25.9 h^2 / 8 = 1.2e-8, and where the two meet by h / 4 of the change of slope (.024), 3.7e-7.
class SrgbEncoder {
 public:
  static const SrgbEncoder& get() {
    static const SrgbEncoder made;
    return made;
  }
  double operator()(double linear) const {
    const double held = linear > 0 ? std::min(linear, 1.0) : 0.0;
    const double place = std::sqrt(held) * steps;
    const auto left = std::min(static_cast<std::size_t>(place), steps - 1);
    return encoded_[left] + (encoded_[left + 1] - encoded_[left]) * (place - static_cast<double>(left));
  }

 private:
  static constexpr std::size_t steps = std::size_t{1} << 14;
  SrgbEncoder() {
    for (std::size_t i = 0; i <= steps; ++i) {
      const double u = static_cast<double>(i) / steps;
      encoded_[i] = linear_to_srgb(u * u);
    }
  }
  std::array<double, steps + 1> encoded_{};
};

}  // namespace etendue
