// Environment maps: orientation, lookup, sampling, and the integral with its statistical error.
#include "etendue/eval.h"

#include <gtest/gtest.h>

#include <cmath>

#include "eval_protocol.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using eval::protocol::Random;

// Rows 0 (top) to height - 1, one value each texel.
std::shared_ptr<const EnvironmentMap> map_of(std::uint32_t width, std::uint32_t height, float (*value)(std::uint32_t x, std::uint32_t y)) {
  std::vector<Vec3f> pixels;
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) pixels.push_back({value(x, y), 2 * value(x, y), 0});
  }
  return make_environment(width, height, pixels);
}

// +Z in the centre column, +X at u = .25, -X at u = .75, -Z at the seam, +Y at the top.
TEST(Environment, Orientation) {
  const auto columns = map_of(8, 4, [](std::uint32_t x, std::uint32_t) { return static_cast<float>(x); });
  // Texel centres at u = (x + .5) / 8: u = .5 lies between columns 3 and 4, u = .25 between 1 and 2.
  EXPECT_NEAR(lookup(*columns, {0, 0, 1}).x, 3.5, 1e-6);
  EXPECT_NEAR(lookup(*columns, {1, 0, 0}).x, 1.5, 1e-6);
  EXPECT_NEAR(lookup(*columns, {-1, 0, 0}).x, 5.5, 1e-6);
  EXPECT_NEAR(lookup(*columns, {0, 0, -1}).x, 3.5, 1e-6);  // the mean of the first and the last
  EXPECT_NEAR(lookup(*columns, {0, 0, 1}).y, 7, 1e-6);
  const auto rows = map_of(8, 4, [](std::uint32_t, std::uint32_t y) { return static_cast<float>(y); });
  EXPECT_NEAR(lookup(*rows, {0, 1, 0}).x, 0, 1e-6);  // clamped at the poles
  EXPECT_NEAR(lookup(*rows, {0, -1, 0}).x, 3, 1e-6);
  EXPECT_NEAR(lookup(*rows, {0, 0, 1}).x, 1.5, 1e-6);
}

TEST(Environment, MeanOverTheSphere) {
  const auto grey = map_of(16, 8, [](std::uint32_t, std::uint32_t) { return 0.5f; });
  EXPECT_NEAR(mean_luminance(*grey), luminance_of({0.5, 1, 0}), 1e-12);
  // The upper half white: half of the sphere.
  const auto half = map_of(16, 8, [](std::uint32_t, std::uint32_t y) { return y < 4 ? 1.0f : 0.0f; });
  EXPECT_NEAR(mean_luminance(*half), 0.5 * luminance_of({1, 2, 0}), 1e-12);
}

float spotty(std::uint32_t x, std::uint32_t y) { return 0.1f + (x == 5 && y == 2 ? 50.0f : 0.0f) + 0.05f * static_cast<float>(y); }

Emitter with_map(std::shared_ptr<const EnvironmentMap> map) {
  Emitter e;
  e.shape = EnvironmentEmitter{std::move(map), Transform{}};
  e.radiance = {1, 1, 1};
  return e;
}

TEST(Environment, SamplesHaveTheirDensity) {
  const Emitter e = with_map(map_of(16, 8, spotty));
  Random random(2);
  // Uniform directions: the density integrates to 1. Samples: mean of 1 / pdf is the sphere, where the density has no gap.
  double integral = 0, sphere = 0;
  constexpr int n = 400000;
  for (int i = 0; i < n; ++i) integral += light_along(e, {}, random.direction()).pdf * 4 * pi / n;
  EXPECT_NEAR(integral, 1, 0.02);
  for (int i = 0; i < n; ++i) {
    const LightSample s = sample_light(e, {}, random.square());
    ASSERT_GT(s.pdf, 0);
    sphere += 1 / s.pdf / n;
  }
  EXPECT_NEAR(sphere, 4 * pi, 0.02 * 4 * pi);
}

// A brute-force sum over the sphere (midpoints, 1500 x 3000) against the estimate within its error, for a rotated map.
TEST(Environment, ReferenceAgreesWithABruteSum) {
  const auto map = map_of(16, 8, spotty);
  Emitter e = with_map(map);
  const Transform turn = Transform::from_trs({}, {0.1825741858350554, 0.3651483716701107, 0.5477225575051661, 0.7302967433402214});
  std::get<EnvironmentEmitter>(e.shape).to_local = turn;
  const Vec3d n = normalised(Vec3d{0.2, 0.9, 0.3});
  const Basis b = basis_around(n);
  const Vec3d view = normalised(n + b.tangent * 0.7);
  for (const Brdf& brdf :
       {Brdf{Lambert{{0.8, 0.8, 0.8}}}, Brdf{Principled{{0.5, 0.4, 0.3}, 0.2, 0.5, 0.5}}, Brdf{GgxLobe{0.3, {1, 1, 1}, 1}}}) {
    double sum = 0;
    constexpr int nz = 1500, nphi = 3000;
    for (int i = 0; i < nz; ++i) {
      const double z = (i + 0.5) / nz, r = std::sqrt(1 - z * z);
      for (int j = 0; j < nphi; ++j) {
        const double phi = 2 * pi * (j + 0.5) / nphi;
        const Vec3d l{r * std::cos(phi), r * std::sin(phi), z};
        const Vec3d world = b.tangent * l.x + b.bitangent * l.y + b.normal * l.z;
        const Vec3d v{dot(b.tangent, view), dot(b.bitangent, view), dot(b.normal, view)};
        sum += brdf_cos(brdf, v, l).x * lookup(*map, turn.vector(world)).x;
      }
    }
    sum *= 2 * pi / (double{nz} * nphi);
    const Estimate estimate = reference(e, {{}, n, n, view, brdf}, {1e-3, 0});
    EXPECT_LE(estimate.error.x, 1.001e-3 * estimate.value.x);
    EXPECT_NEAR(estimate.value.x, sum, estimate.error.x + 1e-4 * sum) << brdf.index();
  }
}

// A constant map is the closed form's environment.
TEST(Environment, ConstantMapIsNoMap) {
  const Emitter map = with_map(map_of(8, 4, [](std::uint32_t, std::uint32_t) { return 1.0f; }));
  Emitter none;
  none.shape = EnvironmentEmitter{};
  none.radiance = {1, 1, 1};
  const Vec3d n{0, 1, 0}, view = normalised(Vec3d{0.4, 1, 0.1});
  const Estimate sampled = reference(map, {{}, n, n, view, Principled{}}, {1e-4, 0});
  const Estimate exact = reference(none, {{}, n, n, view, Principled{}}, {1e-8, 0});
  EXPECT_NEAR(sampled.value.x, exact.value.x, sampled.error.x);
  EXPECT_NEAR(sampled.value.y, 2 * exact.value.y, sampled.error.y);
  EXPECT_EQ(sampled.value.z, 0);
}

TEST(Environment, BlackAndBrokenPixelsAreHarmless) {
  const auto black = make_environment(4, 2, std::vector<Vec3f>(8));
  EXPECT_EQ(reference(with_map(black), {{}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}, Principled{}}, {1e-3, 0}).value, Rgb{});
  const float nan = std::nanf("");
  const auto broken = make_environment(2, 2, {{nan, 1, INFINITY}, {1, 1, 1}});
  const Rgb value = reference(with_map(broken), {{}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}, Lambert{}}, {1e-2, 0}).value;
  EXPECT_TRUE(std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z));
  EXPECT_EQ(lookup(*make_environment(0, 0, {}), {0, 1, 0}), Rgb{});
}

}  // namespace
