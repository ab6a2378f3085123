#include "etendue/material.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace etendue {
namespace {

// Fresnel at normal incidence, |(n - 1) / (n + 1)|^2 of the complex index.
double f0_of(double eta, double k) {
  const std::complex<double> n(eta, k);
  return std::norm((n - 1.0) / (n + 1.0));
}

TEST(Conductor, HasTheReflectanceItWasMadeFrom) {
  const Rgb f0{0.04, 0.5, 0.99};
  const Conductor c = conductor_from_f0(f0, 0.2);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(f0_of(c.eta[i], c.k[i]), f0[i], 1e-14);
  EXPECT_EQ(c.alpha, 0.2);
  EXPECT_NEAR(c.eta.x, 1.5, 1e-15) << "glass of n = 1.5 reflects 4 %";
}

TEST(Conductor, IsFiniteAtTheEnds) {
  const Conductor c = conductor_from_f0({0, 1, 2}, 0.1);
  EXPECT_EQ(c.eta.x, 1);
  EXPECT_TRUE(std::isfinite(c.eta.y) && std::isfinite(c.eta.z));
  EXPECT_NEAR(f0_of(c.eta.y, 0), 1, 2e-6);
}

const Principled& principled_of(const Material& material) { return std::get<Principled>(material.model); }

// Both models say 4 % for their defaults: reflectance .5, ior 1.5; Mitsuba's specular .5 means the same.
TEST(MitsubaTwin, DefaultsMeanFourPerCent) {
  Material standard;
  standard.model = Standard{{0.8, 0.7, 0.6}, 0.25, 0.3, 0.5};
  const Principled p = principled_of(mitsuba_twin(standard));
  EXPECT_NEAR(p.specular, 0.5, 1e-15);
  EXPECT_EQ(p.base_colour, (Rgb{0.8, 0.7, 0.6}));
  EXPECT_EQ(p.metallic, 0.25);
  EXPECT_EQ(p.roughness, 0.3);

  Material gltf;
  gltf.model = MetalRough{{1, 1, 1}, 0, 0.7, 1.5};
  EXPECT_NEAR(principled_of(mitsuba_twin(gltf)).specular, 0.5, 1e-15);
}

// eta that Mitsuba computes from `specular` is the index the material came with.
TEST(MitsubaTwin, KeepsTheIndexOfRefraction) {
  for (const double ior : {1.1, 1.33, 1.5, 2.4}) {
    Material material;
    material.model = MetalRough{{1, 1, 1}, 0, 0.5, ior};
    const double specular = principled_of(mitsuba_twin(material)).specular;
    EXPECT_NEAR(2 / (1 - std::sqrt(0.08 * specular)) - 1, ior, 1e-14);
  }
}

TEST(MitsubaTwin, NeverMakesABlackMetalOrAnInfiniteIndex) {
  Material material;
  material.model = MetalRough{{1, 1, 1}, 1, 0.5, 1};
  EXPECT_GT(principled_of(mitsuba_twin(material)).specular, 0);
  material.model = Standard{{1, 1, 1}, 1, 0.5, 0};
  EXPECT_GT(principled_of(mitsuba_twin(material)).specular, 0);
  material.model = Standard{{1, 1, 1}, 0, 0.5, 0};
  EXPECT_EQ(principled_of(mitsuba_twin(material)).specular, 0);
  material.model = MetalRough{{1, 1, 1}, 0, 0.5, 0};  // KHR_materials_ior: 0 stands for total reflection
  EXPECT_LT(0.08 * principled_of(mitsuba_twin(material)).specular, 1);
}

TEST(MitsubaTwin, LeavesItsOwnModelsAndEverythingElseAlone) {
  Material material;
  material.name = "steel";
  material.model = Conductor{};
  material.alpha_cutoff = 0.5;
  const Material twin = mitsuba_twin(material);
  EXPECT_TRUE(std::holds_alternative<Conductor>(twin.model));
  EXPECT_EQ(twin.name, "steel");
  EXPECT_EQ(twin.alpha_cutoff, 0.5);
  material.model = Principled{{1, 1, 1}, 1, 0.5, 0};
  EXPECT_EQ(principled_of(mitsuba_twin(material)).specular, 0) << "authored as Mitsuba's own";
}

}  // namespace
}  // namespace etendue
