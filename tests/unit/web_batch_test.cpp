#include "etendue/web_batch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
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
  std::vector<double> all_around{-180, -100, -22, 0, 5, 90, 180};
  return {distribution_of(WebType::c, WebSymmetry::none, gamma, {0, 110, 200, 310}, bumpy),
          distribution_of(WebType::c, WebSymmetry::none, steps(0, 180, 0.5), steps(0, 355, 5), bumpy),
          distribution_of(WebType::c, WebSymmetry::rotational, gamma, {0}, bumpy),
          distribution_of(WebType::c, WebSymmetry::quadrant, gamma, {0, 20, 35, 90}, bumpy),
          distribution_of(WebType::c, WebSymmetry::about_0_180, steps(0, 90, 2.5), {0, 20, 100, 180}, bumpy),
          distribution_of(WebType::c, WebSymmetry::about_90_270, steps(0, 180, 2.5), {-90, -80, 30, 90}, bumpy),
          distribution_of(WebType::c, WebSymmetry::rotational, {0, 0.001, 0.003, 1, 2, 90}, {0}, bumpy),
          distribution_of(WebType::b, WebSymmetry::none, whole, whole, bumpy),
          distribution_of(WebType::b, WebSymmetry::none, all_around, whole, bumpy),
          distribution_of(WebType::b, WebSymmetry::lateral, whole, half, bumpy),
          distribution_of(WebType::a, WebSymmetry::vertical, half, whole, bumpy),
          distribution_of(WebType::a, WebSymmetry::lateral_and_vertical, half, half, bumpy)};
}

struct Directions {
  std::vector<float> x, y, z;
  explicit Directions(std::size_t count) {
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    for (std::size_t i = 0; i < count; ++i) {
      x.push_back(normal(random));
      y.push_back(normal(random));
      z.push_back(normal(random));
    }
    // The axes and places where planes meet, and lengths near the ends of the domain.
    const float special[][3] = {{0, 0, -1},           {0, 0, 1},      {1, 0, 0}, {-1, 0, 0},     {0, 1, 0}, {0, -1, 0},
                                {0, -0.0f, -1},       {-1, -0.0f, 0}, {1, 1, 0}, {1e-5f, 0, -1}, {1, 1, 1}, {1e-5f, 2e-6f, 0},
                                {3e14f, 2e14f, 1e13f}};
    std::size_t i = 0;
    for (const auto& s : special) {
      if (i == count) return;
      x[i] = s[0], y[i] = s[1], z[i++] = s[2];
    }
  }
  Vec3d at(std::size_t i) const { return {x[i], y[i], z[i]}; }
};

// The largest change of the table a degree of polar angle and of azimuth.
double steepest(const IntensityWeb& web) {
  const auto &p = web.polar().nodes(), &a = web.azimuth().nodes();
  double along = 0, across = 0;
  for (std::size_t j = 0; j < std::max<std::size_t>(a.size(), 1); ++j) {
    for (std::size_t i = 0; i < p.size(); ++i) {
      if (i > 0) along = std::max(along, std::abs(web.node(j, i) - web.node(j, i - 1)) / (p[i] - p[i - 1]));
      if (j > 0) across = std::max(across, std::abs(web.node(j, i) - web.node(j - 1, i)) / (a[j] - a[j - 1]));
    }
  }
  return along + across;
}

// A direction whose angles are within 1e-4 degrees of a border of a table may be on either side of it.
bool near_an_edge(const IntensityWeb& web, const Vec3d& u) {
  const WebAngles own = angles_of(web.type(), u, web.frame());
  const IntensityWeb::Folded f = web.folded(own);
  const auto near = [](double a, double b) { return std::abs(a - b) < 1e-4; };
  const auto &p = web.polar().nodes(), &a = web.azimuth().nodes();
  const bool at_polar = near(f.polar_deg, p.front()) || near(f.polar_deg, p.back());
  return at_polar || (web.type() != WebType::c && (near(f.azimuth_deg, a.front()) || near(f.azimuth_deg, a.back())));
}

TEST(WebBatch, IsTheDoubleFunctionWithinItsBound) {
  const Directions directions(4000);
  std::vector<float> cd(directions.x.size());
  for (const auto& d : distributions()) {
    for (const WebFrame& frame : {WebFrame{}, WebFrame{true, 33}}) {
      const IntensityWeb web = test::web_of(d, Interpolation::linear, frame);
      const WebBatch batch(web);
      const double bound = 2e-6 * web.max_cd() + 1e-4 * steepest(web);
      on_each_instruction_set([&] {
        const BatchOutcome done = batch.towards(directions.x, directions.y, directions.z, cd, -1);
        ASSERT_TRUE(done);
        EXPECT_EQ(*done, 0u);
        for (std::size_t i = 0; i < cd.size(); ++i) {
          const Vec3d u = directions.at(i);
          if (near_an_edge(web, u) && cd[i] == 0) continue;
          ASSERT_NEAR(cd[i], web.towards(u), bound)
              << name_of(d.grid.type) << " " << name_of(d.grid.symmetry) << " " << u.x << " " << u.y << " " << u.z;
        }
      });
    }
  }
}

TEST(WebBatch, FromAnglesItIsTheDoubleFunctionWithinItsBound) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> around(-720, 720), upwards(-20, 200);
  std::vector<float> c{0, 360, -360, 720, 90, 180, 0, 310, 355}, gamma{0, 0, 90, 180, 90, 77.5f, 180, 3, 90};
  while (c.size() < 2003) {
    c.push_back(around(random));
    gamma.push_back(upwards(random));
  }
  std::vector<float> cd(c.size());
  for (const auto& d : distributions()) {
    for (const WebFrame& frame : {WebFrame{}, WebFrame{true, 33}}) {
      const IntensityWeb web = test::web_of(d, Interpolation::linear, frame);
      const WebBatch batch(web);
      const double bound = 2e-6 * web.max_cd() + 1e-4 * steepest(web);
      on_each_instruction_set([&] {
        const BatchOutcome done = batch.at(c, gamma, cd, -1);
        ASSERT_TRUE(done);
        EXPECT_EQ(*done, 0u);
        for (std::size_t i = 0; i < cd.size(); ++i)
          ASSERT_NEAR(cd[i], web.at(c[i], gamma[i]), bound)
              << name_of(d.grid.type) << " " << name_of(d.grid.symmetry) << " " << c[i] << " " << gamma[i];
      });
    }
  }
  const IntensityWeb web = test::web_of(distributions()[0]);
  const WebBatch batch(web);
  const std::vector<float> zero(4), wrong{721, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 0};
  std::vector<float> found(4);
  on_each_instruction_set([&] {
    const BatchOutcome by_c = batch.at(wrong, zero, found, -7), by_gamma = batch.at(zero, wrong, found, -7);
    ASSERT_TRUE(by_c && by_gamma);
    EXPECT_EQ(*by_c + *by_gamma, 6u);
    EXPECT_EQ(found[0], -7);
  });
  EXPECT_EQ(batch.at(wrong, zero, std::span(found).first(3), 0).error().code, "BATCH_SIZES_DIFFER");
}

TEST(WebBatch, OtherInterpolationsAreTheDoubleFunction) {
  const Directions directions(100);
  std::vector<float> cd(directions.x.size());
  for (const Interpolation interpolation : {Interpolation::cosine, Interpolation::cubic}) {
    const IntensityWeb web = test::web_of(distributions()[1], interpolation);
    ASSERT_TRUE(WebBatch(web).towards(directions.x, directions.y, directions.z, cd, -1));
    for (std::size_t i = 0; i < cd.size(); ++i) EXPECT_EQ(cd[i], static_cast<float>(web.towards(directions.at(i))));
  }
}

TEST(WebBatch, EveryLengthGivesTheSame) {
  const Directions directions(131);
  const IntensityWeb web = test::web_of(distributions()[0]);
  const WebBatch batch(web);
  on_each_instruction_set([&] {
    std::vector<float> whole(131);
    ASSERT_TRUE(batch.towards(directions.x, directions.y, directions.z, whole, -1));
    for (std::size_t n = 0; n < 131; n += 7) {
      std::vector<float> cd(n);
      const auto part = [n](const std::vector<float>& v) { return std::span(v).first(n); };
      ASSERT_TRUE(batch.towards(part(directions.x), part(directions.y), part(directions.z), cd, -1));
      for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(cd[i], whole[i]);
    }
  });
}

TEST(WebBatch, WhatHasNoDirectionIsCounted) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
  const std::vector<float> x{0, 1, nan, 0, 0, infinite, 1e-30f}, y{0, 0, 0, nan, 0, 0, 0}, z{0, 0, 1, 1, nan, 0, 0};
  for (const Interpolation interpolation : {Interpolation::linear, Interpolation::cubic}) {
    const IntensityWeb web = test::web_of(distributions()[0], interpolation);
    on_each_instruction_set([&] {
      std::vector<float> cd(x.size());
      const BatchOutcome done = WebBatch(web).towards(x, y, z, cd, -7);
      ASSERT_TRUE(done);
      EXPECT_EQ(*done, 6u);
      for (std::size_t i = 0; i < cd.size(); ++i) EXPECT_EQ(cd[i] == -7, i != 1) << i;
    });
  }
}

TEST(WebBatch, SizesMustAgree) {
  const IntensityWeb web = test::web_of(distributions()[0]);
  const std::vector<float> three(3), two(2);
  std::vector<float> cd(3);
  const BatchOutcome done = WebBatch(web).towards(three, two, three, cd, 0);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, "BATCH_SIZES_DIFFER");
}

}  // namespace
}  // namespace etendue
