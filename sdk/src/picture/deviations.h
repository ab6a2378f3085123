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
  // Colours with what they are in steps of 8-bit sRGB.
  struct Stepped {
    explicit Stepped(const ColourPair& pair) : linear(pair) {
      for (int c = 0; c < 3; ++c) {
        encoded.diffuse[c] = SrgbEncoder::get()(pair.diffuse[c]);
        encoded.f0[c] = SrgbEncoder::get()(pair.f0[c]);
      }
    }
    ColourPair linear, encoded;
  };
  // `count` texels with the same colours.
  void add(const ColourPair& found, const Stepped& wanted, std::uint64_t count) {
    const Stepped here(found);
    for (int c = 0; c < 3; ++c) {
      diffuse_.add(found.diffuse[c] - wanted.linear.diffuse[c], count);
      f0_.add(found.f0[c] - wanted.linear.f0[c], count);
      diffuse_steps_.add(255 * (here.encoded.diffuse[c] - wanted.encoded.diffuse[c]), count);
      f0_steps_.add(255 * (here.encoded.f0[c] - wanted.encoded.f0[c]), count);
    }
  }
  void add(const ColourPair& found, const ColourPair& wanted, std::uint64_t count = 1) { add(found, Stepped(wanted), count); }
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

  Sum diffuse_, f0_, diffuse_steps_, f0_steps_;
};

}  // namespace etendue
