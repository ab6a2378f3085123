// Specular light to a tolerance: against the reference, against itself where light adds up, limits, what it does not take.
#include "etendue/specular_light.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "eval_protocol.h"
#include "instruction_sets.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

ShadingPoint surface(const Vec3d& position, const Vec3d& normal, const Vec3d& view, const GgxLobe& lobe) {
  return {position, normal, normal, view, lobe};
}
GgxLobe grey(double alpha, double f0, Masking masking = Masking::correlated) { return {alpha, {f0, f0, f0}, 1, masking}; }
Vec3d view_at(const Vec3d& normal, double cosine, double turn) {
  const Basis b = basis_around(normal);
  return b.normal * cosine + (b.tangent * std::cos(turn) + b.bitangent * std::sin(turn)) * std::sqrt((1 - cosine) * (1 + cosine));
}
// Half of them with the mirror direction within the light, the others down to half a degree above the horizon.
Vec3d view_of(const Placement& p, Random& random) {
  while (random.uniform(0, 1) < 0.5) {
    const Vec3d l = sample_light(p.emitter, p.position, random.square()).direction;
    if (const double z = dot(l, p.normal); z > 0.01) return p.normal * (2 * z) - l;
  }
  return view_at(p.normal, random.log_uniform(0.01, 1), random.uniform(0, 2 * pi));
}

struct Asked {
  Kind kind;
  double tolerance;
  int count;
};
class SpecularLight : public testing::TestWithParam<Asked> {};
// What is asked is kept and the error that is told is one: the reference is asked for a thirtieth of it.
TEST_P(SpecularLight, KeepsTheTolerance) {
  const auto [kind, tolerance, count] = GetParam();
  Random random(61);
  for (int i = 0; i < count; ++i) {
    const Placement p = place(kind, random, i % 2 == 0);
    const double alpha = random.log_uniform(1e-3, 1), f0 = i % 3 == 0 ? 0.04 : 1;
    const GgxLobe lobe = grey(alpha, f0, i % 5 == 0 ? Masking::separable : i % 5 == 1 ? Masking::schlick_direct : Masking::correlated);
    const ShadingPoint point = surface(p.position, p.normal, view_of(p, random), lobe);
    const double floor = 1e-3 * illuminance(p.emitter, p.position, p.normal).x;
    const auto light = specular_luminance(p.emitter, point, tolerance);
    ASSERT_TRUE(light.has_value());
    const Estimate truth = reference(p.emitter, point, {tolerance / 30, tolerance / 30 * floor});
    const double allowed = tolerance * std::max(truth.value.x, floor);
    EXPECT_LE(light->error.x, allowed * (1 + 2 * tolerance)) << i;
    EXPECT_NEAR(light->value.x, truth.value.x, light->error.x + truth.error.x) << i << " alpha " << alpha << " f0 " << f0;
  }
}
INSTANTIATE_TEST_SUITE_P(Shapes, SpecularLight,
                         testing::Values(Asked{Kind::rect, 1e-2, 200}, Asked{Kind::rect, 1e-3, 200}, Asked{Kind::rect, 1e-4, 100},
                                         Asked{Kind::rect, 1e-6, 30}, Asked{Kind::sphere, 1e-3, 200}, Asked{Kind::sphere, 1e-6, 30},
                                         Asked{Kind::disk, 1e-3, 200}, Asked{Kind::disk, 1e-6, 30}, Asked{Kind::capsule, 1e-3, 200},
                                         Asked{Kind::capsule, 1e-6, 30}, Asked{Kind::star, 1e-3, 200}, Asked{Kind::star, 1e-6, 30},
                                         Asked{Kind::flat_tube, 1e-4, 60}, Asked{Kind::open_tube, 1e-4, 60}));

// Light adds up: the two halves of a rectangle, which share no cell with it.
TEST(SpecularLight, HalvesAddUpToTheWhole) {
  Random random(62);
  for (int i = 0; i < 100; ++i) {
    const Vec3d centre = random.direction() * random.uniform(0.3, 3) + Vec3d{0, 0, 1};
    const Vec3d x = basis_around(-normalised(centre)).tangent, y = cross(-normalised(centre), x);
    const double width = random.log_uniform(0.1, 4), height = random.log_uniform(0.1, 4);
    const Emitter whole = white(rectangle(centre, x, y, width, height));
    const Emitter left = white(rectangle(centre - x * (0.25 * width), x, y, 0.5 * width, height));
    const Emitter right = white(rectangle(centre + x * (0.25 * width), x, y, 0.5 * width, height));
    const ShadingPoint point = surface({}, {0, 0, 1}, view_at({0, 0, 1}, random.log_uniform(1e-3, 1), random.uniform(0, 2 * pi)),
                                       grey(random.log_uniform(1e-3, 1), 0.5));
    const auto light = [&](const Emitter& e) { return specular_luminance(e, point, 1e-5).value_or(Estimate{}); };
    const Estimate all = light(whole), a = light(left), b = light(right);
    EXPECT_NEAR(all.value.x, a.value.x + b.value.x, all.error.x + a.error.x + b.error.x) << i;
  }
}

// A sky of the luminance 1 all around gives back the albedo of the lobe; a perfect mirror's is 1 but for what facets hide (alpha 1e-3: 1e-6
// at this view).
TEST(SpecularLight, WhiteSkyGivesTheAlbedo) {
  Emitter sky;
  sky.shape = EnvironmentEmitter{};
  sky.radiance = {1, 1, 1};
  const ShadingPoint mirror = surface({}, {0, 0, 1}, view_at({0, 0, 1}, 0.7, 1), grey(1e-3, 1));
  EXPECT_NEAR(specular_luminance(sky, mirror, 1e-6)->value.x, 1, 5e-6);
  for (const double alpha : {0.1, 0.5, 1.0}) {
    const ShadingPoint point = surface({}, {0, 0, 1}, view_at({0, 0, 1}, 0.3, 1), grey(alpha, 0.04));
    const Estimate light = *specular_luminance(sky, point, 1e-6), truth = reference(sky, point, {1e-8, 0});
    EXPECT_NEAR(light.value.x, truth.value.x, light.error.x + truth.error.x);
  }
}

// Channels with reflectances apart: each keeps the tolerance of its own light.
TEST(SpecularLight, EveryChannelKeepsItsOwn) {
  const Emitter light = white(SphereEmitter{{0.4, 0.3, 0.5}, 0.3});
  const GgxLobe lobe{0.3, {0.9, 0.02, 0}, 0.5, Masking::correlated};
  const ShadingPoint point = surface({}, {0, 0, 1}, view_at({0, 0, 1}, 0.4, 2), lobe);
  const Estimate asked = *specular_luminance(light, point, 1e-4), truth = reference(light, point, {1e-8, 0});
  const double floor = 1e-3 * illuminance(light, {}, {0, 0, 1}).x;
  for (int c = 0; c < 3; ++c) EXPECT_LE(std::abs(asked.value[c] - truth.value[c]), 1e-4 * std::max(truth.value[c], floor)) << c;
}

// Every instruction set finds the same light: 1e-9 asked of smooth cells leaves roundings, which fused multiply-adds change.
TEST(SpecularLight, EveryInstructionSetFindsTheSame) {
  const Emitter light = white(rectangle({0.5, 0.2, 1}, {1, 0, 0}, {0, -1, 0}, 1, 0.6));
  for (const Masking masking : {Masking::correlated, Masking::separable, Masking::schlick_direct, Masking::schlick_image}) {
    const ShadingPoint point = surface({}, {0, 0, 1}, view_at({0, 0, 1}, 0.6, 3.5), grey(0.3, 0.04, masking));
    const Estimate truth = reference(light, point, {1e-11, 0});
    on_each_instruction_set([&] {
      for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-9}) {
        const Estimate found = *specular_luminance(light, point, tolerance);
        EXPECT_NEAR(found.value.x, truth.value.x, found.error.x + truth.error.x);
      }
    });
  }
}

TEST(SpecularLight, TakesWhatItSays) {
  const Emitter sphere = white(SphereEmitter{{0, 0, 1}, 0.3});
  const ShadingPoint point = surface({}, {0, 0, 1}, {0, 0, 1}, grey(0.3, 1));
  EXPECT_TRUE(specular_luminance(sphere, point, 1e-3).has_value());
  ShadingPoint other = point;
  other.brdf = Lambert{};
  EXPECT_FALSE(specular_luminance(sphere, other, 1e-3).has_value());
  SpecularLobe lobe;
  other.brdf = lobe;
  EXPECT_TRUE(specular_luminance(sphere, other, 1e-3).has_value());
  lobe.distribution = Distribution::beckmann;
  other.brdf = lobe;
  EXPECT_FALSE(specular_luminance(sphere, other, 1e-3).has_value());
  Emitter windowed = sphere;
  windowed.window = {Falloff::gltf, 3};
  EXPECT_FALSE(specular_luminance(windowed, point, 1e-3).has_value());
  EXPECT_FALSE(specular_luminance(white(LineEmitter{{0, 0, 1}, {1, 0, 1}, {1, 1, 1}}), point, 1e-3).has_value());
  // Below the horizon, and seen from below, there is nothing.
  EXPECT_EQ(specular_luminance(white(SphereEmitter{{0, 0, -1}, 0.3}), point, 1e-3)->value.x, 0);
  other = point;
  other.view = {0, 0, -1};
  EXPECT_EQ(specular_luminance(sphere, other, 1e-3)->value.x, 0);
}

// Finite whatever is asked: lights that touch the horizon or the point, views along it, alpha 0.
TEST(SpecularLight, IsFiniteEverywhere) {
  for (const double alpha : {0.0, 1e-4, 0.01, 1.0})
    for (const double cosine : {1e-9, 1e-4, 0.5, 1.0})
      for (const Emitter& light :
           {white(SphereEmitter{{0, 0, 0.5}, 0.5}), white(SphereEmitter{{2, 0, -0.999999}, 1}),
            white(DiskEmitter{{0, 0, 1e-5}, {0, 0, -1}, {1, 0, 0}, 1}), white(rectangle({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1, 1)),
            white(rectangle({1e4, 0, 1}, {0, -1, 0}, {0, 0, 1}, 1, 1))}) {
        const ShadingPoint point = surface({}, {0, 0, 1}, view_at({0, 0, 1}, cosine, pi), grey(alpha, 0.04));
        const auto estimate = specular_luminance(light, point, 1e-3);
        ASSERT_TRUE(estimate.has_value());
        EXPECT_TRUE(std::isfinite(estimate->value.x) && estimate->value.x >= 0) << alpha << ' ' << cosine;
        EXPECT_TRUE(std::isfinite(estimate->error.x)) << alpha << ' ' << cosine;
        EXPECT_LE(estimate->value.x, 1.001);
      }
}

}  // namespace
