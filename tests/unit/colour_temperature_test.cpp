#include "etendue/colour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

// 500 K to 100000 K in equal ratios.
constexpr int steps = 76;
double kelvin_at(int step) { return 500 * std::pow(200, step / static_cast<double>(steps)); }

// On the locus, a temperature and its chromaticity are one; the definition here is the plain sum of planckian().
TEST(ColourTemperature, OfTheLocusIsItsTemperature) {
  for (int step = 0; step <= steps; ++step) {
    const double kelvin = kelvin_at(step);
    const ColourTemperature found = *to_colour_temperature(*planckian(kelvin));
    EXPECT_NEAR(found.kelvin / kelvin, 1, 2e-11) << kelvin;
    EXPECT_NEAR(found.duv, 0, 1e-14) << kelvin;
  }
}

// .001 K in 1000 K to 40000 K and |Duv| <= .02; a millionth in 500 K to 100000 K and |Duv| <= .05; Duv to 1e-9.
TEST(ColourTemperature, ReturnsBothWays) {
  double worst_K = 0, worst_relative = 0, worst_duv = 0;
  for (int step = 0; step <= steps; ++step)
    for (int i = -10; i <= 10; ++i) {
      const double kelvin = kelvin_at(step), duv = i * 0.005;
      const ColourTemperature found = *to_colour_temperature(*to_chromaticity(ColourTemperature{kelvin, duv}));
      const double error = std::abs(found.kelvin - kelvin);
      if (std::abs(duv) <= 0.0201 && kelvin >= 1000 && kelvin <= 40000) worst_K = std::max(worst_K, error);
      worst_relative = std::max(worst_relative, error / kelvin);
      worst_duv = std::max(worst_duv, std::abs(found.duv - duv));
    }
  EXPECT_LE(worst_K, 1e-6);  // of the .001 K allowed: rounding of x and y alone moves 40000 K by 1e-8 K
  EXPECT_LE(worst_relative, 1e-9);
  EXPECT_LE(worst_duv, 1e-12);
}

// The nearest point is nearest: no other of the locus, walked from 10 to 2000 mired, is nearer than |Duv|.
TEST(ColourTemperature, IsTheNearestPoint) {
  for (const double kelvin : {600.0, 2000.0, 5216.0, 30000.0})
    for (const double duv : {-0.05, -0.02, 0.02, 0.05}) {
      const Uv q = to_uv1960(*to_chromaticity(ColourTemperature{kelvin, duv}));
      double nearest = 1;
      for (int i = 0; i <= 2000; ++i) {
        const double mired = 10 * std::pow(200, i / 2000.0);
        const Uv p = to_uv1960(*planckian(1e6 / mired));
        nearest = std::min(nearest, std::hypot(p.u - q.u, p.v - q.v));
      }
      EXPECT_GE(nearest, std::abs(duv) - 1e-12) << kelvin << " " << duv;
      EXPECT_LE(nearest, std::abs(duv) + 1e-4) << kelvin << " " << duv;
    }
}

// D65: 6503.6 K with the c2 of its age is 6500 K times 1.4388/1.4380; CIE (1960) Duv +.0032. Greenish is positive.
TEST(ColourTemperature, KnownWhites) {
  const ColourTemperature d65 = *to_colour_temperature({0.31272, 0.32903});
  EXPECT_NEAR(d65.kelvin, 6503.6, 1.5);
  EXPECT_NEAR(d65.duv, 0.0032, 5e-5);
  const ColourTemperature a = *to_colour_temperature({0.44758, 0.40745});
  EXPECT_NEAR(a.kelvin, 2855.5, 0.7);
  EXPECT_NEAR(a.duv, 0, 2e-5);
  EXPECT_GT(to_colour_temperature({0.32, 0.36})->duv, 0);
  EXPECT_LT(to_colour_temperature({0.32, 0.31})->duv, 0);
}

TEST(ColourTemperature, FarAwayIsAnError) {
  // What others answer with 5520.33 K, 2021 K and 220480 K.
  for (const Chromaticity& xy : {Chromaticity{std::nan(""), 0.3}, {0, 0}, {0.332, 0.1858}, {0.8, 0.1}, {0.1, 0.8}, {0.3, -0.2}}) {
    const Result<ColourTemperature> none = to_colour_temperature(xy);
    ASSERT_FALSE(none.ok()) << xy.x << " " << xy.y;
    EXPECT_EQ(none.error().code, "NOT_NEAR_LOCUS");
  }
  // Just beyond infinite temperature, and redder than 500 K.
  EXPECT_EQ(to_colour_temperature(*planckian(HUGE_VAL)).error().code, "TEMPERATURE_OUT_OF_RANGE");
  EXPECT_EQ(to_colour_temperature({0.236, 0.228}).error().code, "TEMPERATURE_OUT_OF_RANGE");
  EXPECT_EQ(to_colour_temperature(*planckian(450)).error().code, "TEMPERATURE_OUT_OF_RANGE");
  EXPECT_EQ(to_chromaticity(ColourTemperature{3000, 0.051}).error().code, "DUV_OUT_OF_RANGE");
  EXPECT_EQ(to_chromaticity(ColourTemperature{3000, std::nan("")}).error().code, "DUV_OUT_OF_RANGE");
  for (const double kelvin : {0.0, -100.0, 499.0, 1e6, std::nan("")})
    EXPECT_EQ(to_chromaticity(ColourTemperature{kelvin, 0}).error().code, "TEMPERATURE_OUT_OF_RANGE");
}

TEST(Planckian, ReachesItsLimit) {
  // The sum of lambda^-4 over the tables, made independently.
  EXPECT_NEAR(planckian(HUGE_VAL)->x, 0.239877, 1e-6);
  EXPECT_NEAR(planckian(HUGE_VAL)->y, 0.234037, 1e-6);
}

// Full CTO, 3200 K from 5500 K, is +131 mired.
TEST(Mired, ShiftsLikeAFilter) {
  EXPECT_EQ(*mired_of(5000), 200);
  EXPECT_NEAR(*mired_of(3200) - *mired_of(5500), 130.7, 0.05);
  EXPECT_NEAR(*shifted_by_mired(3200, -130.6818181818), 5500, 1e-6);
  for (const double bad : {0.0, -5.0, std::nan(""), 1e-320}) EXPECT_FALSE(mired_of(bad).ok()) << bad;
  EXPECT_FALSE(shifted_by_mired(5000, -200).ok());
  EXPECT_FALSE(shifted_by_mired(5000, std::nan("")).ok());
}

TEST(Daylight, JoinsThePlanckianLocus) {
  // The two loci are .0037 apart at 4000 K; the joined one has no step there, nor at 2500 K.
  EXPECT_NEAR(difference_uv1976(*daylight(4000), *planckian(4000)), 0.0037, 5e-5);
  EXPECT_LE(difference_uv1976(*daylight_or_planckian(4000), *daylight_or_planckian(std::nextafter(4000, 0))), 1e-6);
  EXPECT_LE(difference_uv1976(*daylight_or_planckian(2500), *daylight_or_planckian(std::nextafter(2500, 3000))), 1e-6);
  EXPECT_EQ(daylight_or_planckian(6500)->x, daylight(6500)->x);
  EXPECT_EQ(daylight_or_planckian(1800)->x, planckian(1800)->x);
  // CIE's two polynomials meet at 7000 K to 3.7e-7.
  EXPECT_LE(difference_uv1976(*daylight(7000), *daylight(std::nextafter(7000, 8000))), 3.8e-7);
  EXPECT_FALSE(daylight_or_planckian(99).ok());
  EXPECT_FALSE(daylight_or_planckian(25001).ok());
}

}  // namespace
}  // namespace etendue
