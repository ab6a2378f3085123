#include "etendue/picture_light.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>

#include "etendue/light_within.h"
#include "etendue/picture.h"
#include "eval_protocol.h"

namespace etendue::eval {
namespace {

using protocol::Random;

// Few texels of random colours, joined and repeated.
Pattern picture_of(std::uint32_t width, std::uint32_t height, unsigned seed) {
  Random random(seed);
  DecodedImage image{width, height, {}};
  for (std::size_t i = 0; i < std::size_t{4} * width * height; ++i) image.rgba.push_back(static_cast<float>(random.uniform(0, 1)));
  return [image](Vec2d uv) {
    const Rgba texel = sample(image, Texture{}, uv);
    return Rgb{texel.r, texel.g, texel.b};
  };
}
double node_polynomial(std::size_t k, double t) {
  const std::array<double, 3> nodes{-std::sqrt(0.6), 0, std::sqrt(0.6)};
  double product = 1;
  for (std::size_t j = 0; j < 3; ++j)
    if (j != k) product *= (t - nodes[j]) / (nodes[k] - nodes[j]);
  return product;
}

// Against the midpoint rule over 480 x 480 places: with kinks at texels, off by 1 / 480^2 times second differences of up to 5^2 x 4.
TEST(PictureMoments, AreIntegralsOverCells) {
  const Pattern pattern = picture_of(5, 3, 4);
  const PictureMoments picture(pattern, 5, 3);
  struct Place {
    int level;
    std::uint32_t x, y;
  };
  for (const Place& p : {Place{0, 0, 0}, Place{1, 1, 0}, Place{2, 0, 3}, Place{4, 7, 9}, Place{8, 255, 3}}) {
    const double side = std::ldexp(1.0, -p.level);
    std::array<Rgb, 9> weights;
    Rgb squares, mean;
    constexpr int n = 480;
    for (int i = 0; i < n * n; ++i) {
      const double s = (i % n + 0.5) / n, t = (i / n + 0.5) / n;
      const Rgb value = pattern({side * (p.x + s), side * (p.y + t)}) / (double{n} * n);
      for (std::size_t k = 0; k < 9; ++k) weights[k] += value * (node_polynomial(k % 3, 2 * s - 1) * node_polynomial(k / 3, 2 * t - 1));
      mean += value, squares += value * value * (double{n} * n);
    }
    const PictureMoments::Cell& cell = picture.cell(p.level, p.x, p.y);
    for (int c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(cell.weights[k][c], weights[k][c], 5e-4) << p.level << ' ' << k;
      EXPECT_NEAR(cell.deviation[c] * cell.deviation[c], squares[c] - mean[c] * mean[c], 5e-4) << p.level;
    }
  }
}

TEST(PictureMoments, MeanOfAll) {
  const PictureMoments picture([](Vec2d uv) { return Rgb{uv.x, uv.y < 0.5 ? 0.0 : 1.0, 2}; }, 256, 256);
  EXPECT_NEAR(picture.mean().x, 0.5, 1e-6);
  EXPECT_NEAR(picture.mean().z, 2, 1e-6);
}

struct Case {
  Emitter emitter;
  ShadingPoint point;
};
Case some_case(Random& random, const Brdf& brdf, bool above) {
  const protocol::Placement p = protocol::place(protocol::Kind::rect, random, above);
  Vec3d view = random.direction();
  while (dot(view, p.normal) < 0.1) view = random.direction();
  return {p.emitter, {p.position, p.normal, p.normal, view, brdf}};
}

// Against the reference, which knows the picture as a function. It and what is told of its error stand in the bound.
TEST(PictureLight, KeepsTheToleranceUnderEveryLobe) {
  const Pattern pattern = picture_of(3, 2, 7);
  const PictureMoments picture(pattern, 3, 2);
  Random random(12);
  int answered = 0;
  for (int i = 0; i < 60; ++i) {
    const double roughness = random.uniform(0.4, 1);
    const Brdf brdf = std::array<Brdf, 6>{Lambert{{0.8, 0.5, 0.2}},
                                          GgxLobe{roughness * roughness},
                                          Standard{{0.8, 0.3, 0.1}, 0.3, roughness},
                                          Conductor{{0.2, 0.9, 1.1}, {3.9, 2.4, 2.1}, roughness * roughness},
                                          OrenNayar{{0.5, 0.5, 0.5}, 0.4},
                                          Principled{{0.8, 0.3, 0.1}, 0, roughness}}[static_cast<std::size_t>(i % 6)];
    Case c = some_case(random, brdf, i % 3 != 0);
    c.emitter.pattern = pattern;
    const double floor = 1e-3 * illuminance(c.emitter, c.point.position, c.point.normal).x;
    const Estimate truth = reference(c.emitter, c.point, {1e-5, 1e-5 * floor});
    for (const double tolerance : {1e-2, 1e-3}) {
      const auto found = picture_luminance(c.emitter, picture, c.point, {tolerance, tolerance * floor});
      if (!found) continue;
      ++answered;
      for (int k = 0; k < 3; ++k) {
        EXPECT_LE(std::abs(found->value[k] - truth.value[k]), tolerance * std::max(truth.value[k], floor) + truth.error[k]) << i;
        EXPECT_LE(std::abs(found->value[k] - truth.value[k]), found->error[k] + truth.error[k]) << i;
      }
    }
  }
  EXPECT_GE(answered, 114);  // of 120
}

// Of a uniform picture it is the closed form.
TEST(PictureLight, AUniformPictureIsTheUniformLight) {
  const PictureMoments picture([](Vec2d) { return Rgb{1, 1, 1}; }, 1, 1);
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Case c = some_case(random, Lambert{{1, 1, 1}}, i % 2 == 0);
    const double exact = illuminance(c.emitter, c.point.position, c.point.normal).x / pi;
    const auto found = picture_luminance(c.emitter, picture, c.point, {1e-4, 0});
    if (!found) continue;
    EXPECT_NEAR(found->value.x, exact, 1e-4 * exact) << i;
    EXPECT_GE(found->error.x, std::abs(found->value.x - exact)) << i;
  }
}

// From behind there is nothing but of a light with two sides, whose picture is the same in place.
TEST(PictureLight, SidesOfTheLight) {
  const PictureMoments picture(picture_of(4, 4, 9), 4, 4);
  Random random(5);
  Case c = some_case(random, Lambert{{1, 1, 1}}, true);
  const double lit = picture_luminance(c.emitter, picture, c.point, {1e-4, 0})->value.x;
  EXPECT_GT(lit, 0);
  auto& rectangle = std::get<PolygonEmitter>(c.emitter.shape);
  rectangle.normal = -rectangle.normal;
  EXPECT_EQ(picture_luminance(c.emitter, picture, c.point, {1e-4, 0})->value.x, 0);
  c.emitter.two_sided = true;
  EXPECT_NEAR(picture_luminance(c.emitter, picture, c.point, {1e-4, 0})->value.x, lit, 1e-6 * lit);
}

TEST(PictureLight, SaysWhereItHasNoAnswer) {
  const PictureMoments picture(picture_of(4, 4, 9), 4, 4);
  Random random(6);
  Case c = some_case(random, Lambert{{1, 1, 1}}, true);
  EXPECT_FALSE(picture_luminance(c.emitter, picture, c.point, {1e-7, 0}));  // below the rounding of its weights
  Case narrow = c;
  narrow.point.brdf = GgxLobe{1e-4};
  const Vec3d l = normalised(std::get<PolygonEmitter>(c.emitter.shape).uv_frame[0] - c.point.position);
  narrow.point.view = c.point.normal * (2 * dot(l, c.point.normal)) - l;
  EXPECT_FALSE(picture_luminance(narrow.emitter, picture, narrow.point, {1e-3, 0}));
  Emitter window = c.emitter;
  window.window = {Falloff::frostbite, 10};
  EXPECT_FALSE(picture_luminance(window, picture, c.point, {1e-2, 0}));
  EXPECT_FALSE(carries_picture(protocol::white(DiskEmitter{{}, {0, 0, 1}, {1, 0, 0}, 1})));
}

// The planner takes it where the moments are given, with the floor of the tolerance, and what is left goes to the reference.
TEST(PictureLight, IsAWayOfThePlanner) {
  const Pattern pattern = picture_of(3, 3, 2);
  const auto picture = std::make_shared<const PictureMoments>(pattern, 3, 3);
  Random random(8);
  Case c = some_case(random, Standard{{0.5, 0.5, 0.5}, 0, 0.6}, true);
  c.emitter.pattern = pattern;
  const LightPlan plan(c.emitter, {1e-3, 0}, picture), without(c.emitter, {1e-3, 0});
  const LightWithin found = plan(c.point), other = without(c.point);
  EXPECT_EQ(found.way, "picture");
  EXPECT_EQ(other.way, "reference");
  EXPECT_NEAR(found.light.value.x, other.light.value.x, 2e-3 * other.light.value.x);
  ShadingPoint away = c.point;
  away.normal = away.surface_normal = -away.normal;
  away.view = -away.view;
  EXPECT_EQ(plan(away).light.value.x, 0);
  ShadingPoint mirror = c.point;
  mirror.brdf = GgxLobe{1e-4};
  const Vec3d l = normalised(std::get<PolygonEmitter>(c.emitter.shape).uv_frame[0] - c.point.position);
  mirror.view = mirror.normal * (2 * dot(l, mirror.normal)) - l;
  EXPECT_NE(plan(mirror).way, "picture");
}

}  // namespace
}  // namespace etendue::eval
