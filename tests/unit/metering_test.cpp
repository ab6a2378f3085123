#include "etendue/metering.h"

#include "etendue/pixel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace etendue {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

// A picture-like mixture: shadows, a lit middle, a few very bright lamps, some black.
std::vector<float> picture(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> shadows(-3, 2), lit(6, 1.5), lamps(15, 1);
  std::vector<float> values(count);
  for (float& v : values) {
    const unsigned kind = random() % 100;
    v = kind < 2 ? 0.0F : static_cast<float>(std::exp2(kind < 40 ? shadows(random) : kind < 97 ? lit(random) : lamps(random)));
  }
  return values;
}

// The definition: sort, take the pixels between the percentiles, those on a border in part, average their logarithms.
double exact_log2_mean(std::vector<float> values, const Percentiles& p, const MeterLimits& limits) {
  std::sort(values.begin(), values.end());
  const double first = p.low * static_cast<double>(values.size()), last = p.high * static_cast<double>(values.size());
  double sum = 0, weight = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double part = std::max(0.0, std::min(last, i + 1.0) - std::max(first, static_cast<double>(i)));
    sum += part * std::log2(std::clamp(static_cast<double>(values[i]), limits.least, limits.greatest));
    weight += part;
  }
  return sum / weight;
}
double log2_mean(std::span<const float> values, const Percentiles& p, const MeterLimits& limits = {}) {
  MeterHistogram histogram;
  histogram.add(values);
  return std::log2(*histogram.mean(p, limits));
}

// Facts' goal: .01 EV. Derived: half a bin, log2(1 + 1/128) / 2 = .00561.
TEST(Histogram, IsWithinHalfABinOfTheExactMean) {
  const MeterLimits limits;
  double worst = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const std::vector<float> values = picture(2000 + seed, seed);
    for (const Percentiles p : {Percentiles{0, 1}, {0.1, 0.9}, {0.5, 0.95}, {0.8, 0.983}, {0.999, 1}, {0, 0.001}})
      worst = std::max(worst, std::abs(log2_mean(values, p) - exact_log2_mean(values, p, limits)));
  }
  EXPECT_LE(worst, 0.00562);
  EXPECT_LE(worst, 0.01);
  // The worst case there is: all pixels at the beginning of the widest bin.
  const std::vector<float> same(100, 1.0F);
  EXPECT_NEAR(log2_mean(same, {0, 1}), std::log2(1 + 1.0 / 128) / 2, 1e-12);
}

TEST(Histogram, PercentilesAreThoseOfTheSortedPixels) {
  std::vector<float> values = picture(5001, 99);
  MeterHistogram histogram;
  histogram.add(values);
  std::sort(values.begin(), values.end());
  for (const double share : {0.0, 0.05, 0.5, 0.73, 0.99, 1.0}) {
    const auto i = std::min(static_cast<std::size_t>(share * 5001), values.size() - 1);
    const double exact = std::max(static_cast<double>(values[i]), MeterLimits{}.least);
    EXPECT_NEAR(std::log2(*histogram.percentile(share)), std::log2(exact), 0.00562) << share;
  }
}

// The class of defect of Bevy's auto exposure (PR 25798), whose lowest bin was skipped: the exposure jumped when pixels fell into it.
TEST(Histogram, NeverRisesWhenDarkPixelsGrow) {
  for (const Percentiles p : {Percentiles{0, 1}, {0.1, 0.9}, {0.5, 0.95}}) {
    std::vector<float> values = picture(1000, 7);
    double before = log2_mean(values, p), fading = before;
    for (std::size_t i = 0; i < values.size(); i += 10) {  // turned to black, ten at a time
      std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(i), 10, 0.0F);
      const double now = log2_mean(values, p);
      ASSERT_LE(now, before);
      before = now;
    }
    EXPECT_NEAR(before, -13, 0.01);  // all black: the darkest that counts
    // A tenth of the picture fades through that darkest value to black: no step where it passes, and none upwards.
    values = picture(1000, 7);
    for (int hundredth = 0; hundredth < 3000; ++hundredth) {
      const double stop = -hundredth / 100.0;
      std::fill_n(values.begin(), 100, static_cast<float>(std::exp2(stop)));
      const double now = log2_mean(values, p);
      if (hundredth > 0) {
        ASSERT_LE(now, fading);
        ASSERT_LE(fading - now, 0.012);  // at most one bin, by a tenth of the pixels and more where percentiles leave out others
      }
      fading = now;
    }
    // Added beside the picture.
    std::vector<float> more = picture(1000, 7);
    before = log2_mean(more, p);
    for (int i = 0; i < 50; ++i) {
      more.insert(more.end(), 20, 0.0F);
      const double now = log2_mean(more, p);
      ASSERT_LE(now, before);
      before = now;
    }
  }
}

TEST(Histogram, CountsWhatItLeavesOut) {
  std::vector<float> values = picture(1000, 3);
  const double clean = log2_mean(values, {0, 1});
  for (const float bad : {not_a_number, infinity, -infinity, not_a_number}) values.insert(values.begin() + 500, bad);
  MeterHistogram histogram;
  histogram.add(values);
  EXPECT_EQ(histogram.counts(), (MeterCounts{1000, 2, 2, 0}));
  EXPECT_EQ(std::log2(*histogram.mean({0, 1})), clean);
  const Result<LogAverage> average = log_average(values);
  EXPECT_EQ(average->counts, histogram.counts());
  // Negative ones are as dark as black.
  const std::vector<float> negative(7, -3.0F), black(7, 0.0F);
  EXPECT_EQ(log_average(negative)->mean, log_average(black)->mean);
  EXPECT_EQ(log_average(negative)->counts.negative, 7U);
  // Nothing finite: an error, not a number.
  const std::vector<float> nothing{not_a_number, infinity};
  MeterHistogram empty;
  empty.add(nothing);
  EXPECT_EQ(empty.mean().error().code, "NOTHING_METERED");
  EXPECT_EQ(log_average(nothing).error().code, "NOTHING_METERED");
  EXPECT_EQ(histogram.mean({0.9, 0.1}).error().code, "PERCENTILES_INVALID");
  EXPECT_EQ(histogram.mean({0.1, not_a_number}).error().code, "PERCENTILES_INVALID");
  EXPECT_EQ(histogram.mean({0, 1}, {0, 1}).error().code, "METER_LIMITS_INVALID");
}

TEST(Histogram, ColoursByTheirLuminanceAndPartsAddUp) {
  const std::vector<Vec3f> red(5, {10, 0, 0}), largest(3, {3e38F, 3.4e38F, 3.4e38F});
  MeterHistogram a, b;
  a.add(std::span<const Vec3f>(red));
  EXPECT_NEAR(std::log2(*a.mean({0, 1})), std::log2(2.126), 0.00562);
  b.add(std::span<const Vec3f>(largest));
  EXPECT_EQ(b.counts().infinite, 0U);
  b.add(a);
  EXPECT_EQ(b.counts().averaged, 8U);
  EXPECT_NEAR(std::log2(*b.percentile(0.3)), std::log2(2.126), 0.00562);
}

TEST(LogAverage, IsTheGeometricMean) {
  const std::vector<float> values{1, 2, 4, 8};
  EXPECT_NEAR(log_average(values)->mean, std::exp2(1.5), 1e-12);
  const std::vector<float> with_black{1, 0};
  EXPECT_NEAR(log_average(with_black, {0.25, 100})->mean, 0.5, 1e-12);
  const std::vector<float> with_lamp{1, 1e30F};
  EXPECT_NEAR(log_average(with_lamp, {0.25, 4})->mean, 2, 1e-12);
}

// Rooms of grey 10 % and 90 % under the same light: by luminance they read log2(9) stops apart, by illuminance alike. A grey of K pi / C =
// 15.7 % reads the same both ways.
TEST(Illuminance, ReadingDoesNotDependOnAlbedo) {
  const Calibration calibration = *etendue::calibration("frostbite");
  const std::vector<float> illuminance = picture(4000, 11);
  const auto reading = [&](double albedo) {
    std::vector<float> luminance;
    luminance.reserve(illuminance.size());
    for (const float e : illuminance) luminance.push_back(static_cast<float>(albedo / pi * e));
    MeterHistogram histogram;
    histogram.add(luminance);
    return *ev100_of_luminance(*histogram.mean({0.5, 0.9}), calibration);
  };
  EXPECT_NEAR(reading(0.9) - reading(0.1), std::log2(9), 0.012);
  MeterHistogram of_illuminance;
  of_illuminance.add(illuminance);
  const double by_illuminance = *ev100_of_illuminance(*of_illuminance.mean({0.5, 0.9}), calibration);
  EXPECT_NEAR(by_illuminance, reading(calibration.meter_k * pi / calibration.meter_c), 0.012);
}

TEST(Adaptation, OneStepIsTwoOfHalfTheTime) {
  const Adaptation eye{0.4, 1.2};
  for (const auto& [from, to] : {std::pair{2.0, 14.0}, {14.0, 2.0}}) {
    const double once = *adapted_ev100(from, to, 0.6, eye), half = *adapted_ev100(*adapted_ev100(from, to, 0.3, eye), to, 0.3, eye);
    EXPECT_NEAR(once, half, 1e-14 * 16);
    double many = from;
    for (int i = 0; i < 600; ++i) many = *adapted_ev100(many, to, 0.001, eye);
    EXPECT_NEAR(many, once, 1e-12 * 16);
    EXPECT_LT(std::abs(once - to), std::abs(from - to));
  }
  // 1 - 1/e after a time constant; brighter faster than darker.
  EXPECT_NEAR(*adapted_ev100(0, 10, 0.4, eye), 10 * (1 - std::exp(-1)), 1e-14 * 16);
  EXPECT_NEAR(*adapted_ev100(10, 0, 1.2, eye), 10 * std::exp(-1), 1e-14 * 16);
  EXPECT_EQ(*adapted_ev100(3, 8, 0, eye), 3);
  EXPECT_EQ(*adapted_ev100(3, 8, 1, {0, 0}), 8);
  EXPECT_EQ(*adapted_ev100(3, 8, infinity, eye), 8);
  for (const double bad : {-1.0, static_cast<double>(not_a_number)})
    EXPECT_EQ(adapted_ev100(3, 8, bad, eye).error().code, "ADAPTATION_INVALID");
  EXPECT_EQ(adapted_ev100(3, not_a_number, 1, eye).error().code, "ADAPTATION_INVALID");
}

// A noon scene overflows half; pre-exposed it does not, and comes back with no more than half's own rounding. Changing frames is exact.
TEST(PreExposure, IsAPowerOfTwo) {
  const Calibration calibration = *etendue::calibration("frostbite");
  for (int i = -60; i <= 200; ++i) {
    const double ev = i / 10.0;
    const double scale = pre_exposure_of_ev100(ev, calibration);
    int exponent = 0;
    EXPECT_EQ(std::frexp(scale, &exponent), 0.5);
    EXPECT_LE(std::abs(std::log2(scale / exposure_of_ev100(ev, calibration))), 0.5 + 1e-12);
  }
  PackCounts counts;
  const double lamp = 90000.0, scale = pre_exposure_of_ev100(15, calibration);
  (void)pack_half(lamp, counts);
  EXPECT_EQ(counts.overflow, 1U);
  EXPECT_NEAR(unpack_half(pack_half(lamp * scale, counts)) / scale, lamp, lamp * 0x1p-11);
  EXPECT_EQ(counts.overflow, 1U);
  const float pixel = 1234.567F;
  EXPECT_EQ(static_cast<float>(pixel * scale) / static_cast<float>(scale), pixel);
  EXPECT_EQ(pre_exposure_of_ev100(1e9, calibration), 0x1p-126);
}

}  // namespace
}  // namespace etendue
