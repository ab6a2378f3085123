// Disney parameters of two colours: the global optimum.
#include "etendue/material_fit.h"

#include "draws.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace etendue {
namespace {

double rms(double residual) { return std::sqrt(residual / 6); }

// The least residual with m and r given: each base colour's parabola has its lowest point in [0, 1] found by its derivative.
double with_metal_and_reflectance(const ColourPair& pair, double m, double r) {
  DisneyColours colours{{}, m, r};
  for (int c = 0; c < 3; ++c) {
    const double f = pair.f0[c] - 0.16 * r * r * (1 - m);
    colours.base_colour[c] = std::clamp(((1 - m) * pair.diffuse[c] + m * f) / ((1 - m) * (1 - m) + m * m), 0.0, 1.0);
  }
  return squared_difference(colours, pair);
}

// A dense grid over metal and reflectance, and from its best point a search over shrinking neighbourhoods.
double on_a_grid(const ColourPair& pair, double r_low, double r_high) {
  constexpr int metals = 200, reflectances = 50;
  double least = std::numeric_limits<double>::infinity(), m = 0, r = 0;
  const auto consider = [&](double at_m, double at_r) {
    at_m = std::clamp(at_m, 0.0, 1.0), at_r = std::clamp(at_r, r_low, r_high);
    if (const double e = with_metal_and_reflectance(pair, at_m, at_r); e < least) least = e, m = at_m, r = at_r;
  };
  for (int i = 0; i <= metals; ++i)
    for (int j = 0; j <= reflectances; ++j) consider(static_cast<double>(i) / metals, r_low + (r_high - r_low) * j / reflectances);
  double width = 1.0 / metals;
  for (int halving = 0; halving < 24; ++halving, width /= 2)
    for (int repeat = 0; repeat < 4; ++repeat) {
      const double at_m = m, at_r = r;
      for (const double dm : {-width, 0.0, width})
        for (const double dr : {-4 * width, 0.0, 4 * width}) consider(at_m + dm, at_r + dr);
    }
  return least;
}

TEST(MaterialFit, NothingOnADenseGridIsBetter) {
  Draws draw(1);
  for (const double brightest : {0.2, 1.0, 1.3}) {
    for (int i = 0; i < 100; ++i) {
      const ColourPair pair{draw.rgb(0, brightest), draw.rgb(0, brightest)};
      const double grid = on_a_grid(pair, 0, 1), core_grid = on_a_grid(pair, 0.5, 0.5);
      const DisneyFit fit = fit_disney(pair), core = fit_disney(pair, DielectricF0::core);
      // Squares of numbers around 1 are summed: rounding is some 1e-16.
      EXPECT_LE(fit.residual, grid + 1e-14);
      EXPECT_LE(core.residual, core_grid + 1e-14);
      EXPECT_LE(fit.residual, core.residual + 1e-14);
      // The grid's best comes near the optimum, so the fit does not claim what no parameters reach.
      EXPECT_NEAR(rms(fit.residual), rms(grid), 1e-4);
      EXPECT_NEAR(fit.residual, squared_difference(fit.value, pair), 1e-14);
      EXPECT_NEAR(core.residual, squared_difference(core.value, pair), 1e-14);
      EXPECT_NEAR(core.value.metal < 1 ? core.value.reflectance : 0.5, 0.5, 1e-12);
    }
  }
}

TEST(MaterialFit, WhatCameFromDisneyParametersHasNoResidual) {
  Draws draw(2);
  for (int i = 0; i < 2000; ++i) {
    DisneyColours made{draw.rgb(0, 1), draw.within(0, 1), draw.within(0, 1)};
    if (i % 5 == 0) made.metal = 0;
    if (i % 5 == 1) made.metal = 1;
    const ColourPair pair = colour_pair_of(made);
    const DisneyFit fit = fit_disney(pair);
    EXPECT_LE(rms(fit.residual), 1e-9);
    const ColourPair again = colour_pair_of(fit.value);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(again.diffuse[c], pair.diffuse[c], 3e-9);
      EXPECT_NEAR(again.f0[c], pair.f0[c], 3e-9);
    }
    if (made.metal == 0 || made.metal == 1) {
      EXPECT_EQ(fit.value.metal, made.metal);
    }
  }
}

TEST(MaterialFit, GreyIsADielectricWhereItCanBe) {
  const DisneyFit plain = fit_disney({{0.5, 0.5, 0.5}, {0.04, 0.04, 0.04}});
  EXPECT_EQ(plain.value.metal, 0);
  EXPECT_NEAR(plain.value.reflectance, 0.5, 1e-12);
  EXPECT_LE(plain.residual, 1e-30);
  // .3 is more than any dielectric's f0: grey leaves metal free, and reflectance .5 decides. b = .5 / (1 - m), .04 (1 - m) + m b = .3.
  const DisneyFit bright = fit_disney({{0.5, 0.5, 0.5}, {0.3, 0.3, 0.3}});
  EXPECT_LE(rms(bright.residual), 1e-9);
  EXPECT_NEAR(bright.value.reflectance, 0.5, 1e-6);
  EXPECT_LT(bright.metal_low, bright.value.metal);
  EXPECT_GT(bright.metal_high, bright.value.metal);
  const DisneyFit metal = fit_disney({{0, 0, 0}, {0.9, 0.9, 0.9}});
  EXPECT_EQ(metal.value.metal, 1);
  EXPECT_EQ(metal.value.base_colour, (Rgb{0.9, 0.9, 0.9}));
  const DisneyFit black = fit_disney({{0, 0, 0}, {0, 0, 0}});
  EXPECT_EQ(black.residual, 0);
  EXPECT_EQ(black.value.metal, 0);
  EXPECT_EQ(black.metal_low, 0);
  EXPECT_EQ(black.metal_high, 1);
}

TEST(MaterialFit, DiamondsF0IsHeldAtTheLargest) {
  // Index 2.417: f0 = (1.417 / 3.417)^2 = .172. With a diffuse albedo of 0 a metal of that f0 is exact; with one it is not.
  const double f0 = (1.417 / 3.417) * (1.417 / 3.417);
  EXPECT_EQ(fit_disney({{0, 0, 0}, {f0, f0, f0}}).value.metal, 1);
  const DisneyColours dielectric = fit_disney_at(0, {{0.5, 0.5, 0.5}, {f0, f0, f0}});
  EXPECT_EQ(dielectric.reflectance, 1);
  EXPECT_NEAR(colour_pair_of(dielectric).f0.x, 0.16, 1e-15);
}

TEST(MaterialFit, AnyInputGivesParametersWithinTheirRanges) {
  const double big = std::numeric_limits<double>::max(), infinite = std::numeric_limits<double>::infinity(), nan = std::nan("");
  const std::array<double, 10> values{0, -0.0, 1, -1, 0.5, 7, big, -big, infinite, nan};
  Draws draw(3);
  const auto any = [&] { return values[static_cast<std::size_t>(draw.within(0, 9.999))]; };
  for (int i = 0; i < 3000; ++i) {
    const ColourPair pair{{any(), any(), any()}, {any(), any(), any()}};
    for (const DielectricF0 dielectric : {DielectricF0::free, DielectricF0::core}) {
      const DisneyFit fit = fit_disney(pair, dielectric);
      for (const double x : {fit.value.base_colour.x, fit.value.base_colour.y, fit.value.base_colour.z, fit.value.metal,
                             fit.value.reflectance, fit.metal_low, fit.metal_high}) {
        EXPECT_GE(x, 0);
        EXPECT_LE(x, 1);
      }
      EXPECT_TRUE(std::isfinite(fit.residual));
      EXPECT_GE(fit.residual, 0);
    }
  }
  const DisneyColours at = fit_disney_at(nan, {{nan, 0, 0}, {0, infinite, 0}});
  EXPECT_EQ(at.metal, 0);
  EXPECT_TRUE(std::isfinite(squared_difference(at, {{nan, 0, 0}, {0, infinite, 0}})));
}

TEST(MaterialFit, PermutedChannelsGivePermutedColours) {
  Draws draw(4);
  for (int i = 0; i < 200; ++i) {
    const ColourPair pair{draw.rgb(0, 1), draw.rgb(0, 1)};
    const auto turned = [](const Rgb& c) { return Rgb{c.y, c.z, c.x}; };
    const auto swapped = [](const Rgb& c) { return Rgb{c.y, c.x, c.z}; };
    const DisneyFit one = fit_disney(pair), two = fit_disney({turned(pair.diffuse), turned(pair.f0)}),
                    three = fit_disney({swapped(pair.diffuse), swapped(pair.f0)});
    EXPECT_EQ(two.value.base_colour, turned(one.value.base_colour));
    EXPECT_EQ(three.value.base_colour, swapped(one.value.base_colour));
    for (const DisneyFit& other : {two, three}) {
      EXPECT_EQ(other.value.metal, one.value.metal);
      EXPECT_EQ(other.value.reflectance, one.value.reflectance);
      EXPECT_EQ(other.residual, one.residual);
      EXPECT_EQ(other.metal_low, one.metal_low);
      EXPECT_EQ(other.metal_high, one.metal_high);
    }
  }
}

TEST(MaterialFit, MetalIntervalIsWhereTheRmsGrowsByNoMoreThanTheTolerance) {
  Draws draw(5);
  for (int i = 0; i < 300; ++i) {
    const Rgb grey = Rgb{1, 1, 1} * draw.within(0, 0.6);
    const ColourPair pair{grey + draw.rgb(-0.02, 0.02), grey * 0.3 + draw.rgb(-0.02, 0.02)};
    const double tolerance = draw.within(0.0005, 0.01);
    const DisneyFit fit = fit_disney(pair, DielectricF0::free, tolerance);
    const auto excess = [&](double m) { return rms(squared_difference(fit_disney_at(m, pair), pair)) - rms(fit.residual); };
    EXPECT_LE(fit.metal_low, fit.value.metal);
    EXPECT_GE(fit.metal_high, fit.value.metal);
    for (int j = 0; j <= 20; ++j) EXPECT_LE(excess(fit.metal_low + (fit.metal_high - fit.metal_low) * j / 20), tolerance + 1e-12);
    // An end inside [0, 1] is one: the rms there is within the resolution of the limit.
    if (fit.metal_low > 0) {
      EXPECT_GE(excess(fit.metal_low), tolerance - 1e-5);
    }
    if (fit.metal_high < 1) {
      EXPECT_GE(excess(fit.metal_high), tolerance - 1e-5);
    }
  }
}

// From many starts the local search finds nothing better, and its best start finds the optimum.
TEST(MaterialFit, ManyLocalSearchesFindNothingBetter) {
  Draws draw(6);
  for (int i = 0; i < 100; ++i) {
    const ColourPair pair{draw.rgb(0, 1), draw.rgb(0, 1)};
    const double optimum = fit_disney(pair).residual;
    double least = std::numeric_limits<double>::infinity();
    for (int start = 0; start < 60; ++start) {
      const LocalFit local = fit_disney_from({draw.rgb(0, 1), draw.within(0, 1), draw.within(0.05, 1)}, pair);
      EXPECT_NEAR(local.residual, squared_difference(local.value, pair), 1e-14);
      for (const double x :
           {local.value.base_colour.x, local.value.base_colour.y, local.value.base_colour.z, local.value.metal, local.value.reflectance}) {
        EXPECT_GE(x, 0);
        EXPECT_LE(x, 1);
      }
      least = std::min(least, local.residual);
    }
    EXPECT_GE(least, optimum - 1e-14);
    EXPECT_NEAR(rms(least), rms(optimum), 1e-5);
  }
}

}  // namespace
}  // namespace etendue
