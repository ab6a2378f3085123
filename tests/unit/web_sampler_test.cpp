#include "etendue/web_sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "instruction_sets.h"
#include "photometry_builder.h"

namespace etendue {
namespace {

using test::distribution_of;
using test::steps;

double bumpy(const Vec3d& u) { return std::max(0.0, 60 + 60 * u.x + 35 * std::sin(5 * u.y) - 30 * u.z + 20 * std::cos(9 * u.x * u.z)); }

std::vector<IntensityDistribution> distributions() {
  const std::vector<double> gamma{0, 3, 10, 11, 40, 77.5, 90, 120, 180}, half{0, 7, 30, 90}, whole{-90, -22, 0, 5, 90};
  return {distribution_of(WebType::c, WebSymmetry::none, gamma, {0, 110, 200, 310}, bumpy),
          distribution_of(WebType::c, WebSymmetry::rotational, gamma, {0}, bumpy),
          distribution_of(WebType::c, WebSymmetry::quadrant, gamma, {0, 20, 35, 90}, bumpy),
          distribution_of(WebType::c, WebSymmetry::about_0_180, steps(0, 90, 2.5), {0, 20, 100, 180}, bumpy),
          distribution_of(WebType::c, WebSymmetry::about_90_270, steps(0, 180, 2.5), {-90, -80, 30, 90}, bumpy),
          distribution_of(WebType::b, WebSymmetry::none, whole, whole, bumpy),
          distribution_of(WebType::b, WebSymmetry::lateral, whole, half, bumpy),
          distribution_of(WebType::a, WebSymmetry::vertical, half, whole, bumpy),
          distribution_of(WebType::a, WebSymmetry::lateral_and_vertical, half, half, bumpy)};
}

constexpr Interpolation all_interpolations[] = {Interpolation::linear, Interpolation::cosine, Interpolation::cubic};

// pdf = I / flux is what the estimator of an unoccluded flux divides by: I / pdf is the flux at every sample.
TEST(WebSampler, DensityIsTheIntensityOverTheFlux) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const auto& d : distributions()) {
    for (const Interpolation interpolation : all_interpolations) {
      const IntensityWeb web = test::web_of(d, interpolation, {false, 33});
      const WebSampler sampler(web);
      for (int i = 0; i < 300; ++i) {
        const Vec2d u{uniform(random), uniform(random)};
        const WebSampler::Sample s = sampler.sample(u);
        ASSERT_GT(s.pdf, 0);
        EXPECT_NEAR(s.cd / s.pdf / web.flux_lm(), 1, 1e-12);
        EXPECT_NEAR(web.towards(s.direction), s.cd, 1e-8 * web.max_cd());
        EXPECT_NEAR(length(s.direction), 1, 1e-14);
        const Vec2d back = sampler.inverse(s.direction);
        EXPECT_NEAR(back.x, u.x, 1e-8);
        EXPECT_NEAR(back.y, u.y, 1e-6);
      }
    }
  }
}

// Chi-square over bins of equal solid angle, expected counts by a fine midpoint rule over each bin. With k bins the statistic has mean k
// and standard deviation sqrt(2 k): five of them are allowed.
TEST(WebSampler, SamplesFollowTheWeb) {
  constexpr int bins_z = 12, bins_phi = 12, bins = bins_z * bins_phi, fine = 20;
  const char* const wanted = std::getenv("ETENDUE_SAMPLES");
  const int samples = wanted != nullptr ? std::atoi(wanted) : 200'000;
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const auto& d : distributions()) {
    for (const Interpolation interpolation : all_interpolations) {
      if (interpolation == Interpolation::cubic && wanted == nullptr && d.grid.type != WebType::b) continue;
      const IntensityWeb web = test::web_of(d, interpolation);
      const WebSampler sampler(web);
      std::vector<double> expected(bins), found(bins);
      double total = 0;
      for (int b = 0; b < bins; ++b) {
        for (int i = 0; i < fine * fine; ++i) {
          const int row = b / bins_phi, fine_row = i / fine;
          const double z = -1 + 2 * (row + (fine_row + 0.5) / fine) / bins_z;
          const double phi = 2 * pi * (b % bins_phi + (i % fine + 0.5) / fine) / bins_phi, r = std::sqrt(1 - z * z);
          expected[static_cast<std::size_t>(b)] += web.towards({r * std::cos(phi), r * std::sin(phi), z});
        }
        total += expected[static_cast<std::size_t>(b)];
      }
      for (int i = 0; i < samples; ++i) {
        const Vec3d v = sampler.sample({uniform(random), uniform(random)}).direction;
        const int row = std::min(static_cast<int>((v.z + 1) / 2 * bins_z), bins_z - 1);
        double turn = std::atan2(v.y, v.x) / (2 * pi);
        if (turn < 0) turn += 1;
        found[static_cast<std::size_t>(row) * bins_phi + std::min(static_cast<std::size_t>(turn * bins_phi), std::size_t{bins_phi - 1})] +=
            1;
      }
      double statistic = 0, counted = 0;
      for (int b = 0; b < bins; ++b) {
        const double e = expected[static_cast<std::size_t>(b)] / total * samples, f = found[static_cast<std::size_t>(b)];
        if (e < 20) continue;
        statistic += (f - e) * (f - e) / e;
        counted += 1;
      }
      EXPECT_LT(statistic, counted + 5 * std::sqrt(2 * counted)) << name_of(d.grid.type) << " " << name_of(d.grid.symmetry);
    }
  }
}

// Many at once are each what it is alone, wherever the table makes the inversion hard: at poles, beside zeros, in intervals of 90 degrees.
// A vector's place among the others and the length of the whole change nothing.
TEST(WebSampler, ManyAtOnceAreEachTheSame) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Vec2d> u{{0, 0}, {0, 0.999}, {1 - 0x1p-53, 0.5}, {0.5, 0}, {1e-12, 0.3}, {1 - 1e-12, 0.7}};
  while (u.size() < 1003) u.push_back({uniform(random), uniform(random)});
  std::vector<IntensityDistribution> all = distributions();
  all.push_back(distribution_of(WebType::c, WebSymmetry::none, {0, 90, 180}, {0, 90, 180, 270}, bumpy));
  all.push_back(distribution_of(WebType::c, WebSymmetry::none, steps(0, 180, 5), steps(0, 355, 5),
                                [](const Vec3d& v) { return std::max(0.0, std::sin(9 * v.x) - v.z); }));
  for (const auto& d : all) {
    for (const WebFrame& frame : {WebFrame{}, WebFrame{true, 33}}) {
      const IntensityWeb web = test::web_of(d, Interpolation::linear, frame);
      const WebSampler sampler(web);
      on_each_instruction_set([&] {
        std::vector<WebSampler::Sample> samples(u.size()), few(7);
        ASSERT_TRUE(sampler.sample(u, samples));
        ASSERT_TRUE(sampler.sample(std::span(u).subspan(100, 7), few));
        for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(few[i].cd, samples[100 + i].cd);
        for (std::size_t i = 0; i < u.size(); ++i) {
          const WebSampler::Sample one = sampler.sample(u[i]), &s = samples[i];
          // Where there is little light, the last digit of u is a long way; no table changes by more than its peak a degree.
          const double way = 1e-12 + 1e-15 * web.max_cd() / one.cd;
          ASSERT_NEAR(length(s.direction - one.direction), 0, way) << name_of(d.grid.type) << " " << i;
          ASSERT_NEAR(s.cd, one.cd, 60 * way * web.max_cd());
          EXPECT_NEAR(s.cd / s.pdf / web.flux_lm(), 1, 1e-12);
        }
      });
    }
  }
}

TEST(WebSampler, OtherInterpolationsAreDrawnOneByOne) {
  const std::vector<Vec2d> u{{0.3, 0.4}, {0.8, 0.1}};
  for (const Interpolation interpolation : {Interpolation::cosine, Interpolation::cubic}) {
    const IntensityWeb web = test::web_of(distributions()[0], interpolation);
    const WebSampler sampler(web);
    std::vector<WebSampler::Sample> samples(2);
    ASSERT_TRUE(sampler.sample(u, samples));
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(samples[i].cd, sampler.sample(u[i]).cd);
  }
}

TEST(WebSampler, SizesMustAgree) {
  const IntensityWeb web = test::web_of(distributions()[0]);
  std::vector<WebSampler::Sample> samples(3);
  const Status done = WebSampler(web).sample(std::vector<Vec2d>(2), samples);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, "BATCH_SIZES_DIFFER");
}

TEST(WebSampler, ADarkWebGivesNothing) {
  const auto d = distribution_of(WebType::c, WebSymmetry::rotational, {0, 90}, {0}, [](const Vec3d&) { return 0; });
  const IntensityWeb web = test::web_of(d);
  EXPECT_EQ(WebSampler(web).sample({0.3, 0.4}).pdf, 0);
  std::vector<WebSampler::Sample> samples(1);
  ASSERT_TRUE(WebSampler(web).sample(std::vector<Vec2d>{{0.3, 0.4}}, samples));
  EXPECT_EQ(samples[0].pdf, 0);
}

}  // namespace
}  // namespace etendue
