// Disney parameters as codes: the best ones, against every code there is.
#include "etendue/material_codes.h"

#include "etendue/srgb.h"

#include "draws.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace etendue {
namespace {

constexpr DielectricCode kinds[] = {DielectricCode::reflectance, DielectricCode::specular_factor, DielectricCode::none};

// Every metal and dielectric code with every base colour code of each channel.
double least_of_all(const ColourPair& pair, const MaterialFormat& format) {
  const int codes = 1 << format.bits;
  double least = std::numeric_limits<double>::infinity();
  for (int metal = 0; metal < codes; ++metal)
    for (int dielectric = 0; dielectric < codes; ++dielectric) {
      double sum = 0;
      for (int c = 0; c < 3; ++c) {
        double channel = std::numeric_limits<double>::infinity();
        for (int base = 0; base < codes; ++base) {
          const double m = static_cast<double>(metal) / (codes - 1), x = static_cast<double>(dielectric) / (codes - 1),
                       b = srgb_to_linear(static_cast<double>(base) / (codes - 1));
          const double f0 = format.dielectric == DielectricCode::reflectance       ? 0.16 * x * x
                            : format.dielectric == DielectricCode::specular_factor ? 0.16 * x
                                                                                   : 0.04;
          channel = std::min(channel, std::pow((1 - m) * b - pair.diffuse[c], 2) + std::pow(f0 * (1 - m) + m * b - pair.f0[c], 2));
        }
        sum += channel;
      }
      least = std::min(least, sum);
    }
  return least;
}

TEST(MaterialCodes, NoCodesAreBetter) {
  Draws draw(1);
  for (const DielectricCode kind : kinds) {
    for (const int bits : {1, 3, 4, 5}) {
      const MaterialFormat format{bits, kind};
      for (int i = 0; i < (bits == 5 ? 10 : 40); ++i) {
        const double grey = draw.within(0, 1), f0 = draw.within(0, 0.3);
        const ColourPair pair = i % 2 ? ColourPair{draw.rgb(0, 1), draw.rgb(0, 1)} : ColourPair{{grey, grey, grey}, {f0, f0, f0}};
        const StoredFit fit = fit_codes(pair, format);
        EXPECT_NEAR(fit.residual, least_of_all(pair, format), 1e-14);
        EXPECT_NEAR(fit.residual, squared_difference(fit.value, pair), 1e-14);
      }
    }
  }
}

TEST(MaterialCodes, NeverWorseThanTheRoundedOptimumAndBetterInTheMean) {
  Draws draw(2);
  for (const DielectricCode kind : kinds) {
    for (const int bits : {8, 10, 16}) {
      const MaterialFormat format{bits, kind};
      const DielectricF0 dielectric = kind == DielectricCode::none ? DielectricF0::core : DielectricF0::free;
      double stored = 0, plainly = 0;
      for (int i = 0; i < 300; ++i) {
        // Half of them are reachable but for rounding, as real assets' are.
        const ColourPair pair =
            i % 2 ? ColourPair{draw.rgb(0, 1), draw.rgb(0, 1)} : colour_pair_of({draw.rgb(0, 1), draw.within(0, 1), draw.within(0, 1)});
        const DisneyFit optimum = fit_disney(pair, dielectric);
        const double plain = squared_difference(decoded(rounded(optimum.value, format), format), pair);
        const StoredFit fit = fit_codes(pair, format);
        EXPECT_LE(fit.residual, plain + 1e-15);
        EXPECT_GE(fit.residual, optimum.residual - 1e-14);
        EXPECT_NEAR(fit.residual, squared_difference(fit.value, pair), 1e-14);
        if (i % 2 == 0) stored += fit.residual, plainly += plain;
      }
      // Rounding's errors are independent; of the five numbers stored one at least takes up what another leaves.
      if (kind != DielectricCode::none) {
        EXPECT_LT(std::sqrt(stored), 0.8 * std::sqrt(plainly)) << bits;
      }
    }
  }
}

TEST(MaterialCodes, WhatWasStoredComesBackTheSame) {
  Draws draw(3);
  for (const DielectricCode kind : kinds) {
    for (const int bits : {8, 10, 16}) {
      const MaterialFormat format{bits, kind};
      const double top = (1 << bits) - 1;
      for (int i = 0; i < 100; ++i) {
        const auto code = [&](double low, double high) { return static_cast<std::uint16_t>(std::lround(draw.within(low, high) * top)); };
        // Away from metal 0 and 1, where other codes may give the same two colours.
        MaterialCodes made{{code(0.3, 0.4), code(0.5, 0.6), code(0.8, 1)}, code(0.2, 0.8), code(0.2, 1)};
        if (kind == DielectricCode::none) made.dielectric = 0;
        EXPECT_EQ(rounded(decoded(made, format), format), made);
        const StoredFit fit = fit_codes(colour_pair_of(decoded(made, format)), format);
        EXPECT_LE(fit.residual, 1e-20);
        if (bits == 8) {
          EXPECT_EQ(fit.codes, made);
        }
      }
    }
  }
}

TEST(MaterialCodes, ARangeOfMetalIsKept) {
  Draws draw(4);
  for (int i = 0; i < 300; ++i) {
    const ColourPair pair{draw.rgb(0, 1), draw.rgb(0, 1)};
    const double a = draw.within(0, 1), b = draw.within(0, 1);
    const MetalRange range{std::min(a, b), std::max(a, b)};
    const StoredFit fit = fit_codes(pair, {}, range);
    // A code is within the range, or none is and the nearest to its middle is taken.
    EXPECT_GE(fit.value.metal, range.low - 0.5 / 255);
    EXPECT_LE(fit.value.metal, range.high + 0.5 / 255);
    EXPECT_LE(fit_codes(pair).residual, fit.residual);
    for (const int metal : {0, 100, 255}) EXPECT_EQ(fit_codes(pair, {}, {metal / 255.0, metal / 255.0}).codes.metal, metal);
  }
}

TEST(MaterialCodes, AnyInputGivesCodesAndFiniteValues) {
  const double infinite = std::numeric_limits<double>::infinity(), nan = std::nan("");
  for (const DielectricCode kind : kinds)
    for (const int bits : {-3, 1, 8, 16, 99})
      for (const ColourPair& pair : {ColourPair{{nan, infinite, -infinite}, {-1, 1e308, nan}}, ColourPair{{2, 2, 2}, {2, 2, 2}},
                                     ColourPair{{-1, -1, -1}, {-1, -1, -1}}}) {
        const StoredFit fit = fit_codes(pair, {bits, kind}, {nan, infinite});
        EXPECT_TRUE(std::isfinite(fit.residual));
        for (const double x :
             {fit.value.base_colour.x, fit.value.base_colour.y, fit.value.base_colour.z, fit.value.metal, fit.value.reflectance}) {
          EXPECT_GE(x, 0);
          EXPECT_LE(x, 1);
        }
      }
}

}  // namespace
}  // namespace etendue
