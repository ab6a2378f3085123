// One tolerance for whatever a surface is made of: the way that is taken, and what the reference says of it.
#include "etendue/light_within.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "eval_protocol.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

ShadingPoint surface(const Brdf& brdf, const Vec3d& view = normalised(Vec3d{0.6, 0.2, 0.7})) {
  return {{}, {0, 0, 1}, {0, 0, 1}, view, brdf};
}
const Emitter& sphere() {
  static const Emitter light = white(SphereEmitter{{-0.5, 0.3, 1}, 0.4}, 100);
  return light;
}

// Every kind of surface under lights of every kind, in every channel.
TEST(LightWithin, KeepsTheToleranceOfBothLobes) {
  Random random(71);
  for (int i = 0; i < 120; ++i) {
    const Kind kind = std::array{Kind::rect, Kind::sphere, Kind::disk, Kind::capsule}[static_cast<std::size_t>(i % 4)];
    const Placement p = place(kind, random, i % 3 == 0);
    const double roughness = random.uniform(0.05, 1);
    const Brdf brdf = std::array<Brdf, 4>{Standard{{0.8, 0.3, 0.05}, random.uniform(0, 1), roughness, 0.6}, GgxLobe{roughness * roughness},
                                          OrenNayar{{0.5, 0.5, 0.5}, 0.4},
                                          MetalRough{{0.9, 0.2, 0.1}, 0.5, roughness}}[static_cast<std::size_t>(i / 4 % 4)];
    Vec3d view = random.direction();
    view = view - p.normal * std::min(0.0, 2 * dot(view, p.normal));
    const ShadingPoint point{p.position, p.normal, p.normal, view, brdf};
    for (const double tolerance : {1e-2, 1e-4}) {
      const LightWithin found = light_within(p.emitter, point, tolerance);
      const double floor = 1e-3 * illuminance(p.emitter, p.position, p.normal).x;
      const Estimate truth = reference(p.emitter, point, {tolerance / 100, tolerance / 100 * floor});
      for (int c = 0; c < 3; ++c) {
        EXPECT_LE(std::abs(found.light.value[c] - truth.value[c]), tolerance * std::max(truth.value[c], floor) + truth.error[c])
            << i << found.way;
        EXPECT_LE(found.light.error[c], 1.1 * tolerance * std::max(truth.value[c], floor)) << i << found.way;
      }
    }
  }
}

TEST(LightWithin, TakesTheCheapestWay) {
  EXPECT_EQ(light_within(sphere(), surface(Lambert{{1, 1, 1}}), 1e-3).way, "exact");
  EXPECT_EQ(light_within(sphere(), surface(GgxLobe{0.1}), 1e-3).way, "adaptive");
  EXPECT_EQ(light_within(sphere(), surface(Standard{}), 1e-3).way, "two lobes");
  EXPECT_EQ(light_within(sphere(), surface(Conductor{}), 1e-3).way, "reference");
  EXPECT_EQ(light_within(white(SphereEmitter{{0, 0, -1}, 0.4}), surface(Standard{}), 1e-3).way, "unseen");
  Emitter point = sphere();
  point.shape = PunctualEmitter{{0, 0, 2}, {}, {10, 10, 10}, PointShape{}};
  EXPECT_EQ(light_within(point, surface(GgxLobe{0.1}), 1e-3).way, "exact");
  EXPECT_EQ(light_within(white(SphereEmitter{{-0.5, 0.3, 10}, 0.4}), surface(Conductor{{0.2, 0.9, 1.1}, {3.9, 2.4, 2.1}, 0.3}), 1e-3).way,
            "far");
  EXPECT_EQ(light_within(white(LineEmitter{{0, 0, 1}, {1, 0, 1}, {1, 1, 1}}), surface(GgxLobe{0.1}), 1e-3).way, "reference");
}

// A lobe of no reflectance leaves the diffuse one.
TEST(LightWithin, OneLobeMayBeBlack) {
  const Standard matte{{0.5, 0.4, 0.3}, 0, 0.7, 0};
  const LightWithin found = light_within(sphere(), surface(matte), 1e-5);
  const Estimate diffuse = reference(sphere(), surface(FrostbiteDiffuse{matte.base_colour, matte.roughness}), {1e-8, 0});
  EXPECT_EQ(found.way, "two lobes");
  EXPECT_NEAR(found.light.value.x, diffuse.value.x, found.light.error.x + diffuse.error.x);
}

// A plan over many points says what one point after the other says, to the same tolerance, by whatever way.
TEST(LightPlan, KeepsTheToleranceOverManyPoints) {
  Random random(17);
  Emitter sun;
  sun.shape = DistantEmitter{normalised(Vec3d{0.3, 0.1, 1}), Rgb{3, 3, 3}, 0.35};
  const std::array lights{white(rectangle({0, 0, 1.5}, {1, 0, 0}, {0, -1, 0}, 1.4, 0.8), 30),
                          white(star({0, 0, 1.5}, {1, 0, 0}, {0, -1, 0}, 1.4, 0.8, 4, 0.4), 30), white(SphereEmitter{{0, 0, 1.5}, 0.4}, 30),
                          sun};
  for (std::size_t which = 0; which < 2 * lights.size(); ++which) {
    const Emitter& light = lights[which / 2];
    const bool half_lit = which % 2 == 1;
    std::vector<ShadingPoint> points;
    for (int i = 0; i < (which < 2 ? 300 : 120); ++i) {
      const Vec3d position{random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-0.5, 0.5)};
      Vec3d normal = half_lit ? random.direction() : Vec3d{0, 0, 1};
      Vec3d view = random.direction();
      view = view - normal * std::min(0.0, 2 * dot(view, normal));
      const double roughness = random.uniform(0.03, 1);
      const std::array<Brdf, 6> brdfs{
          Standard{{0.8, 0.3, 0.05}, random.uniform(0, 1), roughness, 0.6}, GgxLobe{roughness * roughness},
          MetalRough{{0.9, 0.2, 0.1}, random.uniform(0, 1), roughness},     TwoColour{{0.5, 0.2, 0.1}, {0.1, 0.3, 0.05}, roughness},
          Principled{{0.6, 0.5, 0.1}, i % 12 == 4 ? 1.0 : 0.5, roughness},  Lambert{{0.5, 0.5, 0.5}}};
      points.push_back({position, normal, normal, view, brdfs[static_cast<std::size_t>(i % 6)]});
    }
    for (const double relative : {1e-2, 1e-3}) {
      for (const double absolute : {0.0, 1e-3}) {
        const std::vector<LightWithin> found = LightPlan(light, {relative, absolute})(points);
        ASSERT_EQ(found.size(), points.size());
        std::size_t in_cells = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
          const double floor = 1e-3 * illuminance(light, points[i].position, points[i].normal).x;
          const Estimate truth = reference(light, points[i], {relative / 100, relative / 100 * floor});
          in_cells += found[i].way == "cells" ? 1 : 0;
          for (int c = 0; c < 3; ++c) {
            EXPECT_LE(std::abs(found[i].light.value[c] - truth.value[c]),
                      std::max(relative * std::max(truth.value[c], floor), absolute) + truth.error[c])
                << i << found[i].way;
          }
        }
        EXPECT_GT(in_cells, which < 2 ? 20u : 8u) << which;
      }
    }
  }
}

TEST(LightPlan, OnePointIsABlockToo) {
  const LightPlan plan(sphere(), {1e-3, 0});
  EXPECT_EQ(plan(surface(Standard{})).way, "cells");
  EXPECT_EQ(plan(std::span<const ShadingPoint>{}).size(), 0u);
}

}  // namespace
