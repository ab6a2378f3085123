#include "etendue/diffuse_card.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace etendue::eval {
namespace {

LightCard card_of(std::uint32_t side, const std::function<double(double, double)>& value) {
  LightCardBuilder builder(side, side);
  for (std::uint32_t y = 0; y < side; ++y) {
    std::vector<float> row;
    for (std::uint32_t x = 0; x < side; ++x)
      for (int c = 0; c < 4; ++c) row.push_back(static_cast<float>(value((x + 0.5) / side, (y + 0.5) / side)));
    builder.add_row(row);
  }
  return std::move(builder).finish();
}

TEST(DiffuseCard, AUniformPictureIsItselfFromAnywhere) {
  const DiffuseCard volume(card_of(16, [](double, double) { return 3.0; }), 2, 0.5);
  for (const double distance : {1e-9, 0.1, 1.0, 7.0, 1e6})
    for (const double at : {-1.0, 0.0, 0.4, 2.0}) EXPECT_NEAR(volume.lookup({at, at}, distance).y, 3, 1e-6);
}

// Against the sum over 400 x 400 points with the solid angle of each, at places and distances that layers have (4 longer sides over 2^k,
// middles of 2^k): the cells' weights are 1 % off, much alike in neighbours.
TEST(DiffuseCard, LayersAreMeansBySolidAngle) {
  const auto picture = [](double u, double v) { return 1 + std::sin(5 * u) * std::cos(4 * v); };
  const double width = 1.5, height = 0.8;
  const DiffuseCard volume(card_of(256, picture), width, height);
  for (const int level : {0, 1, 2, 3, 4}) {
    const int side = 1 << level;
    const double r = 4 * width / side;
    for (const int k : {0, side / 2, side - 1}) {
      const Vec2d uv{(k + 0.5) / side, (side / 2 + 0.5) / side};
      double weights = 0, sum = 0;
      constexpr int n = 400;
      for (int i = 0; i < n * n; ++i) {
        const double u = (i % n + 0.5) / n, v = (i / n + 0.5) / n;
        const double weight = std::pow(std::hypot((u - uv.x) * width, (v - uv.y) * height, r), -3);
        sum += weight * picture(u, v), weights += weight;
      }
      EXPECT_NEAR(volume.lookup(uv, r).x, sum / weights, 0.005) << level << ' ' << k;
    }
  }
}

// Far away everything is the mean; close to the light a smooth picture is what is there.
TEST(DiffuseCard, FromAfarTheMeanAndFromNearThePicture) {
  const LightCard card = card_of(256, [](double u, double v) { return u + 2 * v; });
  const DiffuseCard volume(card, 1, 1);
  EXPECT_NEAR(volume.lookup({0.1, 0.9}, 20).x, 1.5, 1e-5);
  EXPECT_NEAR(volume.lookup({0.3, 0.6}, 0.001).x, 1.5, 0.05);
  EXPECT_NEAR(volume.lookup({0.3, 0.3}, 0.001).x, 0.9, 0.05);
  // Continuous over layers.
  for (double r = 0.01; r < 20; r *= 1.05) EXPECT_NEAR(volume.lookup({0.2, 0.7}, r).x, volume.lookup({0.2, 0.7}, r * 1.001).x, 2e-3) << r;
}

}  // namespace
}  // namespace etendue::eval
