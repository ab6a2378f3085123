// The two pictures and everything that is known about their noise, pixel by pixel, in double.
#pragma once

#include "etendue/compare.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace etendue::compare_detail {

// Mitsuba sums a pixel's samples in float32: relative error 8e-6 at 1024 samples, 2e-5 at 4096 (measured). Without this term a picture that
// is free of noise (a directional light on a Lambert surface) would have sigma = 0.
inline constexpr double float_accumulation = 3e-5;

// Interleaved R G B, row 0 at the top.
struct Evidence {
  std::uint32_t width = 0, height = 0;
  int seeds = 0;
  std::vector<double> ours, reference;
  std::vector<double> variance;  // sigma^2 of ours - reference
  std::vector<double> scatter;   // the part of it that the reference's seeds measured
  std::vector<double> bound;     // the part of it that holds no noise: what errors may be, or what is not known
  double own_noise = 0;          // relative to the picture's: mean of our variance / sigma^2
  std::vector<double> around;    // mean sigma^2 of the 24 pixels around, and a floor: independent of the pixel's own noise
  std::vector<bool> emitter;     // per pixel: touches a visible emitter
  std::vector<int> object;       // per pixel: 1 + index, 0 for none

  std::size_t pixels() const { return std::size_t{width} * height; }
  double difference(std::size_t i) const { return ours[i] - reference[i]; }
};

// `light` empty: the pictures themselves; else the layers "light.NAME", absent in ours meaning black.
// Errors: PICTURE_SIZE_MISMATCH, PICTURE_UNSUITABLE, REFERENCE_TOO_FEW_SEEDS, LAYER_MISSING.
Result<Evidence> gather(const Picture& ours, const Picture& reference, const std::string& light);

// Names of the lights that have a layer "light.NAME" in the picture.
std::vector<std::string> lights_of(const Picture& picture);

// Mean of the pixels around (x, y) within 2, without itself and, for a pixel off the emitters, without those on them. Interleaved R G B.
std::vector<double> mean_around(const std::vector<double>& values, std::uint32_t width, std::uint32_t height,
                                const std::vector<bool>& emitter);

}  // namespace etendue::compare_detail
