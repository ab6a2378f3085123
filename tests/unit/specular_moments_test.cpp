// Specular light by moments: against the adaptive reference, limits, what no light may do.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "etendue/specular_methods.h"
#include "eval_protocol.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

ShadingPoint surface(const Vec3d& position, const Vec3d& normal, const Vec3d& view, double alpha, double f0) {
  return {position, normal, normal, view, GgxLobe{alpha, {f0, f0, f0}, 1, Masking::correlated}};
}
double by_moments(const Emitter& emitter, const ShadingPoint& point) {
  const auto value = find_specular_method("moments")->luminance(emitter, point);
  EXPECT_TRUE(value.has_value());
  return value.value_or(Rgb{-1, -1, -1}).x;
}
// Half of them with the mirror direction within the light.
Vec3d view_of(const Placement& p, Random& random) {
  while (random.uniform(0, 1) < 0.5) {
    const Vec3d l = sample_light(p.emitter, p.position, {random.uniform(0, 1), random.uniform(0, 1)}).direction;
    if (const double z = dot(l, p.normal); z > 0.05) return p.normal * (2 * z) - l;
  }
  const Basis b = basis_around(p.normal);
  const double cosine = random.uniform(0.05, 1), turn = random.uniform(0, 2 * pi), sine = std::sqrt(1 - cosine * cosine);
  return b.tangent * (sine * std::cos(turn)) + b.bitangent * (sine * std::sin(turn)) + p.normal * cosine;
}

// The sum of all errors over that of the light, of each shape and for f0 = 1 and .04: half as much again as 200 placements of nine alphas
// each have.
struct Limit {
  Kind kind;
  double metal, dielectric;
};
class MomentsOf : public testing::TestWithParam<Limit> {};
TEST_P(MomentsOf, AreCloseToTheReference) {
  for (const bool metal : {true, false}) {
    double errors = 0, sum = 0;
    for (const double alpha : {0.01, 0.05, 0.2, 0.5, 1.0}) {
      Random random(31);
      for (int i = 0; i < 60; ++i) {
        const Placement p = place(GetParam().kind, random, i % 2 == 0);
        const ShadingPoint point = surface(p.position, p.normal, view_of(p, random), alpha, metal ? 1 : 0.04);
        const double truth = reference(p.emitter, point, {1e-3, 1e-6}).value.x;
        errors += std::abs(by_moments(p.emitter, point) - truth), sum += truth;
      }
    }
    EXPECT_LT(errors / sum, metal ? GetParam().metal : GetParam().dielectric);
  }
}
INSTANTIATE_TEST_SUITE_P(Shapes, MomentsOf,
                         testing::Values(Limit{Kind::rect, 0.015, 0.022}, Limit{Kind::sphere, 0.015, 0.03}, Limit{Kind::disk, 0.032, 0.06},
                                         Limit{Kind::capsule, 0.013, 0.025}));

// A light that is small beside the lobe sees the BRDF at its place; left are its size's square and what 16 chords miss of a circle's area
// after the extrapolation: with sin(x) / x of 22.5 and 45 degrees, (4 .9745 - .9003) / 3 = 1 - 7.7e-4.
TEST(Moments, SmallLightsSeeTheBrdf) {
  Random random(32);
  for (int i = 0; i < 200; ++i) {
    const double alpha = random.uniform(0.1, 1), cosine = random.uniform(0.2, 1);
    const Vec3d view{std::sqrt(1 - cosine * cosine), 0, cosine};
    Vec3d to = random.direction();
    to.z = std::abs(to.z) + 0.2;
    to = normalised(to);
    Emitter light;
    light.shape = SphereEmitter{to, 1e-3};
    light.radiance = {1, 1, 1};
    const ShadingPoint point = surface({}, {0, 0, 1}, view, alpha, 0.04);
    const Basis b = basis_around({0, 0, 1});
    const auto local = [&](const Vec3d& w) { return Vec3d{dot(b.tangent, w), dot(b.bitangent, w), w.z}; };
    const double expected = brdf_cos(point.brdf, local(view), local(to)).x * pi * 1e-6;
    EXPECT_NEAR(by_moments(light, point), expected, 1e-3 * expected);
  }
}

// From within a sphere that emits on both sides the outline is the horizon alone, so that the four nodes stand for the whole lobe: the
// farthest that they can be from where W bends.
TEST(Moments, AWhiteSkyGivesTheAlbedo) {
  Emitter sky;
  sky.shape = SphereEmitter{{}, 1};
  sky.radiance = {1, 1, 1};
  sky.two_sided = true;
  for (const double alpha : {0.05, 0.2, 0.5, 1.0}) {
    for (const double cosine : {0.3, 0.7, 1.0}) {
      const ShadingPoint point = surface({}, {0, 0, 1}, {std::sqrt(1 - cosine * cosine), 0, cosine}, alpha, 1);
      EXPECT_NEAR(by_moments(sky, point), reference(sky, point, {1e-4, 0}).value.x, 0.08) << alpha << ' ' << cosine;
    }
  }
}

// Finite, not negative, no more than the luminance, at grazing views and the smallest alpha too; dark from below.
TEST(Moments, NoLightGivesMoreThanItHas) {
  Random random(33);
  for (int i = 0; i < 20000; ++i) {
    const Kind kind = std::array{Kind::rect, Kind::sphere, Kind::disk, Kind::capsule}[static_cast<std::size_t>(i % 4)];
    const Placement p = place(kind, random, i % 3 != 0);
    const double cosine = i % 7 == 0 ? 1 : random.log_uniform(1e-4, 1), sine = std::sqrt(1 - cosine * cosine);
    const Basis b = basis_around(p.normal);
    const double value =
        by_moments(p.emitter, surface(p.position, p.normal, p.normal * cosine + b.tangent * sine, random.log_uniform(1e-4, 1), 1));
    EXPECT_GE(value, 0);
    EXPECT_LE(value, 1 + 4e-16);  // a rounding
  }
  Emitter below;
  below.shape = SphereEmitter{{0, 0, -2}, 1};
  below.radiance = {1, 1, 1};
  EXPECT_EQ(by_moments(below, surface({}, {0, 0, 1}, {0.6, 0, 0.8}, 0.5, 1)), 0);
}

}  // namespace
