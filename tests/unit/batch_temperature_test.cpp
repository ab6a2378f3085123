#include "etendue/batch.h"

#include "instruction_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace etendue {
namespace {

struct Case {
  ColourTemperature truth;
  Chromaticity xy;
};
// By construction: points on the exact locus' normals.
std::vector<Case> cases(double least_K, double largest_K, double largest_duv) {
  std::vector<Case> all;
  for (int i = 0; i <= 800; ++i)
    for (int j = -10; j <= 10; ++j) {
      const ColourTemperature truth{std::clamp(least_K * std::pow(largest_K / least_K, i / 800.0), least_K, largest_K),
                                    largest_duv * j / 10};
      all.push_back({truth, *to_chromaticity(truth)});
    }
  return all;
}

struct Errors {
  double kelvin = 0, relative = 0, duv = 0;
};
Errors errors_of(const std::vector<Case>& all) {
  std::vector<Chromaticity> xy(all.size());
  std::transform(all.begin(), all.end(), xy.begin(), [](const Case& c) { return c.xy; });
  std::vector<ColourTemperature> found(all.size());
  const BatchOutcome done = to_colour_temperature(xy, found, {});
  EXPECT_TRUE(done.ok());
  EXPECT_EQ(*done, 0U);
  Errors worst;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double error = std::abs(found[i].kelvin - all[i].truth.kelvin);
    worst.kelvin = std::max(worst.kelvin, error);
    worst.relative = std::max(worst.relative, error / all[i].truth.kelvin);
    worst.duv = std::max(worst.duv, std::abs(found[i].duv - all[i].truth.duv));
  }
  return worst;
}

TEST(BatchTemperature, IsTheNearestPoint) {
  const std::vector<Case> usual = cases(1000, 40000, 0.02), everything = cases(500, 100000, 0.05);
  on_each_instruction_set([&] {
    const Errors within = errors_of(usual), anywhere = errors_of(everything);
    EXPECT_LE(within.kelvin, 1e-4);  // of the .001 K asked for
    EXPECT_LE(anywhere.relative, 3e-8);
    EXPECT_LE(anywhere.duv, 1e-11);
  });
}

// All over the diagram, and what is no chromaticity: the batch has a temperature where the double function has one.
TEST(BatchTemperature, HasOneWhereTheDoubleHasOne) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  std::vector<Chromaticity> xy = {{nan, 0.3},     {0.3, nan},  {0, 0},          {0.332, 0.1858}, {0.8, 0.1},
                                  {0.1, 0.8},     {0.3, -0.2}, {infinity, 0.3}, {0.3, infinity}, {-infinity, -infinity},
                                  {1e300, 1e300}, {1.5, 0},    {0.3127, 0.3290}};
  for (int i = -20; i <= 100; ++i)
    for (int j = -20; j <= 100; ++j) xy.push_back({i / 83.0, j / 83.0});
  std::vector<std::uint8_t> has(xy.size());
  std::transform(xy.begin(), xy.end(), has.begin(), [](const Chromaticity& c) { return to_colour_temperature(c).ok() ? 1 : 0; });
  const auto without = static_cast<std::size_t>(std::count(has.begin(), has.end(), 0));
  std::vector<ColourTemperature> found(xy.size());
  on_each_instruction_set([&] {
    const BatchOutcome done = to_colour_temperature(xy, found, {-1, -1});
    ASSERT_TRUE(done.ok());
    EXPECT_EQ(*done, without);
    for (std::size_t i = 0; i < xy.size(); ++i) EXPECT_EQ(found[i].kelvin != -1, has[i] != 0) << xy[i].x << " " << xy[i].y;
  });
}

TEST(BatchTemperature, FitIsAThirdOfAPercent) {
  const std::vector<Case> all = cases(1000, 40000, 0.02);
  std::vector<Vec2f> xy(all.size());
  std::transform(all.begin(), all.end(), xy.begin(), [](const Case& c) {
    return Vec2f{static_cast<float>(c.xy.x), static_cast<float>(c.xy.y)};
  });
  std::vector<float> kelvin(xy.size());
  on_each_instruction_set([&] {
    const BatchOutcome done = fit_colour_temperature(xy, kelvin, 0);
    ASSERT_TRUE(done.ok());
    EXPECT_EQ(*done, 0U);
    double worst = 0;
    for (std::size_t i = 0; i < all.size(); ++i) worst = std::max(worst, std::abs(kelvin[i] / all[i].truth.kelvin - 1));
    EXPECT_LE(worst, 0.0032);
  });
}

// All over the diagram and beside it: what the fit accepts has a colour temperature by the double function, to a quarter.
TEST(BatchTemperature, FitRefusesWhatIsFarAway) {
  const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
  std::vector<Vec2f> xy = {{nan, 0.3F},      {0.3F, nan},           {0, 0},        {0.332F, 0.1858F}, {0.8F, 0.1F},
                           {infinity, 0.3F}, {-infinity, infinity}, {1e30F, 1e30F}};
  for (int i = -60; i <= 260; ++i)
    for (int j = -60; j <= 260; ++j) xy.push_back({static_cast<float>(i) / 200, static_cast<float>(j) / 200});
  std::vector<float> kelvin(xy.size());
  on_each_instruction_set([&] {
    const BatchOutcome done = fit_colour_temperature(xy, kelvin, -1);
    ASSERT_TRUE(done.ok());
    EXPECT_EQ(*done, static_cast<std::size_t>(std::count(kelvin.begin(), kelvin.end(), -1.0F)));
    for (std::size_t i = 0; i < xy.size(); ++i) {
      if (kelvin[i] == -1) continue;
      const Result<ColourTemperature> exact = to_colour_temperature(Chromaticity{xy[i].x, xy[i].y});
      ASSERT_TRUE(exact.ok()) << xy[i].x << " " << xy[i].y;
      EXPECT_LE(std::abs(kelvin[i] / exact->kelvin - 1), 0.25) << xy[i].x << " " << xy[i].y;
    }
  });
}

}  // namespace
}  // namespace etendue
