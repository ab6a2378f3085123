// Integers of 8 or 16 bits as linear values, and the nearest integer.
#pragma once

#include "etendue/srgb.h"

#include "srgb_encoder.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace etendue {

class CodeTable {
 public:
  CodeTable(int bits, bool srgb) : top_((1 << bits) - 1), srgb_(srgb) {
    for (int code = 0; code <= top_; ++code) {
      const double value = static_cast<double>(code) / top_;
      linear_.push_back(srgb ? srgb_to_linear(value) : value);
    }
  }
  double linear(std::uint16_t code) const { return linear_[code]; }
  int top() const { return top_; }
  // Nearest in linear light, the upper one of two that are as near. `value` is held within 0..1, NaN counts as 0.
  std::uint16_t nearest(double value) const {
    const double held = value > 0 ? std::min(value, 1.0) : 0.0;
    const int below = std::min(static_cast<int>((srgb_ ? SrgbEncoder::get()(held) : held) * top_), top_ - 1);
    return static_cast<std::uint16_t>(distance(below, held) < distance(below + 1, held) ? below : below + 1);
  }

 private:
  double distance(int code, double value) const { return std::abs(linear_[static_cast<std::size_t>(code)] - value); }
  int top_;
  bool srgb_;
  std::vector<double> linear_;
};

}  // namespace etendue
