#include "etendue/probe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "eval_protocol.h"

namespace etendue::eval {
namespace {

using protocol::Random;

const Vec3d r = normalised(Vec3d{0.3, 0.8, -0.5});

TEST(Prefiltered, AUniformSkyIsItself) {
  const FilteredRadiance sky = [](const Vec3d&, double) { return Rgb{1, 2, 3}; };
  for (const double alpha : {1e-4, 0.1, 1.0}) {
    EXPECT_NEAR(prefiltered_karis(sky, r, alpha, 64).y, 2, 1e-12);
    EXPECT_NEAR(prefiltered_frostbite(sky, r, alpha, 64, 1e-3, 8).z, 3, 1e-12);
  }
}

// The radiance n.l: the mean over the lobe's directions of (n.l)^2 over that of n.l. With n = v the half vector's density D n.h is that of
// t = cos^2, alpha^2 / (t (alpha^2 - 1) + 1)^2 dt over [0, 1], and n.l = 2 t - 1 > 0.
TEST(Prefiltered, IsTheIntegralOverTheLobe) {
  for (const double alpha : {0.1, 0.4, 1.0}) {
    double cosines = 0, squares = 0;
    constexpr int n = 200000;
    for (int i = 0; i < n; ++i) {
      const double t = 0.5 + 0.5 * (i + 0.5) / n, cosine = 2 * t - 1, density = std::pow(alpha / (t * (alpha * alpha - 1) + 1), 2);
      cosines += density * cosine, squares += density * cosine * cosine;
    }
    const FilteredRadiance ramp = [](const Vec3d& l, double) { return Rgb{1, 1, 1} * std::max(dot(l, r), 0.0); };
    EXPECT_NEAR(prefiltered_karis(ramp, r, alpha, 4096).x, squares / cosines, 1e-3) << alpha;
  }
}

// A narrow lobe's samples stand for little each: level 0 where they stand for less than a texel, the last where for more than all.
TEST(Prefiltered, LevelsAreWhatASampleStandsFor) {
  const auto highest = [](double alpha, unsigned samples, double texel_sr) {
    double level = -1;
    const FilteredRadiance radiance = [&](const Vec3d&, double l) {
      level = std::max(level, l);
      return Rgb{1, 1, 1};
    };
    prefiltered_frostbite(radiance, r, alpha, samples, texel_sr, 6);
    return level;
  };
  EXPECT_EQ(highest(1e-3, 4, 1), 0);
  EXPECT_EQ(highest(0.9, 4, 1e-9), 6);
  // At alpha 1 the density is 1 / (4 pi) everywhere: 4 pi / samples over a texel of 4 pi / 4096 are 4096 / samples texels.
  EXPECT_NEAR(highest(1, 64, 4 * pi / 4096), 3, 1e-9);
}

struct Case {
  Emitter emitter;
  ShadingPoint point;
};
Case some_case(Random& random, double alpha) {
  const protocol::Placement p = protocol::place(protocol::Kind::rect, random, true);
  Vec3d view = random.direction();
  while (dot(view, p.normal) < 0.2) view = random.direction();
  return {p.emitter, {p.position, p.normal, p.normal, view, GgxLobe{alpha, {1, 1, 1}}}};
}
LightCard card_of(std::uint32_t side, const std::function<float(double, double)>& value) {
  LightCardBuilder builder(side, side);
  for (std::uint32_t y = 0; y < side; ++y) {
    std::vector<float> row;
    for (std::uint32_t x = 0; x < side; ++x)
      for (int c = 0; c < 4; ++c) row.push_back(value((x + 0.5) / side, (y + 0.5) / side));
    builder.add_row(row);
  }
  return std::move(builder).finish();
}

TEST(CardMethod, AUniformPictureIsTheUniformLight) {
  const LightCard card = card_of(8, [](double, double) { return 2.0f; });
  Random random(2);
  for (const CardMethod& m : card_methods()) {
    EXPECT_EQ(find_card_method(m.name), &m);
    for (int i = 0; i < 50; ++i) {
      Case c = some_case(random, random.log_uniform(0.01, 1));
      const auto lookups = m.lookups(c.emitter, card);
      EXPECT_FALSE(m.luminance(c.emitter, lookups, {c.point.position, c.point.normal, c.point.normal, c.point.view, DisneyDiffuse{}}));
      if (m.over_distance) c.point.brdf = Lambert{{1, 1, 1}};
      const auto light = m.luminance(c.emitter, lookups, c.point);
      ASSERT_TRUE(light) << m.name;
      const double expected = 2 * reference(c.emitter, c.point, {1e-4, 1e-7}).value.x;
      EXPECT_NEAR(light->x, expected, 0.3 * expected + 0.05) << m.name;  // LTC's and the moments' own errors
    }
  }
  EXPECT_EQ(find_card_method("nobody"), nullptr);
}

// A matt surface right before the middle of a picture that is bright there, facing it: by the symmetry the point that stands for the light
// is the middle, so what is left are the layers, which weigh with solid angles and not with their cosine (near the light, too much of its
// rim).
TEST(CardMethod, AMattSurfaceBeforeAPictureSeesItsMiddle) {
  const LightCard card =
      card_of(64, [](double u, double v) { return static_cast<float>(std::exp(-8 * ((u - 0.5) * (u - 0.5) + (v - 0.5) * (v - 0.5)))); });
  const CardMethod* m = find_card_method("drobot-diffuse-card");
  ASSERT_TRUE(m != nullptr);
  Random random(6);
  protocol::Placement p = protocol::place(protocol::Kind::rect, random, true);
  const auto& rectangle = std::get<PolygonEmitter>(p.emitter.shape);
  const auto& [origin, u, v] = rectangle.uv_frame;
  const CardLookups lookups = m->lookups(p.emitter, card);
  const double longer = std::max(length(u), length(v));
  for (const double distance : {0.25, 0.5, 1.0, 2.0, 5.0}) {
    const ShadingPoint point{origin + (u + v) * 0.5 + rectangle.normal * (distance * longer), -rectangle.normal, -rectangle.normal,
                             -rectangle.normal, Lambert{{1, 1, 1}}};
    const double exact = by_patches(p.emitter, card, point, {1e-4, 4096})->value.x, found = m->luminance(p.emitter, lookups, point)->x;
    EXPECT_NEAR(found, exact, (distance < 1 ? 0.25 : 0.03) * exact) << distance;
    EXPECT_LT(found, exact * 1.01) << distance;
  }
}

// A narrow lobe whose mirror direction meets a gradient shows what is there, whichever way it is looked up.
TEST(CardMethod, NarrowLobesLookUpWhereTheyMirror) {
  const LightCard card = card_of(64, [](double u, double v) { return static_cast<float>(u + 2 * v); });
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    Case c = some_case(random, 0.01);
    const auto& [origin, u, v] = std::get<PolygonEmitter>(c.emitter.shape).uv_frame;
    const Vec2d at{random.uniform(0.3, 0.7), random.uniform(0.3, 0.7)};
    const Vec3d l = normalised(origin + u * at.x + v * at.y - c.point.position);
    if (dot(l, c.point.normal) < 0.3) continue;
    c.point.view = c.point.normal * (2 * dot(l, c.point.normal)) - l;
    const double whole = reference(c.emitter, c.point, {1e-4, 1e-7}).value.x;
    if (whole < 0.8) continue;  // the rectangle covers most of the lobe
    for (const CardMethod& m : card_methods()) {
      const auto light = m.luminance(c.emitter, m.lookups(c.emitter, card), c.point);
      ASSERT_EQ(light.has_value(), !m.over_distance) << m.name;
      if (!light) continue;
      EXPECT_NEAR(light->x / whole, at.x + 2 * at.y, 0.25) << m.name;
    }
  }
}

}  // namespace
}  // namespace etendue::eval
