#include "etendue/batch.h"

#include "instruction_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace etendue {
namespace {

constexpr float none = -77;
constexpr float infinity = std::numeric_limits<float>::infinity();
const Calibration& frostbite() {
  static const Calibration found = *calibration("frostbite");
  return found;
}

// 2^EV at 60001 values between the ends of normal luminances, -123 and 131 with K = 12.5, but for the 1e-4 beside them.
TEST(BatchExposure, LuminanceIsThatOfTheDouble) {
  std::vector<float> ev(60001), nit(ev.size());
  for (std::size_t i = 0; i < ev.size(); ++i) ev[i] = -122.9998f + static_cast<float>(i) * (253.9996f / 60000);
  on_each_instruction_set([&] {
    std::fill(nit.begin(), nit.end(), none);
    const BatchOutcome done = luminance_of_ev100(ev, frostbite(), nit, none);
    ASSERT_TRUE(done.ok());
    EXPECT_EQ(*done, 0U);
    double worst = 0;
    for (std::size_t i = 0; i < ev.size(); ++i)
      worst = std::max(worst, std::abs(std::log2(nit[i] / luminance_of_ev100(static_cast<double>(ev[i]), frostbite()))));
    EXPECT_LE(worst, 3e-7);  // of the 1e-6 asked for
  });
}

TEST(BatchExposure, WholeStopsAreExact) {
  std::vector<float> ev(241), nit(ev.size());
  std::iota(ev.begin(), ev.end(), -120.0f);
  on_each_instruction_set([&] {
    ASSERT_TRUE(luminance_of_ev100(ev, frostbite(), nit, none).ok());
    for (std::size_t i = 0; i < ev.size(); ++i) EXPECT_EQ(nit[i], std::ldexp(0.125f, static_cast<int>(ev[i])));
  });
}

// Every 997th positive float, subnormals included: 2.1 million.
TEST(BatchExposure, ExposureValueIsThatOfTheDouble) {
  std::vector<float> nit, ev;
  for (std::uint32_t bits = 1; bits < 0x7f800000; bits += 997) nit.push_back(std::bit_cast<float>(bits));
  ev.resize(nit.size());
  std::vector<double> exact(nit.size());
  std::transform(nit.begin(), nit.end(), exact.begin(), [](float l) { return *ev100_of_luminance(static_cast<double>(l), frostbite()); });
  on_each_instruction_set([&] {
    const BatchOutcome done = ev100_of_luminance(nit, frostbite(), ev, none);
    ASSERT_TRUE(done.ok());
    EXPECT_EQ(*done, 0U);
    double worst = 0, worst_beside_rounding = 0;
    for (std::size_t i = 0; i < nit.size(); ++i) {
      const double error = std::abs(ev[i] - exact[i]);
      const float size = std::abs(ev[i]);
      if (size < 16) worst = std::max(worst, error);
      worst_beside_rounding = std::max(worst_beside_rounding, error - (std::nextafter(size, infinity) - size) / 2);
    }
    EXPECT_LE(worst, 7e-7);
    EXPECT_LE(worst_beside_rounding, 2e-7);
  });
}

// 0, negative, infinite and NaN luminances have no exposure value: counted, and given what was asked for; at every place of a vector.
TEST(BatchExposure, WhatHasNoneIsCounted) {
  on_each_instruction_set([&] {
    for (std::size_t size = 0; size < 70; ++size) {
      std::vector<float> nit(size, 8.0f), ev(size);
      std::size_t bad = 0;
      for (std::size_t i = size % 3; i < size; i += 5, ++bad) {
        const float values[] = {0, -1, infinity, std::nanf("")};
        nit[i] = values[bad % 4];
      }
      const BatchOutcome done = ev100_of_luminance(nit, frostbite(), ev, none);
      ASSERT_TRUE(done.ok());
      EXPECT_EQ(*done, bad);
      for (std::size_t i = 0; i < size; ++i) EXPECT_EQ(ev[i], nit[i] == 8 ? 6 : none);
    }
    std::vector<float> ev = {std::nanf(""), 0, 1e30f, -1e30f, infinity, -infinity};
    const BatchOutcome done = luminance_of_ev100(ev, frostbite(), ev, none);  // in place
    ASSERT_TRUE(done.ok());
    EXPECT_EQ(*done, 1U);
    EXPECT_EQ(ev[0], none);
    EXPECT_EQ(ev[1], 0.125f);
    for (std::size_t i = 2; i < ev.size(); ++i) EXPECT_TRUE(std::isnormal(ev[i])) << ev[i];
  });
}

TEST(BatchExposure, ScaledIsTheRoundedProduct) {
  std::vector<float> lumens(1003), candelas(lumens.size());
  for (std::size_t i = 0; i < lumens.size(); ++i) lumens[i] = 1 + static_cast<float>(i) * 1.37f;
  on_each_instruction_set([&] {
    ASSERT_TRUE(scaled(lumens, 1 / (4 * pi), candelas).ok());
    for (std::size_t i = 0; i < lumens.size(); ++i) {
      const double exact = lumens[i] / (4 * pi);
      EXPECT_LE(std::abs(candelas[i] - exact), std::nextafter(candelas[i], infinity) - candelas[i]);
    }
  });
}

// Finite in, finite out; what is not a number stays none.
TEST(BatchExposure, ScaledStaysFinite) {
  const std::vector<float> in = {0, 1, -1, 3e38f, -3e38f, 1e-45f, std::nanf("")};
  std::vector<float> out(in.size());
  on_each_instruction_set([&] {
    for (const double factor : {0.0, 1e-50, 2.0, -1.7, 1e300, -1e300}) {
      ASSERT_TRUE(scaled(in, factor, out).ok());
      for (std::size_t i = 0; i + 1 < in.size(); ++i) EXPECT_TRUE(std::isfinite(out[i])) << in[i] << " " << factor;
      EXPECT_TRUE(std::isnan(out.back()));
    }
  });
}

TEST(BatchExposure, CalibrationsMustHaveAMeter) {
  std::vector<float> in(4), out(4);
  for (const double k : {0.0, -12.5, std::nan(""), HUGE_VAL}) {
    Calibration broken = frostbite();
    broken.meter_k = k;
    EXPECT_EQ(luminance_of_ev100(in, broken, out, none).error().code, "CALIBRATION_INVALID");
    EXPECT_EQ(ev100_of_luminance(in, broken, out, none).error().code, "CALIBRATION_INVALID");
  }
}

TEST(BatchExposure, SizesMustAgree) {
  std::vector<float> in(4), out(3);
  EXPECT_EQ(scaled(in, 2, out).error().code, "BATCH_SIZES_DIFFER");
  EXPECT_EQ(luminance_of_ev100(in, frostbite(), out, none).error().code, "BATCH_SIZES_DIFFER");
  EXPECT_EQ(ev100_of_luminance(in, frostbite(), out, none).error().code, "BATCH_SIZES_DIFFER");
}

}  // namespace
}  // namespace etendue
