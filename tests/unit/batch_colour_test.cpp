#include "etendue/batch.h"
#include "etendue/srgb.h"

#include "instruction_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace etendue {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

// 800 K to 100000 K in equal ratios, and infinity.
std::vector<float> temperatures() {
  std::vector<float> kelvin(3001);
  for (std::size_t i = 0; i < kelvin.size(); ++i)
    kelvin[i] = std::clamp(static_cast<float>(800 * std::pow(125, static_cast<double>(i) / 3000)), 800.0f, 1e5f);
  kelvin.push_back(infinity);
  return kelvin;
}

TEST(BatchPlanckian, XyIsThatOfTheDouble) {
  const std::vector<float> kelvin = temperatures();
  std::vector<Chromaticity> exact(kelvin.size());
  std::transform(kelvin.begin(), kelvin.end(), exact.begin(), [](float t) { return *planckian(t); });
  std::vector<Vec2f> xy(kelvin.size());
  on_each_instruction_set([&] {
    const BatchOutcome done = planckian(kelvin, xy, {});
    ASSERT_TRUE(done.ok());
    EXPECT_EQ(*done, 0U);
    double worst = 0;
    for (std::size_t i = 0; i < xy.size(); ++i) worst = std::max(worst, difference_uv1976({xy[i].x, xy[i].y}, exact[i]));
    EXPECT_LE(worst, 6e-7);  // of the 1e-6 asked for
  });
}

TEST(BatchPlanckian, RgbIsThatOfTheDouble) {
  const std::vector<float> kelvin = temperatures();
  std::vector<Rgb> exact(kelvin.size());
  std::transform(kelvin.begin(), kelvin.end(), exact.begin(), [](float t) { return to_rgb(*planckian(t)); });
  std::vector<Vec3f> rgb(kelvin.size());
  on_each_instruction_set([&] {
    const BatchOutcome done = planckian_rgb(kelvin, rgb, {});
    ASSERT_TRUE(done.ok());
    EXPECT_EQ(*done, 0U);
    double worst = 0, worst_uv = 0, worst_luminance = 0;
    for (std::size_t i = 0; i < rgb.size(); ++i) {
      const Rgb made = vec_cast<double>(rgb[i]), difference = made - exact[i];
      worst = std::max(worst, std::max({std::abs(difference.x), std::abs(difference.y), std::abs(difference.z)}) /
                                  std::max({exact[i].x, exact[i].y, exact[i].z}));
      worst_uv = std::max(worst_uv, difference_uv1976(to_chromaticity(made), to_chromaticity(exact[i])));
      worst_luminance = std::max(worst_luminance, std::abs(luminance_of(made) - 1));
    }
    EXPECT_LE(worst, 6e-6);
    EXPECT_LE(worst_uv, 8e-7);  // of the 1e-6 asked for
    EXPECT_LE(worst_luminance, 3e-7);
  });
}

TEST(BatchPlanckian, OutsideItsDomainIsCounted) {
  const std::vector<float> kelvin = {799.9f, 0, -100, std::nanf(""), 100001, 6500, -infinity, 1e-40f};
  std::vector<Vec2f> xy(kelvin.size());
  std::vector<Vec3f> rgb(kelvin.size());
  on_each_instruction_set([&] {
    const BatchOutcome with_xy = planckian(kelvin, xy, {-1, -2}), with_rgb = planckian_rgb(kelvin, rgb, {-1, -2, -3});
    ASSERT_TRUE(with_xy.ok() && with_rgb.ok());
    EXPECT_EQ(*with_xy, 7U);
    EXPECT_EQ(*with_rgb, 7U);
    for (std::size_t i = 0; i < kelvin.size(); ++i) {
      EXPECT_EQ(xy[i] == (Vec2f{-1, -2}), kelvin[i] != 6500) << kelvin[i];
      EXPECT_EQ(rgb[i] == (Vec3f{-1, -2, -3}), kelvin[i] != 6500) << kelvin[i];
    }
  });
}

// All magnitudes up to half's largest, and beyond the ends.
std::vector<float> encoded_values() {
  std::vector<float> values = {0, 1, -0.5f, 0.04045f, std::nextafter(0.04045f, 1.0f), 0.0031308f, std::nextafter(0.0031308f, 1.0f), 65504};
  for (int i = 0; i < 20000; ++i) values.push_back(static_cast<float>(1e-6 * std::pow(6.5e10, i / 20000.0)));
  for (int i = 0; i <= 255; ++i) values.push_back(static_cast<float>(i) / 255);
  return values;
}

TEST(BatchSrgb, IsThatOfTheDoubles) {
  const std::vector<float> values = encoded_values();
  std::vector<float> linear(values.size()), encoded(values.size());
  on_each_instruction_set([&] {
    ASSERT_TRUE(srgb_to_linear(values, linear).ok());
    ASSERT_TRUE(linear_to_srgb(values, encoded).ok());
    double worst = 0, worst_below_one = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double decoding = srgb_to_linear(static_cast<double>(values[i])), encoding = linear_to_srgb(static_cast<double>(values[i]));
      for (const double error : {std::abs(linear[i] - decoding) / std::max(1e-30, std::abs(decoding)),
                                 std::abs(encoded[i] - encoding) / std::max(1e-30, std::abs(encoding))})
        worst = std::max(worst, error);
      if (values[i] > 1) continue;
      worst_below_one = std::max({worst_below_one, std::abs(linear[i] - decoding), std::abs(encoded[i] - encoding)});
    }
    EXPECT_LE(worst, 7e-7);
    EXPECT_LE(worst_below_one, 2.5e-7);
  });
}

TEST(BatchSrgb, NaNStaysAndNothingFiniteBecomesInfinite) {
  std::vector<float> values = {std::nanf(""), 3e38f, -3e38f};
  on_each_instruction_set([&] {
    std::vector<float> linear(3), encoded(3);
    ASSERT_TRUE(srgb_to_linear(values, linear).ok());
    ASSERT_TRUE(linear_to_srgb(values, encoded).ok());
    EXPECT_TRUE(std::isnan(linear[0]) && std::isnan(encoded[0]));
    for (std::size_t i = 1; i < 3; ++i) EXPECT_TRUE(std::isfinite(linear[i])) << i;
    EXPECT_TRUE(std::isfinite(encoded[1]));
  });
}

}  // namespace
}  // namespace etendue
