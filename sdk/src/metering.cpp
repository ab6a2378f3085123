#include "etendue/metering.h"

#include "parameter_error.h"

#include "etendue/colour.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace etendue {
namespace {

// The upper bits of a positive float, its exponent and 7 of its mantissa, count bins that are equal within an octave and in the order of
// their values. Bins from 2^-24 to 2^40; what is below or above goes to the ends (starlight is 1e-4 cd/m2, the Sun's disc 2^31).
constexpr int least_octave = -24, greatest_octave = 40, bins_an_octave = 128;
constexpr std::size_t bin_count = static_cast<std::size_t>(greatest_octave - least_octave) * bins_an_octave;
std::size_t bin_of(float positive) {
  constexpr std::int64_t first = std::int64_t{127 + least_octave} * bins_an_octave;
  const std::int64_t upper = std::bit_cast<std::uint32_t>(positive) >> 16;
  return static_cast<std::size_t>(std::clamp<std::int64_t>(upper - first, 0, bin_count - 1));
}
// log2 of the geometric middle.
double log2_of_bin(std::size_t bin) {
  const int octave = least_octave + static_cast<int>(bin / bins_an_octave);
  const auto k = static_cast<double>(bin % bins_an_octave);
  return octave + (std::log2(1 + k / bins_an_octave) + std::log2(1 + (k + 1) / bins_an_octave)) / 2;
}

struct Log2Limits {
  double least, greatest;
  double held(double log2) const { return std::clamp(log2, least, greatest); }
};
Result<Log2Limits> checked(const MeterLimits& limits) {
  if (limits.least > 0 && limits.least <= limits.greatest && std::isfinite(limits.greatest))
    return Log2Limits{std::log2(limits.least), std::log2(limits.greatest)};
  return parameter_error("limits", "METER_LIMITS_INVALID",
                         fmt::format("expected limits 0 < least <= greatest, finite, found {} and {}", limits.least, limits.greatest));
}
Error nothing_metered() { return parameter_error("values", "NOTHING_METERED", "expected at least one pixel that is finite, found none"); }

// Whether a value is averaged.
bool counted(float value, MeterCounts& counts) {
  if (std::isnan(value)) return ++counts.nan, false;
  if (std::isinf(value)) return ++counts.infinite, false;
  if (value < 0) ++counts.negative;
  return ++counts.averaged, true;
}

}  // namespace

Result<LogAverage> log_average(std::span<const float> values, const MeterLimits& limits) {
  const Result<Log2Limits> held = checked(limits);
  if (!held) return held.error();
  LogAverage average;
  double sum = 0;
  for (const float value : values)
    if (counted(value, average.counts)) sum += held->held(value > 0 ? std::log2(static_cast<double>(value)) : held->least);
  if (average.counts.averaged == 0) return nothing_metered();
  average.mean = std::exp2(sum / static_cast<double>(average.counts.averaged));
  return average;
}

MeterHistogram::MeterHistogram() : bins_(bin_count) {}

void MeterHistogram::add(float value) {
  if (counted(value, counts_)) ++bins_[value > 0 ? bin_of(value) : 0];
}
void MeterHistogram::add(std::span<const float> values) {
  for (const float value : values) add(value);
}
void MeterHistogram::add(std::span<const Vec3f> rgb) {
  for (const Vec3f& c : rgb) {
    const double luminance = luminance_of(vec_cast<double>(c));
    // Finite channels have a finite luminance: .2126 + .7152 + .0722 is 1, and rounding to float could only pass the largest.
    constexpr double largest = 0x1.fffffep127;
    add(std::isfinite(luminance) ? static_cast<float>(std::clamp(luminance, -largest, largest)) : static_cast<float>(luminance));
  }
}
void MeterHistogram::add(const MeterHistogram& other) {
  for (std::size_t i = 0; i < bins_.size(); ++i) bins_[i] += other.bins_[i];
  counts_.averaged += other.counts_.averaged;
  counts_.nan += other.counts_.nan;
  counts_.infinite += other.counts_.infinite;
  counts_.negative += other.counts_.negative;
}

Result<double> MeterHistogram::mean(const Percentiles& percentiles, const MeterLimits& limits) const {
  const Result<Log2Limits> held = checked(limits);
  if (!held) return held.error();
  if (!(percentiles.low >= 0 && percentiles.low <= percentiles.high && percentiles.high <= 1))
    return parameter_error(percentiles.low >= 0 && percentiles.low <= 1 ? "high" : "low", "PERCENTILES_INVALID",
                           fmt::format("expected percentiles 0 <= low <= high <= 1, found {} and {}", percentiles.low, percentiles.high));
  if (counts_.averaged == 0) return nothing_metered();
  const auto count = static_cast<double>(counts_.averaged);
  const double first = percentiles.low * count, last = percentiles.high * count;
  double below = 0, sum = 0, at_first = 0;
  for (std::size_t i = 0; i < bins_.size() && below <= last; ++i) {
    if (bins_[i] == 0) continue;
    const double above = below + static_cast<double>(bins_[i]), log2 = held->held(log2_of_bin(i));
    sum += std::max(0.0, std::min(above, last) - std::max(below, first)) * log2;
    if (below <= first) at_first = log2;
    below = above;
  }
  // A share of nothing is the pixel at that place.
  return std::exp2(last > first ? sum / (last - first) : at_first);
}

Result<double> MeterHistogram::percentile(double share, const MeterLimits& limits) const {
  const Result<double> found = mean({share, share}, limits);
  return found || found.error().code != "PERCENTILES_INVALID" ? found : about("share", found.error());
}

Result<double> adapted_ev100(double ev100, double target_ev100, double elapsed_s, const Adaptation& adaptation) {
  const double time_constant = target_ev100 > ev100 ? adaptation.brighter_s : adaptation.darker_s;
  if (!std::isfinite(ev100) || !std::isfinite(target_ev100) || !(elapsed_s >= 0) || !(time_constant >= 0))
    return parameter_error(
        !std::isfinite(ev100)          ? "ev100"
        : !std::isfinite(target_ev100) ? "target_ev100"
        : !(elapsed_s >= 0)            ? "elapsed_s"
        : target_ev100 > ev100         ? "brighter_s"
                                       : "darker_s",
        "ADAPTATION_INVALID",
        fmt::format("expected finite exposure values and times from 0 upwards, found EV {} and {}, {} s elapsed, a constant of {} s", ev100,
                    target_ev100, elapsed_s, time_constant));
  if (std::isinf(elapsed_s) || time_constant == 0) return target_ev100;
  return target_ev100 + (ev100 - target_ev100) * std::exp(-elapsed_s / time_constant);
}

double pre_exposure_of_ev100(double ev100, const Calibration& calibration) {
  return std::exp2(std::clamp(std::round(std::log2(exposure_of_ev100(ev100, calibration))), -126.0, 126.0));
}

}  // namespace etendue
