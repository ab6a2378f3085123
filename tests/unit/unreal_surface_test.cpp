#include "etendue/unreal_surface.h"

#include "etendue/material_parameters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace etendue {
namespace {

TEST(UnrealSurface, GoesToStandardAndBack) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 200; ++i) {
    UnrealSurface u;
    for (int c = 0; c < 3; ++c) u.base_colour[c] = unit(random);
    u.metallic = i % 3 == 0 ? 1 : i % 3 == 1 ? 0 : unit(random);
    u.roughness = unit(random);
    u.cavity = 0.01 + 0.99 * unit(random);
    const ToUnreal back = unreal_of(standard_of(u));
    EXPECT_LT(back.residual_rms, 1e-15);
    EXPECT_NEAR(back.surface.cavity, u.cavity, 1e-15);
    EXPECT_EQ(back.surface.metallic, u.metallic);
    EXPECT_EQ(back.surface.roughness, u.roughness);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(back.surface.base_colour[c], u.base_colour[c], 1e-15 / u.cavity);
  }
}

TEST(UnrealSurface, CavityTakesAlbedoAndF0Along) {
  const Standard s = standard_of(UnrealSurface{{0.6, 0.4, 0.2}, 0, 0.3, 0.25});
  EXPECT_DOUBLE_EQ(s.base_colour.x, 0.15);
  EXPECT_DOUBLE_EQ(f0_of_reflectance(s.reflectance), 0.01);
  EXPECT_DOUBLE_EQ(f0_of_reflectance(standard_of(UnrealSurface{}).reflectance), 0.04);
}

// f0 of .16 under a base colour of .5 comes to .04: three of six differences of .12. A metal has no such loss.
TEST(UnrealSurface, WhatItCannotSayIsTold) {
  const ToUnreal gem = unreal_of({{0.5, 0.5, 0.5}, 0, 0.1, 1});
  EXPECT_EQ(gem.surface.cavity, 1);
  EXPECT_NEAR(gem.residual_rms, 0.12 / std::sqrt(2.0), 1e-15);
  EXPECT_LT(unreal_of({{1, 0.766, 0.336}, 1, 0.1, 1}).residual_rms, 1e-15);
  // Water's f0 on white: albedo is kept.
  const ToUnreal white = unreal_of({{1, 1, 1}, 0, 0.1, std::sqrt(0.125)});
  EXPECT_EQ(standard_of(white.surface).base_colour.x, 1);
  EXPECT_NEAR(white.residual_rms, 0.02 / std::sqrt(2.0), 1e-15);
  EXPECT_EQ(unreal_of({{0, 0, 0}, 0, 0.5, 0}).residual_rms, 0);
}

}  // namespace
}  // namespace etendue
