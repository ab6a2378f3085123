// What the comparison finds, and that it finds nothing where nothing is.
#include "synthetic_pictures.h"

#include <gtest/gtest.h>

#include <cmath>

namespace etendue {
namespace {

using namespace synthetic;

constexpr int seeds = 8;
// Of a seed's pixel, one light: 4 % at 1024 samples in all (facts on Mitsuba's noise) is .04 sqrt(8) a seed.
const double seed_noise = .04 * std::sqrt(8.0);

Comparison compare_with(const Picture& ours, const Picture& truth, double max_difference, unsigned seed = 1,
                        const Noise& noise = gaussian(seed_noise)) {
  std::mt19937_64 random(seed);
  const Result<Picture> reference = pool(runs_of(truth, seeds, noise, random));
  EXPECT_TRUE(reference.ok());
  CompareOptions options;
  options.max_difference = max_difference;
  options.samples = 1024;
  const Result<Comparison> comparison = compare(ours, *reference, options);
  EXPECT_TRUE(comparison.ok()) << (comparison.ok() ? "" : comparison.error().text);
  return comparison.ok() ? *comparison : Comparison{};
}

Picture beauty_only(const Picture& picture) {
  Picture result;
  result.width = picture.width;
  result.height = picture.height;
  result.add("", 3).pixels = picture.find("")->pixels;
  return result;
}

template <class F>
Picture changed(Picture picture, F&& change) {
  for (Layer& layer : picture.layers) {
    for (float& value : layer.pixels) value = static_cast<float>(change(value));
  }
  return picture;
}

TEST(ComparePower, EqualPicturesAreTheSame) {
  const Picture truth = draw(rig(), View{});
  const Comparison c = compare_with(truth, truth, .01);
  EXPECT_EQ(c.verdict, Verdict::same) << findings_text(c);
  EXPECT_TRUE(c.findings.empty()) << findings_text(c);
  EXPECT_NEAR(c.chi2_per_pixel, 1, .08);
}

TEST(ComparePower, HalfAPercentIsAGlobalScale) {
  const Picture truth = draw(rig(), View{});
  const Comparison c = compare_with(changed(truth, [](float v) { return 1.005 * v; }), truth, .002);
  EXPECT_EQ(c.verdict, Verdict::differs);
  ASSERT_EQ(c.findings.size(), 1U) << findings_text(c);
  EXPECT_EQ(c.findings[0].code, "GLOBAL_SCALE");
  EXPECT_NEAR(c.findings[0].size, 1.005, .001);
}

// Far below the noise of a pixel, and hidden in that of chi-squared.
TEST(ComparePower, ATenthOfAPercentIsAGlobalScale) {
  const Picture truth = beauty_only(draw(rig(), View{}));
  const Comparison c = compare_with(changed(truth, [](float v) { return 1.001 * v; }), truth, .0005, 1, gaussian(.05));
  EXPECT_LT(std::abs(c.pixel_excess_z), c.threshold_z);
  ASSERT_EQ(c.findings.size(), 1U) << findings_text(c);
  EXPECT_EQ(c.findings[0].code, "GLOBAL_SCALE");
}

TEST(ComparePower, GammaIsTold) {
  const Picture truth = draw(rig(), View{});
  for (double exponent : {1.02, 1 / 2.2}) {
    const Comparison c = compare_with(changed(truth, [&](float v) { return std::pow(v, exponent); }), truth, .002);
    EXPECT_EQ(c.verdict, Verdict::differs);
    ASSERT_FALSE(c.findings.empty());
    EXPECT_EQ(c.findings[0].code, "GAMMA") << findings_text(c);
    EXPECT_NEAR(c.findings[0].size, exponent, .02 * exponent) << findings_text(c);
  }
}

TEST(ComparePower, HalfAPixelIsAShift) {
  const Picture truth = draw(rig(), View{});
  for (const auto& [dx, dy] : {std::pair{.5, 0.0}, std::pair{.5, -.5}, std::pair{0.0, .25}}) {
    const Comparison c = compare_with(draw(rig(), View{128, dx, dy}), truth, .002);
    EXPECT_EQ(c.verdict, Verdict::differs);
    ASSERT_FALSE(c.findings.empty());
    EXPECT_EQ(c.findings[0].code, "SHIFT") << findings_text(c);
    EXPECT_NEAR(c.findings[0].size, std::hypot(dx, dy), .1) << findings_text(c);
  }
}

// Convolution with [a, 1 - 2a, a] along rows and columns has the variance 2a.
Picture filtered(const Picture& picture, double a) {
  Picture result = picture;
  const int size = static_cast<int>(picture.width);
  for (Layer& layer : result.layers) {
    for (int pass = 0; pass < 2; ++pass) {
      const std::vector<float> from = layer.pixels;
      const auto at = [&](int x, int y, int c) {
        return from[static_cast<std::size_t>(3 * (std::clamp(y, 0, size - 1) * size + std::clamp(x, 0, size - 1)) + c)];
      };
      const int sx = pass == 0 ? 1 : 0, sy = 1 - sx;
      for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
          for (int c = 0; c < 3; ++c) {
            layer.pixels[static_cast<std::size_t>(3 * (y * size + x) + c)] =
                static_cast<float>((1 - 2 * a) * at(x, y, c) + a * (at(x - sx, y - sy, c) + at(x + sx, y + sy, c)));
          }
        }
      }
    }
  }
  return result;
}

TEST(ComparePower, PixelFilterIsTold) {
  const Picture truth = draw(rig(), View{});
  const Picture smooth = filtered(truth, .125);
  const Comparison of_reference = compare_with(truth, smooth, .002);
  EXPECT_EQ(of_reference.verdict, Verdict::differs);
  ASSERT_FALSE(of_reference.findings.empty());
  EXPECT_EQ(of_reference.findings[0].code, "PIXEL_FILTER") << findings_text(of_reference);
  EXPECT_NEAR(of_reference.findings[0].size, .5, .1);
  const Comparison of_ours = compare_with(smooth, truth, .002);
  ASSERT_FALSE(of_ours.findings.empty());
  EXPECT_EQ(of_ours.findings[0].code, "PIXEL_FILTER") << findings_text(of_ours);
  EXPECT_LT(of_ours.findings[0].size, 0);
}

// "tiny" has 1 % of the rig's flux: .16 of 16.46.
TEST(ComparePower, MissingLightOfOnePercentIsNamed) {
  const Picture truth = draw(rig(), View{});
  std::vector<Lamp> lamps = rig();
  lamps.pop_back();
  const Picture without = draw(lamps, View{});
  const Comparison layers = compare_with(without, truth, .002);
  EXPECT_EQ(layers.verdict, Verdict::differs);
  EXPECT_TRUE(has_finding(layers, "LIGHT_MISSING", "'tiny'")) << findings_text(layers);
  EXPECT_EQ(layers.findings.size(), 1U) << findings_text(layers);
  const Comparison beauty = compare_with(beauty_only(without), truth, .002);
  EXPECT_TRUE(has_finding(beauty, "LIGHT_MISSING", "'tiny'")) << findings_text(beauty);
  Picture wrong_beauty = truth;
  wrong_beauty.find("")->pixels = without.find("")->pixels;
  const Comparison own_layers = compare_with(wrong_beauty, truth, .002);
  EXPECT_TRUE(has_finding(own_layers, "LIGHT_MISSING", "'tiny'")) << findings_text(own_layers);
}

TEST(ComparePower, DimmedLightIsNamedWithItsFactor) {
  const Picture truth = draw(rig(), View{});
  std::vector<Lamp> lamps = rig();
  lamps[1].flux *= .9;
  const Comparison c = compare_with(draw(lamps, View{}), truth, .002);
  ASSERT_TRUE(has_finding(c, "LIGHT_DIFFERS", "'fill'")) << findings_text(c);
  EXPECT_NEAR(c.findings[0].size, .9, .01);
}

TEST(ComparePower, LightTurnedByTwoDegreesIsNamed) {
  const Picture truth = draw(rig(), View{});
  for (const std::size_t which : {std::size_t{0}, std::size_t{2}}) {  // a rectangle and a spot
    std::vector<Lamp> lamps = rig();
    lamps[which].tilt_deg += 2;
    const Picture turned = draw(lamps, View{});
    const Comparison layers = compare_with(turned, truth, .002);
    EXPECT_EQ(layers.verdict, Verdict::differs);
    EXPECT_TRUE(has_finding(layers, "LIGHT_TURNED", "'" + lamps[which].name + "'")) << findings_text(layers);
    EXPECT_EQ(layers.findings.size(), 1U) << findings_text(layers);
    Picture wrong_beauty = truth;
    wrong_beauty.find("")->pixels = turned.find("")->pixels;
    const Comparison beauty = compare_with(wrong_beauty, truth, .002);
    EXPECT_TRUE(has_finding(beauty, "LIGHT_TURNED", "'" + lamps[which].name + "'")) << findings_text(beauty);
  }
}

// Alone, a light has no other to be told from: its turn must not be taken for a gamma or a shift.
TEST(ComparePower, OnlyLightTurnedIsNamed) {
  for (const std::size_t which : {std::size_t{0}, std::size_t{2}}) {
    std::vector<Lamp> lamps{rig()[which]};
    const Picture truth = draw(lamps, View{});
    lamps[0].tilt_deg += 2;
    const Comparison c = compare_with(draw(lamps, View{}), truth, .002);
    EXPECT_EQ(c.verdict, Verdict::differs);
    EXPECT_TRUE(has_finding(c, "LIGHT_TURNED", "'" + lamps[0].name + "'")) << findings_text(c);
  }
}

// A patch that no hypothesis explains is at least located.
TEST(ComparePower, LocalErrorIsLocated) {
  const Picture truth = beauty_only(draw(rig(), View{}));
  Picture ours = truth;
  for (std::size_t y = 100; y < 120; ++y) {
    for (std::size_t i = 3 * (y * 128 + 100); i < 3 * (y * 128 + 120); ++i) ours.find("")->pixels[i] *= 1.1F;
  }
  const Comparison c = compare_with(ours, truth, .002);
  EXPECT_EQ(c.verdict, Verdict::differs);
  EXPECT_TRUE(has_finding(c, "REGION", "tile 4,4")) << findings_text(c);
}

// With max_difference 0 significance alone decides: the hardest setting for false alarms. The family-wise rate asked for is 1e-3; 120 pairs
// expect .12, and 3 or more would have a probability of 3e-4.
TEST(ComparePower, NoFalseAlarms) {
  const Picture truth = beauty_only(draw(rig(), View{64, 0, 0}));
  const std::vector<std::pair<const char*, Noise>> kinds{{"Gaussian", gaussian(.3)},
                                                         {"gamma, shape 1", gamma_noise(1)},
                                                         {"gamma, shape .1", gamma_noise(.1)},
                                                         {"fireflies", fireflies(.1, 1e-3, 50)},
                                                         {"large fireflies", fireflies(.05, 5e-4, 100)}};
  for (const auto& [name, noise] : kinds) {
    int alarms = 0, findings = 0;
    for (unsigned pair = 0; pair < 24; ++pair) {
      const Comparison c = compare_with(truth, truth, 0, 1000 + pair, noise);
      alarms += c.verdict == Verdict::differs;
      findings += c.findings.empty() ? 0 : 1;
    }
    EXPECT_LE(alarms, 2) << name;
    EXPECT_LE(findings, 2) << name;
  }
}

}  // namespace
}  // namespace etendue
