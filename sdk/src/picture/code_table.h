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
  // Nearest in linear light. `value` is held within 0..1, NaN counts as 0.
  std::uint16_t nearest(double value) const {
    const double held = value > 0 ? std::min(value, 1.0) : 0.0;
    const int code = static_cast<int>(std::lround((srgb_ ? SrgbEncoder::get()(held) : held) * top_));
    int best = code;
    for (const int other : {code - 1, code + 1})
      if (other >= 0 && other <= top_ && distance(other, held) < distance(best, held)) best = other;
    return static_cast<std::uint16_t>(best);
  }

 private:
  double distance(int code, double value) const { return std::abs(linear_[static_cast<std::size_t>(code)] - value); }
  int top_;
  bool srgb_;
  std::vector<double> linear_;
};

}  // namespace etendue
