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

// The factor of KHR_materials_pbrSpecularGlossiness, there and back.
TEST(TwoColour, SpecularGlossinessThereAndBack) {
  for (const double top : {0.0, 0.04, 0.5, 0.95}) {
    const SpecularGlossiness m{{0.9, 0.3, 0}, {top, top / 2, 0}, 0.7};
    const SpecularGlossiness back = specular_glossiness_of(two_colour_of(m));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(back.diffuse[c], m.diffuse[c], 1e-14);
    EXPECT_EQ(back.specular, m.specular);
    EXPECT_NEAR(back.glossiness, m.glossiness, 1e-15);
  }
  EXPECT_EQ(specular_glossiness_of({{0.5, 0, 0}, {1, 1, 1}, 0}).diffuse, (Rgb{1, 0, 0})) << "no room for an albedo: as near as it goes";
}

Rgb albedo_of(const Principled& m) { return m.base_colour * (1 - m.metallic); }
Rgb f0_of(const Principled& m) { return Rgb{1, 1, 1} * (0.08 * m.specular * (1 - m.metallic)) + m.base_colour * m.metallic; }

double residual(const Principled& m, const TwoColour& target) {
  const Rgb d = albedo_of(m) - target.diffuse, f = f0_of(m) - target.f0;
  return dot(d, d) + dot(f, f);
}

TEST(TwoColour, DielectricsAndMetalsAreExact) {
  // Grey f0; a metal; and what a metallic of .3 with a dielectric of 4 % makes.
  for (const TwoColour& target : {TwoColour{{0.7, 0.2, 0.05}, {0.04, 0.04, 0.04}, 0.3}, TwoColour{{0, 0, 0}, {1, 0.77, 0.34}, 0.2},
                                  TwoColour{{0.56, 0.28, 0.07}, {0.268, 0.148, 0.058}, 0.5}}) {
    const Principled m = fit_principled(target);
    EXPECT_LT(residual(m, target), 1e-10);
    EXPECT_EQ(m.roughness, target.roughness);
  }
  EXPECT_EQ(fit_principled({{0.7, 0.2, 0.05}, {0.04, 0.04, 0.04}, 0.3}).metallic, 0);
  EXPECT_GT(fit_principled({{0, 0, 0}, {1, 0.77, 0.34}, 0.2}).specular, 0) << "Mitsuba would render it black";
}

// No choice on a grid of metallic and of the dielectric part, with the base colour that minimises the (convex) rest, is better.
TEST(TwoColour, NothingNearbyIsNearer) {
  std::uint32_t state = 1;
  const auto uniform = [&state] { return (state = state * 1664525u + 1013904223u) / 4294967296.0; };
  for (int i = 0; i < 40; ++i) {
    TwoColour target;
    for (int c = 0; c < 3; ++c) target.diffuse[c] = uniform(), target.f0[c] = uniform();
    const double ours = residual(fit_principled(target), target);
    for (int j = 0; j < 2000; ++j) {
      Principled other;
      other.metallic = uniform();
      other.specular = 12.4 * uniform();
      for (int c = 0; c < 3; ++c) {
        const double m = other.metallic, k = 0.08 * other.specular * (1 - m);
        const double b = ((1 - m) * target.diffuse[c] + m * (target.f0[c] - k)) / ((1 - m) * (1 - m) + m * m);
        other.base_colour[c] = std::min(std::max(b, 0.0), 1.0);
      }
      EXPECT_GE(residual(other, target), ours - 1e-9);
    }
  }
}

}  // namespace
}  // namespace etendue
