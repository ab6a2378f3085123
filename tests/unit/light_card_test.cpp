#include "etendue/light_card.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "eval_protocol.h"

namespace etendue::eval {
namespace {

using protocol::Random;

using Texel = std::function<Rgb(double u, double v)>;
std::vector<float> row_of(std::uint32_t width, std::uint32_t height, std::uint32_t y, const Texel& texel) {
  std::vector<float> row;
  for (std::uint32_t x = 0; x < width; ++x) {
    const Rgb c = texel((x + 0.5) / width, (y + 0.5) / height);
    for (int i = 0; i < 3; ++i) row.push_back(static_cast<float>(c[i]));
    row.push_back(1);
  }
  return row;
}
LightCard card_of(std::uint32_t width, std::uint32_t height, const Texel& texel) {
  LightCardBuilder builder(width, height);
  for (std::uint32_t y = 0; y < height; ++y) builder.add_row(row_of(width, height, y, texel));
  return std::move(builder).finish();
}
// What a card stands for: texels joined bilinearly, as sample() of picture.h does with Wrap::clamp.
Rgb joined(std::uint32_t width, std::uint32_t height, const Texel& texel, Vec2d uv) {
  const auto place = [](double t, std::uint32_t n) { return std::clamp(t * n - 0.5, 0.0, n - 1.0); };
  const double x = place(uv.x, width), y = place(uv.y, height);
  const auto i = std::floor(x), j = std::floor(y);
  const auto at = [&](double a, double b) {
    return texel((std::min(a, width - 1.0) + 0.5) / width, (std::min(b, height - 1.0) + 0.5) / height);
  };
  const double u = x - i, v = y - j;
  return (at(i, j) * (1 - u) + at(i + 1, j) * u) * (1 - v) + (at(i, j + 1) * (1 - u) + at(i + 1, j + 1) * u) * v;
}

Rgb waves(double u, double v) { return {1 + std::sin(9 * u + 2 * v), 1 + std::cos(7 * v), u > 0.4 && v < 0.7 ? 3.0 : 0.2}; }

// 7 x 5 texels have nothing in common with halves and quarters.
TEST(LightCard, CellsAreExactMeansOfTheJoinedPicture) {
  const LightCard card = card_of(7, 5, waves);
  ASSERT_EQ(card.finest(), 4);
  for (int level = 0; level <= 4; ++level) {
    const std::uint32_t side = 1U << level;
    for (std::uint32_t y = 0; y < side; ++y) {
      for (std::uint32_t x = 0; x < side; ++x) {
        // Midpoints; the joined picture has kinks, which cost 1 / n^2.
        constexpr int n = 96;
        Rgb mean, squares;
        const int here = n / std::min(8, 1 << (level / 2));
        for (int j = 0; j < here; ++j) {
          for (int i = 0; i < here; ++i) {
            const Rgb t = joined(7, 5, waves, {(x + (i + 0.5) / here) / side, (y + (j + 0.5) / here) / side});
            mean += t / (here * here);
            squares += t * t / (here * here);
          }
        }
        const auto& cell = card.cell(level, x, y);
        double deviation = 0;
        for (int c = 0; c < 3; ++c) {
          EXPECT_NEAR(cell.mean[c], mean[c], 2e-3) << level << ": " << x << ", " << y;
          deviation = std::max(deviation, std::sqrt(std::max(squares[c] - mean[c] * mean[c], 0.0)));
        }
        EXPECT_GT(cell.deviation, deviation - 2e-3) << level << ": " << x << ", " << y;
      }
    }
  }
}

TEST(LightCard, LargePicturesAreMeanedDownToTheFinestLevel) {
  const LightCard card = card_of(3000, 2, [](double u, double v) { return Rgb{u, v < 0.5 ? 1.0 : 3.0, u * u}; });
  EXPECT_EQ(card.finest(), LightCard::most_levels);
  const auto& whole = card.cell(0, 0, 0);
  EXPECT_NEAR(whole.mean.x, 0.5, 1e-6);
  EXPECT_NEAR(whole.mean.y, 2, 1e-6);
  EXPECT_NEAR(whole.mean.z, 1.0 / 3, 1e-6);
}

TEST(LightCard, RowsThatNeverCameAreBlackAndTooManyAreIgnored) {
  LightCardBuilder builder(2, 2);
  const std::vector<float> row(8, 1.0f);
  builder.add_row(row);
  EXPECT_NEAR(LightCardBuilder(builder).finish().cell(0, 0, 0).mean.x, 0.5, 1e-7);
  builder.add_row(row);
  builder.add_row(row);
  EXPECT_NEAR(std::move(builder).finish().cell(0, 0, 0).mean.x, 1, 1e-7);
}

TEST(LightCard, LookupsAreMeansOfWhatTheLevelHas) {
  const LightCard ramp = card_of(64, 64, [](double u, double v) { return Rgb{u, v, 1}; });
  for (const double level : {3.0, 3.5, 6.0}) {
    const Rgb at = ramp.lookup({0.41, 0.7}, level);
    EXPECT_NEAR(at.x, 0.41, 1e-4) << level;
    EXPECT_NEAR(at.y, 0.7, 1e-4) << level;
  }
  EXPECT_NEAR(ramp.lookup({0.1, 0.9}, 0).x, 0.5, 1e-6);
  EXPECT_NEAR(ramp.lookup({-3, 0.5}, 6).x, ramp.lookup({0, 0.5}, 6).x, 1e-12);
}

struct Case {
  Emitter emitter;
  ShadingPoint point;
};
Case some_case(Random& random, bool above, const Brdf& brdf) {
  protocol::Placement p = protocol::place(protocol::Kind::rect, random, above);
  Vec3d view = random.direction();
  while (dot(view, p.normal) < 0.1) view = random.direction();
  return {p.emitter, {p.position, p.normal, p.normal, view, brdf}};
}

// A uniform picture has no deviation: one closed form, which is the light's own.
TEST(LightCard, AUniformPictureIsTheUniformLight) {
  const LightCard card = card_of(16, 8, [](double, double) { return Rgb{0.5, 1, 2}; });
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const Case matt = some_case(random, i % 2 == 0, Lambert{{1, 1, 1}});
    const auto light = by_patches(matt.emitter, card, matt.point);
    ASSERT_TRUE(light);
    EXPECT_EQ(light->patches, 1);
    const double lux = illuminance(matt.emitter, matt.point.position, matt.point.normal).x;
    EXPECT_NEAR(light->value.z, 2 * lux / pi, 1e-6 * lux);
    const Case shiny = some_case(random, i % 2 == 0, GgxLobe{random.log_uniform(0.02, 1), {0.04, 0.5, 1}});
    const Rgb expected = reference(shiny.emitter, shiny.point, {1e-5, 1e-9}).value * Rgb{0.5, 1, 2};
    const Rgb found = by_patches(shiny.emitter, card, shiny.point)->value;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 2e-3 * expected[c] + 1e-5) << i;
  }
}

// Sums of patches over a smooth picture against the adaptive quadrature that knows the picture as a function. 2 % is what the whole is for;
// the mean over the cases is far below that.
TEST(LightCard, PatchesAgreeWithTheQuadratureOfThePicture) {
  const LightCard card = card_of(256, 256, [](double u, double v) { return waves(u, v) * Rgb{1, 1, 0} + Rgb{0, 0, u * v}; });
  Random random(5);
  double error = 0, sum = 0;
  for (int i = 0; i < 40; ++i) {
    const Brdf brdf = i % 4 == 0 ? Brdf(Lambert{{0.5, 0.5, 0.5}}) : Brdf(GgxLobe{random.log_uniform(0.02, 1), {0.04, 0.5, 1}});
    Case c = some_case(random, i % 2 == 0, brdf);
    const auto light = by_patches(c.emitter, card, c.point, {0.003, 4096});
    ASSERT_TRUE(light);
    c.emitter.pattern = [](Vec2d uv) { return waves(uv.x, uv.y) * Rgb{1, 1, 0} + Rgb{0, 0, uv.x * uv.y}; };
    const Rgb expected = reference(c.emitter, c.point, {1e-4, 1e-7}).value;
    for (int k = 0; k < 3; ++k) error += std::abs(light->value[k] - expected[k]), sum += expected[k];
  }
  EXPECT_LT(error / sum, 0.01);
}

// More patches, less error: with a tolerance of 0 the number alone ends the splitting.
TEST(LightCard, MorePatchesLeaveLess) {
  const LightCard card = card_of(64, 64, [](double u, double v) {
    return std::fmod(8 * u, 1) + std::fmod(8 * v, 1) < 1 ? Rgb{1, 1, 1} : Rgb{};
  });
  Random random(8);
  double few = 0, more = 0;
  for (int i = 0; i < 30; ++i) {
    const Case c = some_case(random, true, Lambert{{1, 1, 1}});
    const double all = by_patches(c.emitter, card, c.point, {0, 20000})->value.x;
    few += std::abs(by_patches(c.emitter, card, c.point, {0, 5})->value.x - all);
    more += std::abs(by_patches(c.emitter, card, c.point, {0, 350})->value.x - all);
    EXPECT_LE(by_patches(c.emitter, card, c.point, {0, 350})->patches, 350);
  }
  EXPECT_LT(more, 0.25 * few);
}

TEST(LightCard, RefusesWhatItDoesNotTake) {
  const LightCard card = card_of(2, 2, waves);
  Random random(1);
  Case c = some_case(random, true, Lambert{{1, 1, 1}});
  c.point.brdf = DisneyDiffuse{};
  EXPECT_FALSE(by_patches(c.emitter, card, c.point));
  c.point.brdf = Lambert{{1, 1, 1}};
  Emitter other = c.emitter;
  other.shape = SphereEmitter{{0, 0, 0}, 1};
  EXPECT_FALSE(by_patches(other, card, c.point));
  other = c.emitter;
  std::get<PolygonEmitter>(other.shape).vertices.pop_back();
  EXPECT_FALSE(by_patches(other, card, c.point));
  other = c.emitter;
  other.window = {Falloff::frostbite, 3};
  EXPECT_FALSE(by_patches(other, card, c.point));
}

}  // namespace
}  // namespace etendue::eval
