#include "etendue/arithmetic.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

// All of it can be computed while compiling, and of the right type.
static_assert(3 * lumens(800) + lumens(450) - lumens(50) == lumens(2800));
static_assert(lumens(800) * 3 / 4 == lumens(600));
static_assert(metres(3) / metres(2) == 1.5);
static_assert(-metres(3) < metres(0));
static_assert(watts(60) * lumens_per_watt(15) == lumens(900));
static_assert(watts_per_square_metre(8) * lumens_per_watt(100) == lux(800));
static_assert(lumens(900) / watts(60) == lumens_per_watt(15));
static_assert(candelas(100) * steradians(2) == lumens(200));
static_assert(lumens(200) / steradians(2) == candelas(100));

// One stop is a factor of 2 in luminance: from EV 15 to EV 12 there are three, and luminance falls to an eighth.
TEST(Arithmetic, StopsBetweenExposureValues) {
  constexpr Quantity<Dimension::stop> apart = ev100s(15) - ev100s(12);
  EXPECT_EQ(apart.si, 3);
  EXPECT_EQ(luminance_of_ev100((ev100s(15) - apart).si) * 8, luminance_of_ev100(15));
  EXPECT_EQ(ev100s(12) + apart, ev100s(15));
}

// Two sums of the same lamps, flux by flux and through their intensities.
TEST(Arithmetic, TwoBulbsGiveTheSumOfTheirIntensities) {
  const Result<Intensity> one = intensity(lumens(800), PointShape{}), other = intensity(lumens(450), PointShape{}),
                          both = intensity(lumens(800) + lumens(450), PointShape{});
  ASSERT_TRUE(one && other && both);
  EXPECT_DOUBLE_EQ((*one + *other).si, both->si);
}

}  // namespace
}  // namespace etendue
