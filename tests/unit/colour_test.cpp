#include "etendue/colour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

double largest(const Rgb& c) { return std::max({c.x, c.y, c.z}); }
void expect_rgb(const Rgb& c, double r, double g, double b, double tolerance) {
  EXPECT_NEAR(c.x, r, tolerance);
  EXPECT_NEAR(c.y, g, tolerance);
  EXPECT_NEAR(c.z, b, tolerance);
}

// Chromaticities printed to 6 digits, linear Rec.709 with the largest channel 1 printed to 5; computed independently from the same tables.
TEST(Planckian, MatchesTheTable) {
  struct Row {
    double kelvin, x, y, r, g, b;
  };
  const Row rows[] = {
      {1000, .652751, .344462, 1, .00861, -.01957}, {1500, .585718, .393121, 1, .13298, -.01967},
      {2000, .526677, .413297, 1, .25666, .00810},  {2700, .459859, .410599, 1, .41525, .09911},
      {2856, .447535, .407428, 1, .44772, .12649},  {4000, .380440, .376747, 1, .65347, .37724},
      {5000, .345101, .351608, 1, .79151, .62821},  {5772, .326553, .335834, 1, .87645, .82019},
      {6500, .313526, .323628, 1, .94267, .99194},  {10000, .280634, .288288, .60948, .69519, 1},
      {20000, .256457, .257631, .40565, .53634, 1}, {40000, .247203, .244720, .34265, .48038, 1},
  };
  for (const Row& row : rows) {
    const Chromaticity xy = *planckian(row.kelvin);
    EXPECT_NEAR(xy.x, row.x, 5.1e-7) << row.kelvin;
    EXPECT_NEAR(xy.y, row.y, 5.1e-7) << row.kelvin;
    const Rgb rgb = to_rgb(xy);
    expect_rgb(rgb / largest(rgb), row.r, row.g, row.b, 5.1e-6);
  }
}

// Illuminant A is a Planckian radiator of 2848 K with c2 = 1.435e-2 m K; CIE prints (0.44758, 0.40745), made with 5 nm tables.
TEST(Planckian, GivesIlluminantA) {
  const Chromaticity a = *planckian(2848 * 1.438776877 / 1.435);
  EXPECT_NEAR(a.x, 0.44758, 1.5e-5);
  EXPECT_NEAR(a.y, 0.40745, 1.5e-5);
}

TEST(Planckian, KeepsToItsDomain) {
  for (const double kelvin : {100.0, 100000.0}) {
    const Chromaticity xy = *planckian(kelvin);
    EXPECT_TRUE(std::isfinite(xy.x) && xy.y > 0) << kelvin;
  }
  for (const double kelvin : {99.9, 0.0, -100.0, 100001.0, std::nan(""), -HUGE_VAL}) {
    const Result<Chromaticity> xy = planckian(kelvin);
    ASSERT_FALSE(xy.ok()) << kelvin;
    EXPECT_EQ(xy.error().code, "TEMPERATURE_OUT_OF_RANGE");
  }
}

// Towards infinite temperature the chromaticity is that of lambda^-4, (0.2399, 0.2341); it moves blue-wards all the way.
TEST(Planckian, MovesTowardsBlueWithTemperature) {
  double x = 1;
  for (int i = 0; i <= 48; ++i) {
    const double next = planckian(1000 * std::pow(1.1, i))->x;  // to 97000 K
    EXPECT_LT(next, x);
    x = next;
  }
  EXPECT_NEAR(planckian(1e5)->x, 0.2399, 3e-3);
}

TEST(Daylight, GivesD65AndIsContinuous) {
  // D65's temperature is 6500 K times 1.4388 / 1.4380, the change of c2 since it was defined.
  const Chromaticity d65 = *daylight(6500 * 1.4388 / 1.4380);
  EXPECT_NEAR(d65.x, 0.31272, 5.1e-6);
  EXPECT_NEAR(d65.y, 0.32913, 5.1e-6);
  expect_rgb(to_rgb(d65), 0.9995, 1.0003, 0.9991, 5.1e-5);
  // The example of colour-science's CCT_to_xy_CIE_D.
  EXPECT_NEAR(daylight(6504.38938305)->x, 0.3127077, 1e-7);
  EXPECT_NEAR(daylight(6504.38938305)->y, 0.3291128, 1e-7);
  EXPECT_NEAR(daylight(7000)->x, daylight(std::nextafter(7000, 8000))->x, 1e-6);
  EXPECT_FALSE(daylight(3999).ok());
  EXPECT_FALSE(daylight(25001).ok());
}

TEST(ToRgb, MatchesTheCommandsManual) {
  expect_rgb(to_rgb(*planckian(5600)), 1.1324, 0.9726, 0.8811, 5.1e-5);
  expect_rgb(to_rgb(*planckian(6500)), 1.0434, 0.9836, 1.0350, 5.1e-5);
}

TEST(ToRgb, WhiteIsD65AndPrimariesAreTheirs) {
  expect_rgb(to_rgb({0.3127, 0.3290}), 1, 1, 1, 1e-15 * 8);
  const Chromaticity red = to_chromaticity({1, 0, 0}), green = to_chromaticity({0, 2, 0}), blue = to_chromaticity({0, 0, 3});
  EXPECT_NEAR(red.x, 0.64, 1e-15);
  EXPECT_NEAR(red.y, 0.33, 1e-15);
  EXPECT_NEAR(green.y, 0.60, 1e-15);
  EXPECT_NEAR(blue.x, 0.15, 1e-15);
}

// Luminance is 1 by the published weights, also out of gamut; the way back loses a few roundings.
TEST(ToRgb, HasUnitLuminanceAndReturns) {
  for (int i = 3; i < 13; ++i)
    for (int j = 1; i + j < 19; ++j) {
      const double x = i / 20.0, y = j / 20.0;
      const Rgb rgb = to_rgb({x, y});
      EXPECT_NEAR(luminance_of(rgb), 1, 1e-13);
      const Chromaticity back = to_chromaticity(rgb);
      EXPECT_NEAR(back.x, x, 1e-13);
      EXPECT_NEAR(back.y, y, 1e-13);
    }
}

TEST(ToRgb, ColoursWithoutLuminanceAreBlack) {
  EXPECT_EQ(to_rgb({0.3, 0}), (Rgb{0, 0, 0}));
  EXPECT_EQ(to_rgb({0, 0}), (Rgb{0, 0, 0}));
  EXPECT_EQ(to_chromaticity({0, 0, 0}).x, 0);
}

TEST(Clipped, KeepsLuminanceAndInGamutColours) {
  const Rgb candle = to_rgb(*planckian(1500));
  ASSERT_LT(candle.z, 0);
  const Rgb clipped = clipped_keeping_luminance(candle);
  EXPECT_EQ(clipped.z, 0);
  EXPECT_NEAR(luminance_of(clipped), luminance_of(candle), 1e-15);
  expect_rgb(clipped_keeping_luminance({0.2, 0.5, 0.9}), 0.2, 0.5, 0.9, 1e-15);
  EXPECT_EQ(clipped_keeping_luminance({-1, -1, -1}), (Rgb{0, 0, 0}));
}

}  // namespace
}  // namespace etendue
