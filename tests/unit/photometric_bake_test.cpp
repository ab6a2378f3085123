#include "etendue/photometric_bake.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "photometry_builder.h"

namespace etendue {
namespace {

using test::distribution_of;
using test::steps;

constexpr BakeLayout layouts[] = {BakeLayout::profile, BakeLayout::octahedral, BakeLayout::c_gamma, BakeLayout::cube};

double smooth(const Vec3d& u) { return 1000 * (1 + 0.3 * u.x - 0.2 * u.y * u.z - 0.4 * u.z + 0.1 * u.x * u.x); }
double bumpy(const Vec3d& u) { return std::max(0.0, 60 + 60 * u.x + 35 * std::sin(5 * u.y) - 30 * u.z + 20 * std::cos(9 * u.x * u.z)); }
double beam(const Vec3d& u) { return u.z < -0.7 ? 1e4 * std::pow(-u.z, 60) : 0; }

std::vector<IntensityDistribution> distributions() {
  const std::vector<double> whole = steps(-90, 90, 10);
  return {distribution_of(WebType::c, WebSymmetry::none, steps(0, 180, 5), steps(0, 345, 15), bumpy),
          distribution_of(WebType::c, WebSymmetry::rotational, steps(0, 90, 5), {0}, beam),
          distribution_of(WebType::c, WebSymmetry::quadrant, steps(0, 90, 5), steps(0, 90, 15), bumpy),  // ends brightly
          distribution_of(WebType::b, WebSymmetry::none, whole, whole, test::floodlight)};
}

std::vector<Vec3d> directions(int count) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  std::vector<Vec3d> result{{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {0, -1, 0}, {1, 1, 1}, {-1, 1, -1}};
  for (int i = 0; i < count; ++i) result.push_back({normal(random), normal(random), normal(random)});
  return result;
}

TEST(PhotometricBake, FluxIsTheWebsAndTheErrorIsABound) {
  for (const auto& d : distributions()) {
    const IntensityWeb web = test::web_of(d);
    for (const BakeLayout layout : layouts) {
      for (const std::uint32_t size : {24u, 65u}) {
        const Result<WebBake> baked = bake(web, layout, size);
        ASSERT_TRUE(baked);
        EXPECT_EQ(baked->values.size(), std::size_t{baked->width} * baked->height * baked->pictures);
        EXPECT_NEAR(baked->flux_lm / web.flux_lm(), 1, 6e-8);
        double worst = 0;
        for (const Vec3d& u : directions(6000)) worst = std::max(worst, std::abs(baked->towards(u) - web.towards(u)));
        EXPECT_LE(worst, baked->error_cd) << static_cast<int>(layout) << " " << size << " of " << web.max_cd();
      }
    }
  }
}

// What flux_lm says is the integral of what towards() gives: midpoints in z and azimuth, whose own error at these steps is below 1e-3.
TEST(PhotometricBake, FluxIsTheIntegralOfTheLookup) {
  const IntensityWeb web = test::web_of(distributions()[0]);
  for (const BakeLayout layout : layouts) {
    const Result<WebBake> baked = bake(web, layout, 16);
    ASSERT_TRUE(baked);
    constexpr int rows = 400, columns = 800;
    double sum = 0;
    for (int j = 0; j < rows; ++j) {
      const double z = -1 + 2 * (j + 0.5) / rows, r = std::sqrt(1 - z * z);
      for (int i = 0; i < columns; ++i) {
        const double phi = 2 * pi * (i + 0.5) / columns;
        sum += baked->towards({r * std::cos(phi), r * std::sin(phi), z});
      }
    }
    EXPECT_NEAR(sum * 4 * pi / (rows * columns) / baked->flux_lm, 1, 1e-3) << static_cast<int>(layout);
    double pictures = 0;
    for (std::uint32_t i = 0; i < baked->pictures; ++i) pictures += baked->flux_of_picture(i);
    EXPECT_NEAR(pictures, baked->flux_lm, 1e-9 * pictures);
  }
}

// Twice the texels, a quarter of the error.
TEST(PhotometricBake, ErrorOfASmoothWebFallsAsTheSquareOfTheStep) {
  const IntensityWeb web = test::web_of(distribution_of(WebType::c, WebSymmetry::none, steps(0, 180, 0.25), steps(0, 358, 2), smooth));
  for (const BakeLayout layout : {BakeLayout::octahedral, BakeLayout::cube}) {
    const double coarse = bake(web, layout, 17)->error_cd, fine = bake(web, layout, 33)->error_cd;
    EXPECT_GT(coarse / fine, layout == BakeLayout::cube ? 3.5 : 1.8) << static_cast<int>(layout);  // Clarberg's map has creases
  }
  // 1e-3 of the peak on a cube of 128 texels a side.
  EXPECT_LT(bake(web, BakeLayout::cube, 128)->error_cd, 1e-3 * web.max_cd());
}

// Listing 5 of Moving Frostbite to PBR, at the centre of a texel.
TEST(PhotometricBake, ProfileIsFrostbites) {
  const IntensityWeb web = test::web_of(distribution_of(WebType::c, WebSymmetry::none, steps(0, 180, 1), steps(0, 355, 5), smooth));
  const Result<WebBake> baked = bake(web, BakeLayout::profile, 64);
  ASSERT_TRUE(baked);
  for (const auto& [column, row] : {std::pair(5u, 7u), std::pair(100u, 60u), std::pair(64u, 0u)}) {
    const double coordinate = (row + 0.5) / 64, theta = 2 * pi * (column + 0.5) / 128;
    const double z = 2 * coordinate - 1, r = std::sqrt(1 - z * z);
    const double expected = smooth({r * std::cos(theta), r * std::sin(theta), z});
    EXPECT_NEAR(baked->values[row * 128 + column] / expected, 1, 1e-3);
  }
}

// pbrt-v4's square: +z in the middle, -z in the corners, the horizon on the diamond between.
TEST(PhotometricBake, OctahedronIsClarbergs) {
  const IntensityWeb web = test::web_of(distribution_of(WebType::c, WebSymmetry::none, steps(0, 180, 1), steps(0, 355, 5), smooth));
  const Result<WebBake> baked = bake(web, BakeLayout::octahedral, 129);
  ASSERT_TRUE(baked);
  const auto at = [&](std::size_t column, std::size_t row) { return baked->values[row * 129 + column]; };
  EXPECT_NEAR(at(64, 64) / smooth({0, 0, 1}), 1, 1e-3);
  EXPECT_NEAR(at(0, 0) / smooth({0, 0, -1}), 1, 1e-2);
  EXPECT_NEAR(at(128, 64) / smooth({1, 0, 0}), 1, 1e-2);
  EXPECT_NEAR(at(64, 0) / smooth({0, -1, 0}), 1, 1e-2);
}

TEST(PhotometricBake, AMaskKeepsTheLampsOwnLumens) {
  const IntensityWeb web = test::web_of(distributions()[1]);
  for (const BakeLayout layout : layouts) {
    const Result<WebBake> baked = bake(web, layout, 65);
    ASSERT_TRUE(baked);
    WebBake lamp = *baked;
    lamp.values = mask_of(*baked);
    constexpr double lumens = 800;
    for (float& value : lamp.values) value *= static_cast<float>(lumens / (4 * pi));
    double ratio = 0;
    for (std::uint32_t i = 0; i < lamp.pictures; ++i) ratio += lamp.flux_of_picture(i) / lumens;
    EXPECT_NEAR(ratio, 1, 3e-7);
  }
}

TEST(PhotometricBake, ARotationalWebIsOneColumn) {
  const IntensityWeb web = test::web_of(distributions()[1]);
  EXPECT_EQ(bake(web, BakeLayout::profile, 16)->width, 1u);
  EXPECT_EQ(bake(web, BakeLayout::c_gamma, 16)->width, 1u);
  EXPECT_EQ(bake(web, BakeLayout::octahedral, 16)->width, 16u);
}

TEST(PhotometricBake, TheSizeIsChosenByTheBound) {
  const IntensityWeb web = test::web_of(distribution_of(WebType::c, WebSymmetry::none, steps(0, 180, 1), steps(0, 355, 5), smooth));
  const double wanted = 2e-3 * web.max_cd();
  const Result<WebBake> chosen = bake_within(web, BakeLayout::cube, wanted, 8, 1024);
  ASSERT_TRUE(chosen);
  EXPECT_LE(chosen->error_cd, wanted);
  EXPECT_GT(bake(web, BakeLayout::cube, chosen->width / 2)->error_cd, wanted);
  // A table that ends brightly has an edge at any size.
  const IntensityWeb edge = test::web_of(distribution_of(WebType::c, WebSymmetry::rotational, steps(0, 70, 5), {0}, smooth));
  const Result<WebBake> stuck = bake_within(edge, BakeLayout::cube, wanted, 16, 1024);
  ASSERT_TRUE(stuck);
  EXPECT_GT(stuck->error_cd, wanted);
  EXPECT_LT(stuck->width, 1024u);
}

TEST(PhotometricBake, WhatCannotBeBakedIsSaid) {
  const IntensityWeb web = test::web_of(distributions()[0]);
  EXPECT_EQ(bake(web, BakeLayout::cube, 1).error().code, "BAKE_SIZE");
  EXPECT_EQ(bake(web, BakeLayout::cube, 1u << 20).error().code, "BAKE_SIZE");
  const auto narrow =
      distribution_of(WebType::c, WebSymmetry::rotational, {0, 0.1, 90}, {0}, [](const Vec3d& u) { return u.z < -0.99999999; });
  EXPECT_EQ(bake(test::web_of(narrow), BakeLayout::profile, 16).error().code, "BAKE_TOO_COARSE");
  const auto dark = distribution_of(WebType::c, WebSymmetry::rotational, {0, 90}, {0}, [](const Vec3d&) { return 0; });
  EXPECT_EQ(bake(test::web_of(dark), BakeLayout::profile, 16)->flux_lm, 0);
}

}  // namespace
}  // namespace etendue
