// Differences of pairs of colours, gathered: their squares and the largest, linear and in steps of 8-bit sRGB.
#pragma once

#include "etendue/material_conversion.h"

#include "srgb_encoder.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace etendue {

// Over the channels of both colours.
inline double rms_of(const ReaderDeviation& d) { return std::sqrt((d.diffuse.rms * d.diffuse.rms + d.f0.rms * d.f0.rms) / 2); }

class DeviationSums {
 public:
  // `count` texels with the same colours.
  void add(const ColourPair& found, const ColourPair& wanted, std::uint64_t count = 1) {
    for (int c = 0; c < 3; ++c) {
      diffuse_.add(found.diffuse[c] - wanted.diffuse[c], count);
      f0_.add(found.f0[c] - wanted.f0[c], count);
      diffuse_steps_.add(steps(found.diffuse[c], wanted.diffuse[c]), count);
      f0_steps_.add(steps(found.f0[c], wanted.f0[c]), count);
    }
  }
  void add(const DeviationSums& other) {
    diffuse_.add(other.diffuse_);
    f0_.add(other.f0_);
    diffuse_steps_.add(other.diffuse_steps_);
    f0_steps_.add(other.f0_steps_);
  }
  ReaderDeviation deviation() const { return {diffuse_.deviation(), f0_.deviation(), diffuse_steps_.deviation(), f0_steps_.deviation()}; }

 private:
  struct Sum {
    double squares = 0, max = 0;
    std::uint64_t count = 0;
    void add(double difference, std::uint64_t times) {
      squares += difference * difference * static_cast<double>(times);
      max = std::max(max, std::abs(difference));
      count += times;
    }
    void add(const Sum& other) {
      squares += other.squares;
      max = std::max(max, other.max);
      count += other.count;
    }
    Deviation deviation() const { return {count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0, max}; }
  };
  static double steps(double a, double b) { return 255 * (SrgbEncoder::get()(a) - SrgbEncoder::get()(b)); }

  Sum diffuse_, f0_, diffuse_steps_, f0_steps_;
};

}  // namespace etendue
