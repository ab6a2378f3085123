// Webs on other angles: nothing moves but what is said to.
#include "etendue/photometric_transform.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "photometry_builder.h"

namespace etendue {
namespace {

using test::distribution_of;
using test::steps;
using test::web_of;

double lopsided(const Vec3d& u) { return 100 * (1 + 0.5 * u.x - 0.3 * u.y * u.z - 0.6 * u.z); }

// The largest difference of two webs at many random directions.
double largest_at_random(const IntensityWeb& a, const IntensityWeb& b) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> height(-1, 1), turn(0, 360);
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const double gamma = std::acos(height(generator)) * 180 / pi, c = turn(generator);
    worst = std::max(worst, std::abs(a.at(c, gamma) - b.at(c, gamma)));
  }
  return worst;
}

TEST(Resampled, FinerAnglesChangeNothing) {
  const IntensityDistribution d = distribution_of(WebType::c, WebSymmetry::none, steps(0, 180, 15), steps(0, 330, 30), lopsided);
  const Result<ResampledGrid> fine = resampled(d.grid, vertical_steps(d.grid, 5), horizontal_steps(d.grid, 10));
  ASSERT_TRUE(fine) << fine.error().text;
  EXPECT_EQ(fine->grid.horizontal_deg.size(), 37U);
  EXPECT_LT(fine->error, 1e-12 * 200);
  EXPECT_LT(largest_at_random(web_of(d), web_of(with_grid(d, fine->grid))), 1e-12 * 200);
  EXPECT_NEAR(web_of(with_grid(d, fine->grid)).flux_lm(), web_of(d).flux_lm(), 1e-12 * web_of(d).flux_lm());
}

// The stated error is reached, and nowhere exceeded.
TEST(Resampled, ItsErrorIsTheLargestDifference) {
  for (const WebSymmetry symmetry : {WebSymmetry::none, WebSymmetry::quadrant, WebSymmetry::rotational}) {
    const std::vector<double> planes = symmetry == WebSymmetry::none       ? steps(0, 345, 15)
                                       : symmetry == WebSymmetry::quadrant ? steps(0, 90, 15)
                                                                           : std::vector<double>{0};
    const IntensityDistribution d = distribution_of(WebType::c, symmetry, steps(0, 180, 5), planes, lopsided);
    const Result<ResampledGrid> coarse = resampled(d.grid, vertical_steps(d.grid, 12), horizontal_steps(d.grid, 40));
    ASSERT_TRUE(coarse) << coarse.error().text;
    ASSERT_GT(coarse->error, 0.1);
    const IntensityWeb before = web_of(d), after = web_of(with_grid(d, coarse->grid));
    const double seen = largest_at_random(before, after);
    EXPECT_LE(seen, coarse->error * (1 + 1e-12));
    double reached = 0;
    for (const double c : d.grid.horizontal_deg)
      for (const double gamma : d.grid.vertical_deg) reached = std::max(reached, std::abs(before.at(c, gamma) - after.at(c, gamma)));
    for (const double c : coarse->grid.horizontal_deg)
      for (const double gamma : coarse->grid.vertical_deg) reached = std::max(reached, std::abs(before.at(c, gamma) - after.at(c, gamma)));
    EXPECT_LE(reached, coarse->error * (1 + 1e-12));
    EXPECT_GT(std::max(reached, seen), 0.8 * coarse->error);
  }
}

TEST(Resampled, TypesAAndBStayInTheirOwnAngles) {
  for (const WebType type : {WebType::a, WebType::b}) {
    const IntensityDistribution d = distribution_of(type, WebSymmetry::lateral, steps(-90, 90, 5), steps(0, 90, 5), test::floodlight);
    const Result<ResampledGrid> other = resampled(d.grid, vertical_steps(d.grid, 2), horizontal_steps(d.grid, 7));
    ASSERT_TRUE(other) << other.error().text;
    EXPECT_LE(largest_at_random(web_of(d), web_of(with_grid(d, other->grid))), other->error * (1 + 1e-12));
  }
}

TEST(Resampled, AnotherRangeIsRefused) {
  const IntensityDistribution d = distribution_of(WebType::c, WebSymmetry::quadrant, steps(0, 90, 15), steps(0, 90, 30), lopsided);
  EXPECT_FALSE(resampled(d.grid, steps(0, 180, 15), steps(0, 90, 30)));
  EXPECT_FALSE(resampled(d.grid, steps(0, 90, 15), steps(0, 60, 30)));
  EXPECT_FALSE(resampled(d.grid, {90, 0}, steps(0, 90, 30)));
  EXPECT_FALSE(resampled(d.grid, {}, steps(0, 90, 30)));
}

TEST(Turned, ByAnyAngleTheLightIsThatOfTheTurnedFrame) {
  const IntensityDistribution d = distribution_of(WebType::c, WebSymmetry::about_0_180, steps(0, 180, 15), steps(0, 180, 20), lopsided);
  for (const double turn : {-17.0, 3.25, 90.0, 180.0, 200.0}) {
    const Result<IntensityGrid> grid = turned(d.grid, turn);
    ASSERT_TRUE(grid) << grid.error().text;
    const IntensityWeb expected = web_of(d, Interpolation::linear, {false, turn}), found = web_of(with_grid(d, *grid));
    EXPECT_LT(largest_at_random(expected, found), 1e-11) << turn;
    EXPECT_NEAR(found.flux_lm(), expected.flux_lm(), 1e-12 * expected.flux_lm()) << turn;
  }
}

TEST(WithGrid, EulumdatsListingFollows) {
  IntensityDistribution d = distribution_of(WebType::c, WebSymmetry::none, steps(0, 180, 15), steps(0, 330, 30), lopsided);
  EulumdatRecord record;
  record.c_deg = d.grid.horizontal_deg;
  record.gamma_step_deg = 15;
  record.lamp_sets = {{1, "", 1000, "", "", 0}};
  d.record = record;
  const Result<ResampledGrid> other = resampled(d.grid, vertical_steps(d.grid, 10), horizontal_steps(d.grid, 45));
  ASSERT_TRUE(other);
  const IntensityDistribution written = with_grid(d, other->grid);
  const auto& after = *std::get_if<EulumdatRecord>(&written.record);
  EXPECT_TRUE(after.c_deg.empty());
  EXPECT_EQ(after.gamma_step_deg, 10);
  EXPECT_EQ(written.grid.horizontal_deg.back(), 315);
  EXPECT_EQ(written.grid.values.size(), 8U * 19U);
}

}  // namespace
}  // namespace etendue
