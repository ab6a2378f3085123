// Pooling, the statistics behind the verdict, the rule of the verdict, and what is refused.
#include "etendue/compare.h"
#include "compare/statistics.h"
#include "synthetic_pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace etendue {
namespace {

using namespace synthetic;
using namespace compare_detail;

Picture flat(std::uint32_t width, std::uint32_t height, float value) {
  Picture picture;
  picture.width = width;
  picture.height = height;
  auto& pixels = picture.add("", 3).pixels;
  std::fill(pixels.begin(), pixels.end(), value);
  return picture;
}

Picture noisy_reference(const Picture& truth, double relative, int seeds = 8, unsigned seed = 1) {
  std::mt19937_64 random(seed);
  Result<Picture> pooled = pool(runs_of(truth, seeds, gaussian(relative), random));
  EXPECT_TRUE(pooled.ok());
  return *pooled;
}

TEST(Pool, MeanAndVarianceOfTheMean) {
  std::vector<Picture> runs;
  for (float value : {1.F, 2.F, 3.F, 4.F, 5.F}) runs.push_back(flat(2, 1, value));
  const Result<Picture> pooled = pool(runs);
  ASSERT_TRUE(pooled.ok());
  EXPECT_FLOAT_EQ(pooled->find("")->pixels[0], 3);
  EXPECT_FLOAT_EQ(pooled->find("variance")->pixels[0], 2.5F / 5);  // s^2 = 10/4
  EXPECT_EQ(pooled->numbers.at("etendue:seeds"), 5);
}

TEST(Pool, KeepsLights) {
  const Picture truth = draw(rig(), View{16, 0, 0});
  const Picture pooled = noisy_reference(truth, .1);
  ASSERT_NE(pooled.find("light.key"), nullptr);
  ASSERT_NE(pooled.find("light_variance.key"), nullptr);
}

TEST(Pool, RefusesFewRunsAndUnequalSizes) {
  const Result<Picture> few = pool(std::vector<Picture>(4, flat(2, 2, 1)));
  ASSERT_FALSE(few.ok());
  EXPECT_EQ(few.error().code, "REFERENCE_TOO_FEW_SEEDS");
  std::vector<Picture> runs(5, flat(2, 2, 1));
  runs[3] = flat(3, 2, 1);
  const Result<Picture> unequal = pool(runs);
  ASSERT_FALSE(unequal.ok());
  EXPECT_EQ(unequal.error().code, "PICTURE_SIZE_MISMATCH");
}

TEST(Statistics, NormalQuantiles) {
  // Tables: P(|Z| > 1.959963984540054) = .05, P(|Z| > 3.290526731491690) = .001.
  EXPECT_NEAR(two_sided_quantile(.05), 1.959963984540054, 1e-12);
  EXPECT_NEAR(two_sided_quantile(.001), 3.290526731491690, 1e-12);
  for (double p : {.9, .1, 1e-6, 1e-15}) EXPECT_NEAR(std::erfc(two_sided_quantile(p) / std::sqrt(2.0)) / p, 1, 1e-11);
}

TEST(Statistics, SidakKeepsTheFamilyRate) {
  const double each = sidak_rate(1e-3, 100);
  EXPECT_NEAR(1 - std::pow(1 - each, 100), 1e-3, 1e-12);
}

TEST(Statistics, StudentsTAgainstTables) {
  // Two-sided 5 % and .1 % points of t (Abramowitz & Stegun, table 26.10).
  const auto check = [](double t, double nu, double z, double part) {
    EXPECT_LE(normal_from_t(t, nu), 1.0005 * z) << nu;
    EXPECT_GE(normal_from_t(t, nu), (1 - part) * z) << nu;
  };
  check(3.182, 3, 1.95996, .025);
  check(12.924, 3, 3.29053, .025);
  check(2.571, 5, 1.95996, .01);
  check(6.869, 5, 3.29053, .01);
  check(2.228, 10, 1.95996, .01);
  check(4.587, 10, 3.29053, .01);
  EXPECT_LT(normal_from_t(-2, 10), 0);
}

// The mean of n exponential values, studentised: below -3.09 it falls far more often than .1 % of the time; transformed about as often as
// that.
TEST(Statistics, HallTakesTheSkewnessAway) {
  std::mt19937_64 random(5);
  std::exponential_distribution<double> exponential(1);
  constexpr int n = 100, trials = 40000;
  int plain = 0, corrected = 0;
  for (int trial = 0; trial < trials; ++trial) {
    double sum = 0, squares = 0, cubes = 0;
    std::array<double, n> x{};
    for (double& value : x) sum += value = exponential(random);
    const double mean = sum / n;
    for (double value : x) {
      squares += (value - mean) * (value - mean);
      cubes += std::pow(value - mean, 3);
    }
    const double t = (mean - 1) / std::sqrt(squares / n / n);
    plain += t < -3.09;
    corrected += without_skewness(t, cubes / std::pow(squares, 1.5)) < -3.09;
  }
  EXPECT_GT(plain, 5 * trials / 1000);
  // Expected 40, standard deviation 6.3; the correction is of second order, hence twice that is allowed and no more.
  EXPECT_LT(corrected, 2 * trials / 1000);
}

TEST(Compare, RegionOfKnownDifference) {
  const Picture truth = flat(64, 64, 100);
  Picture ours = truth;
  for (std::size_t i = 0; i < ours.find("")->pixels.size(); i += 3) ours.find("")->pixels[i] = 103;
  const Result<Comparison> c = compare(ours, noisy_reference(truth, .02), {});
  ASSERT_TRUE(c.ok());
  ASSERT_EQ(c->regions[0].region, "all");
  EXPECT_EQ(c->regions[0].channel, 'R');
  // 64 x 64 pixels of relative noise .02/sqrt 8 each.
  const double error = .02 / std::sqrt(8.0) / 64;
  EXPECT_NEAR(c->regions[0].standard_error, error, .1 * error);
  EXPECT_NEAR(c->regions[0].difference, .03, 5 * error);
  EXPECT_NEAR(c->regions[1].difference, 0, 5 * error);
  EXPECT_EQ(c->verdict, Verdict::differs);
  EXPECT_NEAR(c->mean_rel, .2126 * .03, 5 * error);
}

TEST(Compare, SigmaHasTheNoiseOfBoth) {
  const Picture truth = flat(128, 128, 10);
  const Picture reference = noisy_reference(truth, .1, 16, 2);
  std::mt19937_64 random(3);
  Picture ours = *pool(runs_of(truth, 16, gaussian(.1), random));
  ours.numbers.clear();
  const Result<Comparison> c = compare(ours, reference, {});
  ASSERT_TRUE(c.ok());
  // The seeds' factor (K-3)/(K-1) is for a sigma from K seeds; here twice as many degrees of freedom: (30-2)/30 over (15-2)/15.
  EXPECT_NEAR(c->chi2_per_pixel, (13. / 15) * (30. / 28), .03);
  EXPECT_NEAR(c->noise_rms_rel, .1 * std::sqrt(2. / 16), .002);
  EXPECT_TRUE(c->findings.empty());
}

TEST(Compare, ChiSquaredIsOneForNoise) {
  const Picture truth = draw(rig(), View{128, 0, 0});
  for (int seeds : {5, 8, 16}) {
    const Result<Comparison> c = compare(truth, noisy_reference(truth, .1, seeds, 7), {});
    ASSERT_TRUE(c.ok());
    EXPECT_NEAR(c->chi2_per_pixel, 1, .08) << seeds;
    EXPECT_LT(std::abs(c->pixel_excess_z), c->threshold_z);
  }
}

// chi2_expected against noise that is drawn: its parts' shares of sigma^2 are those of the noise's mean variance, so that (K - 3)/(K - 1)
// alone is left where our variance is known and most of all, half of that where as much again is a bound that holds no noise, of the
// reference's sums or ours. The channels
// of a pixel share their noise: 128 x 128 squares of normal deviates, standard deviation sqrt(2)/128 = .011 of their mean.
TEST(Compare, ChiSquaredExpectedIsWhatDrawnNoiseGives) {
  constexpr int seeds = 16;
  constexpr double ours_known = 13.0 / 15, four_deviations = .045;
  struct Case {
    double reference_noise, our_noise, our_bound;  // relative standard deviations of a run, of our value; what our error may be
    double expected;
  };
  const double bound = 3e-5 * std::sqrt(double{seeds});
  for (const auto& [reference_noise, our_noise, our_bound, expected] :
       {Case{.02, 0, 0, 1}, Case{.02, .05, 0, ours_known}, Case{bound, 0, 0, .5 * ours_known}, Case{bound / 30, 0, 0, 0},
        Case{.02, 0, .005, .5 * ours_known}, Case{.02, .05, .05, .5 * ours_known}}) {
    const Picture truth = flat(128, 128, 10);
    const Picture reference = noisy_reference(truth, reference_noise, seeds, 3);
    std::mt19937_64 random(8);
    Picture ours = our_noise > 0 ? runs_of(truth, 1, gaussian(our_noise), random).front() : truth;
    auto& variance = ours.add("variance", 3).pixels;
    std::fill(variance.begin(), variance.end(), static_cast<float>(std::pow(10 * our_noise, 2) + std::pow(10 * our_bound, 2)));
    auto& supposed = ours.add("variance_bound", 3).pixels;
    std::fill(supposed.begin(), supposed.end(), static_cast<float>(std::pow(10 * our_bound, 2)));
    const Result<Comparison> c = compare(ours, reference, {});
    ASSERT_TRUE(c.ok());
    EXPECT_NEAR(c->chi2_per_pixel, c->chi2_expected, four_deviations * std::max(c->chi2_expected, .1)) << reference_noise << our_noise;
    // To second order in 1/K, of which the estimate knows nothing: 1/13^2, and as much where f and b are estimated together.
    EXPECT_NEAR(c->chi2_expected, expected, .05) << reference_noise << our_noise;
  }
}

// At the end of a light's window few samples see any of it, most of these hardly any, and what little they vary by is not how far they may
// be off: a tenth of the pixels gets from 1 to 100 of 16 x 64 samples lit, by 4 u^3 with u uniform from 0 to 1, of the mean 1.
TEST(Compare, LightThatFewSamplesSeeIsNoDifference) {
  constexpr int seeds = 16, samples = 64;
  Picture truth = flat(64, 64, 1);
  std::vector<float>& pixels = truth.find("")->pixels;
  std::mt19937_64 random(15);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto is_edge = [](std::size_t pixel) { return pixel % 10 == 0; };
  const auto lit_share = [&](std::size_t pixel) { return static_cast<double>(pixels[3 * pixel]); };
  for (std::size_t i = 0; i < 64 * 64; ++i) {
    const double seen = std::pow(100, uniform(random));
    if (is_edge(i)) std::fill_n(pixels.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, static_cast<float>(seen / (seeds * samples)));
  }
  for (int picture = 0; picture < 10; ++picture) {
    std::vector<Picture> runs = runs_of(truth, seeds, gaussian(.05), random);
    for (Picture& run : runs)
      for (std::size_t i = 0; i < 64 * 64; ++i) {
        if (!is_edge(i)) continue;
        double sum = 0;
        for (int k = 0; k < samples; ++k)
          if (uniform(random) < lit_share(i)) sum += 4 * std::pow(uniform(random), 3);
        for (std::size_t c = 0; c < 3; ++c) run.find("")->pixels[3 * i + c] = static_cast<float>(sum / samples);
      }
    const Result<Comparison> c = compare(truth, *pool(runs), {});
    ASSERT_TRUE(c.ok());
    EXPECT_LT(c->chi2_per_pixel, 1.08);
    EXPECT_GT(c->chi2_per_pixel, c->chi2_expected - .08);
  }
}

TEST(Compare, WithoutNoiseTheFloatSumsStillHaveSome) {
  const Picture truth = draw(rig(), View{64, 0, 0});
  Picture rounded = truth;
  std::mt19937_64 random(4);
  std::normal_distribution<double> rounding(1, 1e-5);
  for (float& value : rounded.find("")->pixels) value = static_cast<float>(value * rounding(random));
  const Result<Comparison> c = compare(rounded, *pool(std::vector<Picture>(5, truth)), {});
  ASSERT_TRUE(c.ok());
  EXPECT_EQ(c->verdict, Verdict::same);
  EXPECT_LT(c->chi2_per_pixel, 1);
  EXPECT_TRUE(c->findings.empty());
}

TEST(Compare, UndecidedSaysHowManySamples) {
  const Picture truth = flat(32, 32, 1);
  CompareOptions options;
  options.max_difference = .001;
  options.samples = 1000;
  const Result<Comparison> c = compare(truth, noisy_reference(truth, .2), options);
  ASSERT_TRUE(c.ok());
  EXPECT_EQ(c->verdict, Verdict::undecided);
  // SE of "all" is .2/sqrt 8/32 = .00221, X/4 = .00025: (8.84)^2 times the samples.
  ASSERT_TRUE(c->samples_needed);
  EXPECT_NEAR(static_cast<double>(*c->samples_needed), 78125, 12000);
}

TEST(Compare, NoisyTilesAreJudgedTogether) {
  const Picture truth = flat(64, 64, 1);
  CompareOptions options;
  options.max_difference = .006;  // X/4 = .0015; SE of a tile .1/sqrt 8/16 = .0022, of 2 x 2 tiles .0011
  const Result<Comparison> c = compare(truth, noisy_reference(truth, .1), options);
  ASSERT_TRUE(c.ok());
  EXPECT_EQ(c->verdict, Verdict::same);
  for (const RegionDifference& r : c->regions) EXPECT_EQ(r.merged, r.region.rfind("tile ", 0) == 0) << r.region;
}

TEST(Compare, DarkRegionsAreLeftOutAndListed) {
  Picture truth = flat(64, 64, 1);
  for (std::size_t i = 0; i < std::size_t{3} * 64 * 16; ++i) truth.find("")->pixels[i] = .01F;
  const Result<Comparison> c = compare(truth, noisy_reference(truth, .01), {});
  ASSERT_TRUE(c.ok());
  for (const RegionDifference& r : c->regions) {
    if (r.region.rfind("tile ", 0) == 0) {
      EXPECT_EQ(r.left_out, r.region.back() == '1') << r.region;
    }
  }
}

// Bright emitters neither darken the other regions nor hide in them; objects have their names.
TEST(Compare, EmittersAndObjectsAreRegions) {
  Picture truth = flat(64, 64, 1);
  truth.add("emitter", 1);
  truth.add("object", 1);
  auto& emitter = truth.find("emitter")->pixels;
  auto& object = truth.find("object")->pixels;
  for (std::size_t p = 0; p < emitter.size(); ++p) {
    object[p] = p % 64 < 32 ? 1.F : 2.F;
    if (p / 64 < 8 && p % 64 < 8) {
      emitter[p] = 1;
      object[p] = -1;
      for (std::size_t i = 3 * p; i < 3 * p + 3; ++i) truth.find("")->pixels[i] = 1e6F;
    }
  }
  Picture picture_only = flat(64, 64, 0);
  picture_only.find("")->pixels = truth.find("")->pixels;
  Picture ours = truth;
  for (std::size_t p = 0; p < emitter.size(); ++p) {
    if (p % 64 < 32) continue;
    for (std::size_t i = 3 * p; i < 3 * p + 3; ++i) ours.find("")->pixels[i] *= 1.05F;
  }
  const Result<Comparison> c = compare(ours, noisy_reference(picture_only, .01), {}, {"floor", "wall"});
  ASSERT_TRUE(c.ok());
  EXPECT_EQ(c->verdict, Verdict::differs);
  int seen = 0;
  for (const RegionDifference& r : c->regions) {
    EXPECT_FALSE(r.left_out) << r.region;
    if (r.region == "object wall") {
      EXPECT_NEAR(r.difference, .05, .001);
    }
    if (r.region == "object floor" || r.region == "visible emitters") {
      EXPECT_NEAR(r.difference, 0, .002) << r.region;
    }
    if (r.region == "visible emitters") {
      EXPECT_EQ(r.pixels, 64U);
    }
    seen += r.region == "object wall" || r.region == "object floor" || r.region == "visible emitters";
  }
  EXPECT_EQ(seen, 9);
}

TEST(Compare, OneLightsLayers) {
  const Picture truth = draw(rig(), View{64, 0, 0});
  Picture ours = truth;
  for (float& value : ours.find("light.spot")->pixels) value *= 1.1F;
  const Picture reference = noisy_reference(truth, .05);
  const Result<Comparison> spot = compare(ours, reference, {}, {}, "spot");
  ASSERT_TRUE(spot.ok());
  EXPECT_EQ(spot->verdict, Verdict::differs);
  EXPECT_TRUE(has_finding(*spot, "LIGHT_DIFFERS", "'spot'"));
  const Result<Comparison> key = compare(ours, reference, {}, {}, "key");
  ASSERT_TRUE(key.ok());
  EXPECT_EQ(key->verdict, Verdict::same);
}

TEST(Compare, BlackAgainstBlackIsTheSame) {
  const Picture black = flat(16, 16, 0);
  const Result<Comparison> same = compare(black, *pool(std::vector<Picture>(5, black)), {});
  ASSERT_TRUE(same.ok());
  EXPECT_EQ(same->verdict, Verdict::same);
  const Result<Comparison> differs = compare(flat(16, 16, 1), *pool(std::vector<Picture>(5, black)), {});
  ASSERT_TRUE(differs.ok());
  EXPECT_EQ(differs->verdict, Verdict::differs);
  for (const RegionDifference& r : differs->regions) EXPECT_TRUE(std::isfinite(r.difference) && std::isfinite(r.z));
}

TEST(Compare, Refusals) {
  const Picture truth = flat(16, 16, 1);
  const Picture reference = noisy_reference(truth, .1);
  EXPECT_EQ(compare(flat(8, 16, 1), reference, {}).error().code, "PICTURE_SIZE_MISMATCH");
  EXPECT_EQ(compare(truth, truth, {}).error().code, "REFERENCE_TOO_FEW_SEEDS");
  EXPECT_EQ(compare(truth, reference, {}, {}, "nobody").error().code, "LAYER_MISSING");
  Picture bad = truth;
  bad.find("")->pixels[5] = std::numeric_limits<float>::quiet_NaN();
  const Result<Comparison> refused = compare(bad, reference, {});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, "PICTURE_UNSUITABLE");
  EXPECT_NE(refused.error().text.find("pixel 1,0"), std::string::npos) << refused.error().text;
}

}  // namespace
}  // namespace etendue
