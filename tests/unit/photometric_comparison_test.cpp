// Two webs beside each other.
#include "etendue/photometric_comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "etendue/photometric_transform.h"
#include "photometry_builder.h"

namespace etendue {
namespace {

using test::distribution_of;
using test::steps;
using test::web_of;

double tilted(const Vec3d& u) { return 200 - 120 * u.z + 60 * u.x; }

TEST(WebDifference, OfTheSameWebThereIsNone) {
  const IntensityWeb web = web_of(distribution_of(WebType::c, WebSymmetry::none, steps(0, 180, 10), steps(0, 350, 10), tilted));
  const WebDifference d = difference(web, web);
  EXPECT_TRUE(d.exact);
  EXPECT_EQ(d.largest_cd, 0);
  EXPECT_EQ(d.rms_cd, 0);
  EXPECT_EQ(d.flux_lm, 0);
}

// 30 cd more everywhere: that is the largest, the mean and the root mean square, and 4 pi 30 lm.
TEST(WebDifference, OfAConstantItIsThatConstant) {
  const IntensityWeb a = web_of(distribution_of(WebType::c, WebSymmetry::about_0_180, steps(0, 180, 10), steps(0, 180, 15), tilted));
  const IntensityWeb b = web_of(distribution_of(WebType::c, WebSymmetry::about_0_180, steps(0, 180, 10), steps(0, 180, 15),
                                                [](const Vec3d& u) { return tilted(u) + 30; }));
  const WebDifference d = difference(a, b);
  EXPECT_NEAR(d.largest_cd, 30, 1e-10);
  EXPECT_NEAR(d.mean_cd, 30, 1e-10);
  EXPECT_NEAR(d.mean_abs_cd, 30, 1e-10);
  EXPECT_NEAR(d.rms_cd, 30, 1e-10);
  EXPECT_NEAR(d.flux_lm, 4 * pi * 30, 1e-8);
}

// A web that ends at 90 degrees against one that goes on: the difference just beyond the end is all of the second.
TEST(WebDifference, SeesWhereOneTableEnds) {
  const auto even = [](const Vec3d&) { return 100.0; };
  const IntensityWeb half = web_of(distribution_of(WebType::c, WebSymmetry::rotational, {0, 90}, {0}, even));
  const IntensityWeb whole = web_of(distribution_of(WebType::c, WebSymmetry::rotational, {0, 180}, {0}, even));
  EXPECT_NEAR(difference(half, whole).largest_cd, 100, 1e-9);
  EXPECT_NEAR(difference(whole, half).largest_cd, -100, 1e-9);
  EXPECT_NEAR(difference(half, whole).mean_cd, 50, 1e-9);
}

// The stated error of a resampling is what the comparison finds.
TEST(WebDifference, AgreesWithTheErrorOfAResampling) {
  for (const WebSymmetry symmetry : {WebSymmetry::none, WebSymmetry::quadrant}) {
    const std::vector<double> planes = symmetry == WebSymmetry::none ? steps(0, 345, 15) : steps(0, 90, 15);
    const IntensityDistribution d = distribution_of(WebType::c, symmetry, steps(0, 180, 5), planes,
                                                    [](const Vec3d& u) { return 100 * std::exp(-3 * (1 + u.z)) * (2 + u.x * u.y); });
    const Result<ResampledGrid> coarse = resampled(d.grid, vertical_steps(d.grid, 35), horizontal_steps(d.grid, 50));
    ASSERT_TRUE(coarse);
    const WebDifference found = difference(web_of(d), web_of(with_grid(d, coarse->grid)));
    EXPECT_TRUE(found.exact);
    EXPECT_NEAR(std::abs(found.largest_cd), coarse->error, 1e-12 * coarse->error + 1e-12);
  }
}

// Type B against type C of one floodlight: refined, they are alike.
TEST(WebDifference, AcrossTypesItFallsWithTheStep) {
  double before = 1e9;
  for (const double step : {10.0, 5.0, 2.5}) {
    const IntensityWeb b =
        web_of(distribution_of(WebType::b, WebSymmetry::none, steps(-90, 90, step), steps(-90, 90, step), test::floodlight));
    const IntensityWeb c =
        web_of(distribution_of(WebType::c, WebSymmetry::none, steps(0, 180, step), steps(0, 360, step), test::floodlight));
    const WebDifference d = difference(b, c);
    EXPECT_FALSE(d.exact);
    EXPECT_LT(d.rms_cd, before / 2.5);
    before = d.rms_cd;
  }
}

}  // namespace
}  // namespace etendue
