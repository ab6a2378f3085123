#include "etendue/material_parameters.h"

#include "etendue/surface_presets.h"

#include <gtest/gtest.h>

#include <cmath>

namespace etendue {
namespace {

TEST(Smoothness, EndsAndWaysBack) {
  for (const SmoothnessRemap remap : smoothness_remaps) {
    EXPECT_EQ(alpha_of_smoothness(0, remap), 1);
    EXPECT_EQ(smoothness_remap_named(name_of(remap)), remap);
    double before = 2;
    for (int i = 0; i <= 100; ++i) {
      const double s = i / 100.0, alpha = alpha_of_smoothness(s, remap);
      EXPECT_LT(alpha, before);
      // (1 - .7 s)^6 is the steepest where the root is taken again: 1e-15 / .7 in its base.
      EXPECT_NEAR(smoothness_of_alpha(alpha, remap), s, 3e-15) << name_of(remap);
      before = alpha;
    }
  }
  EXPECT_EQ(alpha_of_smoothness(1), 0);
  EXPECT_NEAR(alpha_of_smoothness(1, SmoothnessRemap::ryse), 0.000729, 1e-15);  // .3^6
  EXPECT_EQ(smoothness_of_alpha(0, SmoothnessRemap::ryse), 1);                  // not reached: the nearest
  // Burley's: alpha = roughness^2, roughness = 1 - smoothness.
  EXPECT_DOUBLE_EQ(alpha_of_smoothness(0.7), 0.3 * 0.3);
  // The notes: the quartic is a close match of Ryse's.
  for (const double s : {0.1, 0.3, 0.5, 0.7})
    EXPECT_NEAR(alpha_of_smoothness(s, SmoothnessRemap::quartic), alpha_of_smoothness(s, SmoothnessRemap::ryse), 0.035);
  EXPECT_FALSE(smoothness_remap_named("cubic"));
}

// Water .02, common dielectrics .04 at reflectance .5, diamond .17 from its index, clamped to .16 by reflectance.
TEST(Reflectance, KnownFacts) {
  EXPECT_NEAR(f0_of_ior(1.333), 0.02, 5e-4);
  EXPECT_DOUBLE_EQ(f0_of_reflectance(0.5), 0.04);
  EXPECT_NEAR(f0_of_ior(1.5), 0.04, 1e-15);
  EXPECT_NEAR(f0_of_ior(2.417), 0.172, 5e-4);
  const Clamped diamond = reflectance_of_f0(f0_of_ior(2.417));
  EXPECT_TRUE(diamond.clamped);
  EXPECT_DOUBLE_EQ(f0_of_reflectance(diamond.value), 0.16);
  const Clamped glass = reflectance_of_f0(0.04);
  EXPECT_FALSE(glass.clamped);
  EXPECT_DOUBLE_EQ(glass.value, 0.5);
}

TEST(Reflectance, IndicesAndBack) {
  for (const double n : {1.0, 1.1, 1.333, 2.0, 10.0}) EXPECT_NEAR(ior_of_f0(f0_of_ior(n)), n, 1e-13 * n * n);
  EXPECT_EQ(f0_of_ior(0), 1);
  EXPECT_EQ(ior_of_f0(1), 0);
  EXPECT_EQ(ior_of_f0(0), 1);
}

TEST(Presets, AreWhatTheirIndicesSay) {
  EXPECT_NEAR(f0_preset("skin")->f0.x, 0.028, 5e-4);
  EXPECT_NEAR(f0_preset("ruby")->f0.x, 0.08, 5e-3);
  EXPECT_FALSE(f0_preset("diamond")->reflectance);
  EXPECT_TRUE(f0_preset("ruby")->reflectance);
  for (const F0Preset& preset : f0_presets()) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_GT(preset.f0[c], preset.metal ? 0.3 : 0.015) << preset.name;
      EXPECT_LE(preset.f0[c], preset.metal ? 1 : 0.18) << preset.name;
    }
    EXPECT_FALSE(preset.source.empty());
  }
  const auto unknown = f0_preset("golt");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().hint.find("gold"), std::string::npos);
}

TEST(Occlusion, Listing26) {
  // "When the surface is totally rough, the function returns the ambient occlusion term unmodified": the power is 2^-17.
  for (const double ao : {0.1, 0.5, 0.9}) EXPECT_NEAR(specular_occlusion(0.5, ao, 1), ao, 1e-5);
  // "For smooth surfaces it reduces the influence at normal incidence but increases it at grazing angles": figure 65, ao .5.
  EXPECT_GT(specular_occlusion(1, 0.5, 0), 0.5);
  EXPECT_LT(specular_occlusion(0, 0.5, 0), 0.5);
  EXPECT_NEAR(specular_occlusion(1, 0.5, 0), std::sqrt(1.5) - 0.5, 1e-15);
  EXPECT_EQ(specular_occlusion(0, 0, 0), 0);
  EXPECT_EQ(specular_occlusion(1, 1, 0.3), 1);
  const IndirectOcclusion both = indirect_occlusion(0.7, 0.4, 0.5, 1);
  EXPECT_EQ(both.diffuse, 0.4);  // the least of them, not the product
  EXPECT_NEAR(both.specular, 0.4, 1e-5);
}

TEST(Occlusion, MicroOcclusionScalesAlbedoAndF0) {
  const Standard paint{{0.6, 0.3, 0.1}, 0, 0.4, 0.5}, gold{{1, 0.766, 0.336}, 1, 0.2, 0.5};
  const Standard dark = with_micro_occlusion(paint, 0.25);
  EXPECT_DOUBLE_EQ(dark.base_colour.x, 0.15);
  EXPECT_DOUBLE_EQ(f0_of_reflectance(dark.reflectance), 0.01);  // below .02: f90 is half
  EXPECT_DOUBLE_EQ(with_micro_occlusion(gold, 0.01).base_colour.x, 0.01);
  EXPECT_EQ(with_micro_occlusion(paint, 1).reflectance, 0.5);
}

TEST(OldMaterials, AreTheirTwoColours) {
  const FromOld grey = standard_of({{0.5, 0.5, 0.5}, {0.04, 0.04, 0.04}, 48});
  EXPECT_LT(grey.residual_rms, 1e-9);
  EXPECT_NEAR(grey.surface.roughness, std::sqrt(0.2), 1e-15);  // alpha = sqrt(2 / 50)
  EXPECT_FALSE(grey.energy_limited);
  // White under white is too much: both halves, and what that loses is told.
  const FromOld white = standard_of({{1, 1, 1}, {1, 1, 1}, 10});
  EXPECT_TRUE(white.energy_limited);
  EXPECT_GE(white.residual_rms, 0.5);
  const FromOld blinding = standard_of({{0, 0, 0}, {1, 0.766, 0.336}, 1e9});
  EXPECT_LT(blinding.residual_rms, 1e-9);
  EXPECT_DOUBLE_EQ(blinding.surface.metal, 1);
}

}  // namespace
}  // namespace etendue
