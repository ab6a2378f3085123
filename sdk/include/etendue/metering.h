// Automatic exposure: a picture's luminances become one reading, readings become a smooth EV, and that a factor for storing pictures.
//   MeterHistogram histogram;
//   histogram.add(luminances);
//   auto target = ev100_of_luminance(*histogram.mean(), *calibration("frostbite"));
//   ev = *adapted_ev100(ev, *target, seconds_since, {});
// Values are luminances in cd/m2, or, for a reading that does not depend on albedo (black and white cats get the same exposure),
// illuminances in lx from a render's illuminance layer, with ev100_of_illuminance(). Lagarde and de Rousiers, section 5.1.1.
#pragma once

#include "etendue/camera.h"
#include "etendue/result.h"
#include "etendue/vec.h"

#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

// Pixels of a reading. NaN and infinity are left out. The others are all averaged: dropping the darkest would make the exposure jump when
// pixels fall below some threshold.
struct MeterCounts {
  std::uint64_t averaged = 0;
  std::uint64_t nan = 0, infinite = 0;
  std::uint64_t negative = 0;  // averaged as the darkest
  friend bool operator==(const MeterCounts&, const MeterCounts&) = default;
};

// Values outside count as the ends: what a meter can tell apart. Black would otherwise have a logarithm of minus infinity.
struct MeterLimits {
  double least = 0x1p-13, greatest = 0x1p21;  // EV100 -10 and 24 for luminances and K = 12.5
};
// Which part of the pixels, sorted by value, is averaged; a pixel that a border divides counts in part.
struct Percentiles {
  double low = 0.1, high = 0.9;
};

// Errors of both meters: NOTHING_METERED (no pixel that is finite), METER_LIMITS_INVALID unless 0 < least <= greatest, finite;
// PERCENTILES_INVALID unless 0 <= low <= high <= 1.
struct LogAverage {
  double mean = 0;  // the geometric mean, in the unit of the values
  MeterCounts counts;
};
Result<LogAverage> log_average(std::span<const float> values, const MeterLimits& limits = {});

// Counts of values in bins of 1/128 of an octave. A mean is within .0057 EV of the one over the sorted pixels: every value is moved by half
// a bin at most, log2(1 + 1/128) / 2, in the same order. It never rises when pixels get darker or dark ones are added.
class MeterHistogram {
 public:
  MeterHistogram();
  void add(std::span<const float> values);
  void add(std::span<const Vec3f> rgb);  // by their luminance, linear Rec.709
  void add(const MeterHistogram& other);

  Result<double> mean(const Percentiles& percentiles = {}, const MeterLimits& limits = {}) const;  // geometric
  Result<double> percentile(double share, const MeterLimits& limits = {}) const;
  const MeterCounts& counts() const { return counts_; }

 private:
  void add(float value);
  std::vector<std::uint64_t> bins_;
  MeterCounts counts_;
};

// Time constants: after one, 1 - 1/e = 63 % of a step is made. 0 follows at once. Eyes get used to light faster than to darkness.
struct Adaptation {
  double brighter_s = 0.4, darker_s = 1.2;
};
// EV after `elapsed_s`: target + (ev - target) e^(-elapsed / time constant), the solution of the differential equation, so that one step of
// two seconds is two steps of one whatever the frame rate. An infinite time arrives. ADAPTATION_INVALID: not finite, or a negative time.
Result<double> adapted_ev100(double ev100, double target_ev100, double elapsed_s, const Adaptation& adaptation);

// The power of two nearest to exposure_of_ev100: multiplied into a picture before it is stored in a format with a largest number (pixel.h),
// it can be taken out again, or replaced by the next frame's, without rounding anything. 2^-126 to 2^126.
double pre_exposure_of_ev100(double ev100, const Calibration& calibration);

}  // namespace etendue
