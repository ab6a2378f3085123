#include "etendue/plausibility.h"

#include <gtest/gtest.h>

#include <cmath>

namespace etendue {
namespace {

Doubts of(const SurfaceModel& model) { return doubts_of(described(model)); }
bool only(const Doubts& doubts, Doubt one) {
  for (const Doubt d : all_doubts)
    if (doubts.has(d) != (d == one)) return false;
  return true;
}

TEST(Plausibility, RealSurfacesAreInOrder) {
  EXPECT_TRUE(of(MetalRough{{0.04, 0.04, 0.04}, 0, 0.9}).none());     // coal
  EXPECT_TRUE(of(MetalRough{{0.8, 0.82, 0.85}, 0, 0.9}).none());      // snow
  EXPECT_TRUE(of(MetalRough{{0.6, 0.02, 0.01}, 0, 0.3}).none());      // red paint
  EXPECT_TRUE(of(MetalRough{{1.0, 0.766, 0.336}, 1, 0.2}).none());    // gold
  EXPECT_TRUE(of(MetalRough{{0.549, 0.556, 0.554}, 1, 0.2}).none());  // chromium
  EXPECT_TRUE(of(Standard{{0.3, 0.3, 0.3}, 0, 0.4, 0.5}).none());
  EXPECT_TRUE(of(Lambert{{0.5, 0.5, 0.5}}).none());  // no f0 to be judged
  // Water and diamond, by their indices.
  EXPECT_TRUE(of(MetalRough{{0.1, 0.1, 0.1}, 0, 0.1, 1.333}).none());
  EXPECT_TRUE(of(MetalRough{{0.1, 0.1, 0.1}, 0, 0.1, 2.417}).none());
}

TEST(Plausibility, EachDoubtIsFoundAlone) {
  EXPECT_TRUE(only(of(MetalRough{{0.9, 0.9, 0.9}, 0, 0.5}), Doubt::bright_albedo));
  EXPECT_TRUE(only(of(MetalRough{{0.005, 0.01, 0.002}, 0, 0.5}), Doubt::dark_albedo));
  EXPECT_TRUE(only(of(MetalRough{{0.2, 0.2, 0.2}, 1, 0.5}), Doubt::dim_metal));
  EXPECT_TRUE(only(of(MetalRough{{0.5, 0.5, 0.5}, 0.5, 0.5}), Doubt::half_metal));
  EXPECT_TRUE(only(of(MetalRough{{0.5, 0.5, 0.5}, 0, 0.5, 3.0}), Doubt::high_f0));
  EXPECT_TRUE(only(of(Standard{{0.5, 0.5, 0.5}, 0, 0.5, 0.2}), Doubt::low_f0));
  // A dielectric of 100 % albedo under 4 % of reflection.
  const Doubts both = of(MetalRough{{1, 1, 1}, 0, 0.5});
  EXPECT_TRUE(both.has(Doubt::gains_energy) && both.has(Doubt::bright_albedo));
  EXPECT_EQ(both.worst(), Doubt::gains_energy);
}

TEST(Plausibility, TwoColoursAreWhatTheyCanBe) {
  // Gold, as specular-glossiness has it; and paint.
  EXPECT_TRUE(of(SpecularGlossiness{{0, 0, 0}, {1.0, 0.766, 0.336}, 0.8}).none());
  EXPECT_TRUE(of(SpecularGlossiness{{0.5, 0.1, 0.1}, {0.04, 0.04, 0.04}, 0.8}).none());
  // Rusted blue and gold cannot be one metal or one dielectric.
  EXPECT_TRUE(of(SpecularGlossiness{{0.1, 0.2, 0.9}, {0.6, 0.4, 0.2}, 0.8}).has(Doubt::half_metal));
  // The factor 1 - max(specular) keeps the extension's own colours from gaining energy.
  EXPECT_FALSE(of(SpecularGlossiness{{1, 1, 1}, {0.5, 0.5, 0.5}, 0.8}).has(Doubt::gains_energy));
}

TEST(Plausibility, ConductorsByTheirReflectance) {
  EXPECT_NEAR(described(conductor_from_f0({0.9, 0.5, 0.25}, 0.1)).pair.f0.y, 0.5, 1e-12);
  // Aluminium at 550 nm: n = 1.015, k = 6.627 (Rakic 1995) reflects 91.5 %.
  EXPECT_NEAR(described(Conductor{{1.015, 1.015, 1.015}, {6.627, 6.627, 6.627}, 0.1}).pair.f0.x, 0.915, 1e-3);
}

}  // namespace
}  // namespace etendue
