#include "etendue/false_colour.h"

#include "etendue/colour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace etendue {
namespace {

// Lightness orders the colours: luminance rises all the way from near black, and stays below the white of what is above the scale.
TEST(FalseColour, LuminanceRises) {
  double before = 0;
  for (int i = 0; i <= 1000; ++i) {
    const Rgb c = false_colour(i / 1000.0);
    EXPECT_GT(luminance_of(c), before);
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(c[k] >= 0 && c[k] <= 1);
    before = luminance_of(c);
  }
  EXPECT_LT(before, 1);
  EXPECT_EQ(false_colour(-3), false_colour(0));
  EXPECT_EQ(false_colour(7), false_colour(1));
}

TEST(FalseColour, BandsAreAStopEach) {
  std::vector<float> ev;
  for (int i = 0; i < 1600; ++i) ev.push_back(static_cast<float>(i) / 100);
  std::vector<Vec3f> colours(ev.size());
  ASSERT_TRUE(false_colour(ev, {.least = 0, .greatest = 16, .bands = 16}, colours).ok());
  for (std::size_t i = 1; i < ev.size(); ++i) EXPECT_EQ(colours[i] != colours[i - 1], i % 100 == 0) << ev[i];
  // The same picture in lux on a logarithmic scale, 2.5 lx at EV 0.
  std::vector<float> lux;
  lux.reserve(ev.size());
  for (const float x : ev) lux.push_back(static_cast<float>(2.5 * std::exp2(x + 0.001)));
  std::vector<Vec3f> same(ev.size());
  ASSERT_TRUE(false_colour(lux, {.least = 2.5, .greatest = 2.5 * 65536, .logarithmic = true, .bands = 16}, same).ok());
  EXPECT_EQ(same, colours);
}

TEST(FalseColour, WhatIsOutsideIsMarkedAndCounted) {
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<float> values{-1, 0, 1, 2, infinity, -infinity, std::nanf("")};
  std::vector<Vec3f> colours(values.size());
  const Result<FalseColourCounts> counts = false_colour(values, {.least = 0, .greatest = 1}, colours);
  EXPECT_EQ(*counts, (FalseColourCounts{2, 2, 1}));
  EXPECT_EQ(colours[0], (Vec3f{0, 0, 0}));
  EXPECT_EQ(colours[1], vec_cast<float>(false_colour(0)));
  EXPECT_EQ(colours[2], vec_cast<float>(false_colour(1)));
  EXPECT_EQ(colours[4], (Vec3f{1, 1, 1}));
  EXPECT_EQ(colours[6], (Vec3f{1, 0, 1}));
  EXPECT_EQ(false_colour(values, {.least = 1, .greatest = 1}, colours).error().code, "SCALE_INVALID");
  EXPECT_EQ(false_colour(values, {.least = 0, .greatest = 1, .logarithmic = true}, colours).error().code, "SCALE_INVALID");
  EXPECT_EQ(false_colour(values, {.least = 0, .greatest = 1, .bands = -1}, colours).error().code, "SCALE_INVALID");
  EXPECT_EQ(false_colour(values, {.least = 0, .greatest = 1}, std::span(colours).first(2)).error().code, "BATCH_SIZES_DIFFER");
}

}  // namespace
}  // namespace etendue
