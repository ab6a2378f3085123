// Light of a few places against the reference, where it is taken and where it is not.
#include "etendue/far_luminance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "eval_protocol.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

ShadingPoint surface(const Brdf& brdf, const Vec3d& view = normalised(Vec3d{0.6, 0.2, 0.7})) {
  return {{}, {0, 0, 1}, {0, 0, 1}, view, brdf};
}

// A light of that half angle about the direction, of any kind.
Emitter small_light(int kind, const Vec3d& towards, double size, Random& random) {
  Vec3d n = random.direction();
  if (dot(n, towards) > 0) n = -n;
  const Basis b = basis_around(n);
  const double ratio = random.log_uniform(0.05, 1), distance = random.log_uniform(0.1, 100);
  const Vec3d at = towards * distance;
  const double extent = size * distance;
  switch (kind) {
    case 0:
      return white(rectangle(at, b.tangent, b.bitangent, 2 * extent, 2 * extent * ratio), 7);
    case 1:
      return white(SphereEmitter{at, extent}, 7);
    case 2:
      return white(DiskEmitter{at, n, b.tangent, extent}, 7);
    default: {
      Emitter sun;
      sun.shape = DistantEmitter{towards, {3, 3, 3}, size};
      return sun;
    }
  }
}

TEST(FarLuminance, KeepsItsBound) {
  Random random(31);
  int taken = 0;
  for (int i = 0; i < 2000; ++i) {
    const double alpha = random.log_uniform(1e-3, 1), cosine = random.log_uniform(1e-2, 1), roughness = std::sqrt(alpha);
    const Vec3d view{std::sqrt((1 - cosine) * (1 + cosine)), 0, cosine};
    Vec3d towards = random.direction();
    towards.z = std::abs(towards.z);
    const std::array<Brdf, 6> brdfs{GgxLobe{alpha},
                                    Standard{{0.8, 0.3, 0.05}, 0.3, roughness, 0.6},
                                    MetalRough{{0.9, 0.2, 0.1}, 0.5, roughness},
                                    Conductor{{0.2, 0.9, 1.1}, {3.9, 2.4, 2.1}, alpha},
                                    Principled{{0.5, 0.1, 0.9}, 0.4, roughness},
                                    DisneyDiffuse{{0.5, 0.4, 0.3}, roughness}};
    const ShadingPoint point = surface(brdfs[static_cast<std::size_t>(i % 6)], view);
    const double size = alpha * random.log_uniform(0.01, 1);
    const Emitter light = small_light(i / 6 % 4, towards, size, random);
    for (const double asked : {1e-2, 1e-4, 1e-6}) {
      const auto found = far_luminance(light, point, asked);
      if (!found) continue;
      ++taken;
      const Estimate truth = reference(light, point, {1e-9, 0});
      EXPECT_LE(found->evaluations, 64u);
      for (int c = 0; c < 3; ++c) {
        EXPECT_LE(found->error[c], asked * found->value[c] * (1 + 1e-12));
        EXPECT_NEAR(found->value[c], truth.value[c], found->error[c] + truth.error[c]) << i << " asked " << asked << " alpha " << alpha;
      }
    }
  }
  EXPECT_GT(taken, 1000);
}

// Four times as far away a light takes fewer places, and in the end one.
TEST(FarLuminance, TakesFewerPlacesFarAway) {
  const ShadingPoint point = surface(GgxLobe{0.3});
  std::uint64_t before = 65;
  for (const double distance : {2.0, 8.0, 32.0, 1e3, 1e5}) {
    const Emitter light = white(rectangle(normalised(Vec3d{-0.4, 0.1, 0.7}) * distance, {1, 0, 0}, {0, -1, 0}, 0.5, 0.5));
    const auto found = far_luminance(light, point, 1e-4);
    ASSERT_TRUE(found) << distance;
    EXPECT_LE(found->evaluations, before);
    before = found->evaluations;
  }
  EXPECT_EQ(before, 1u);
}

TEST(FarLuminance, LeavesTheRest) {
  Random random(4);
  const Vec3d towards = normalised(Vec3d{-0.6, -0.2, 0.7});
  const auto sphere = [&](double size) { return small_light(1, towards, size, random); };
  EXPECT_TRUE(far_luminance(sphere(0.05), surface(GgxLobe{0.2}), 1e-3));
  EXPECT_FALSE(far_luminance(sphere(0.5), surface(GgxLobe{0.2}), 1e-3));  // as wide as the lobe
  EXPECT_FALSE(far_luminance(sphere(0.05), surface(GgxLobe{0.01}), 1e-3));
  EXPECT_FALSE(far_luminance(sphere(0.05), surface(OrenNayar{}), 1e-3));  // bends at a plane
  EXPECT_FALSE(far_luminance(small_light(1, normalised(Vec3d{1, 0, 0.02}), 0.05, random), surface(GgxLobe{0.2}), 1e-3));  // at the horizon
  EXPECT_FALSE(far_luminance(white(TubeEmitter{towards, towards * 1.01, 0.01, Caps::round}), surface(GgxLobe{0.2}), 1e-3));
  Emitter windowed = sphere(0.05);
  windowed.window = {Falloff::gltf, 1e3};
  EXPECT_FALSE(far_luminance(windowed, surface(GgxLobe{0.2}), 1e-3));
  // From behind a flat light nothing is taken, nor seen.
  EXPECT_FALSE(far_luminance(white(DiskEmitter{{0, 0, 1}, {0, 0, 1}, {1, 0, 0}, 0.01}), surface(GgxLobe{0.2}), 1e-3));
}

}  // namespace
