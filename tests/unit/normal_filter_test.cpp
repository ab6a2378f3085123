#include "etendue/normal_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace etendue {
namespace {

constexpr double pi = std::numbers::pi;

TEST(NormalConcentration, IsTheInverseOfTheMeansLength) {
  for (const double r : {1e-6, 1e-3, 0.02, 0.1, 0.5, 0.9, 0.99, 0.9999})
    EXPECT_NEAR(mean_normal_length(normal_concentration(r)), r, 1e-14) << r;
  // The mean of cos over density exp(kappa cos), by the midpoint rule: (h^2 / 24) relative error with h = 2 / n, kappa 10 and its square.
  for (const double kappa : {0.01, 0.3, 2.0, 10.0}) {
    constexpr int n = 20000;
    double sum = 0, moment = 0;
    for (int i = 0; i < n; ++i) {
      const double c = -1 + (i + 0.5) * 2 / n, density = std::exp(kappa * (c - 1));
      sum += density, moment += density * c;
    }
    EXPECT_NEAR(mean_normal_length(kappa), moment / sum, 1e-6);
  }
  EXPECT_EQ(normal_concentration(1), std::numeric_limits<double>::infinity());
  EXPECT_EQ(normal_concentration(0), 0);
  EXPECT_EQ(mean_normal_length(std::numeric_limits<double>::infinity()), 1);
}

double ggx(double cosine, double alpha) {
  return cosine > 0 ? alpha * alpha / pi / std::pow(cosine * cosine * (alpha * alpha - 1) + 1, 2) : 0;
}

// The average lobe over tangent = scale sqrt(u / (1 - u)), as a share of du: an integral over normals about the mean one by their own
// distribution, or about h by the lobe, whichever is the narrower.
std::vector<double> average_lobe(double alpha, double kappa, double scale, int places) {
  constexpr int rings = 160, turns = 96;
  std::vector<double> shares(static_cast<std::size_t>(places));
  for (int p = 0; p < places; ++p) {
    const double at = (p + 0.5) / places, tangent = scale * std::sqrt(at / (1 - at)), cosine = 1 / std::hypot(1, tangent);
    double sum = 0;
    for (int i = 0; i < rings; ++i) {
      // u = 1 - (1 - x)^2, in which 1 / c has no pole.
      const double rest = 1 - (i + 0.5) / rings, u = 1 - rest * rest;
      const bool by_lobe = alpha * alpha < 2 / kappa;
      const double t = alpha * std::sqrt(u / (1 - u));
      const double c = by_lobe ? 1 / std::hypot(1, t) : 1 + std::log(u + (1 - u) * std::exp(-2 * kappa)) / kappa;
      const double s = std::sqrt(std::max(0.0, 1 - c * c));
      for (int j = 0; j < turns; ++j) {
        const double between = cosine * c + cosine * tangent * s * std::cos(pi * (j + 0.5) / turns);
        sum += by_lobe ? kappa / (-2 * pi * std::expm1(-2 * kappa)) * std::exp(kappa * (between - 1)) / c * 2 * rest
                       : ggx(between, alpha) * 2 * rest;
      }
    }
    shares[static_cast<std::size_t>(p)] = sum / (rings * turns) / ggx(cosine, scale);
  }
  const double total = std::accumulate(shares.begin(), shares.end(), 0.0) / places;
  for (double& s : shares) s /= total;
  return shares;
}

double misplaced(const std::vector<double>& shares, double scale, double alpha) {
  double sum = 0;
  const auto places = static_cast<int>(shares.size());
  for (int p = 0; p < places; ++p) {
    const double at = (p + 0.5) / places, cosine = 1 / std::hypot(1, scale * std::sqrt(at / (1 - at)));
    sum += std::abs(shares[static_cast<std::size_t>(p)] - ggx(cosine, alpha) / ggx(cosine, scale));
  }
  return 0.5 * sum / places;
}

// At places that are no nodes of the table: the least of all alphas near it is hardly less.
TEST(FilteredLobe, IsTheNearestGgx) {
  for (const double alpha : {0.03, 0.11, 0.37, 0.8}) {
    for (const double r : {0.35, 0.8, 0.97, 0.995, 0.9995}) {
      const double kappa = normal_concentration(r);
      const double scale = std::sqrt((alpha * alpha + 2 / kappa) / (1 + 2 / kappa));
      const std::vector<double> shares = average_lobe(alpha, kappa, scale, 300);
      const FilteredLobe lobe = filtered_lobe(alpha, r);
      double least = 1;
      for (int i = -40; i <= 40; ++i) least = std::min(least, misplaced(shares, scale, lobe.alpha * std::exp(0.004 * i)));
      EXPECT_LT(misplaced(shares, scale, lobe.alpha), least + 1e-3) << alpha << " " << r;
      EXPECT_NEAR(lobe.misplaced, least, 3e-3) << alpha << " " << r;
    }
  }
}

TEST(FilteredLobe, LimitsAndOrder) {
  for (const NormalFilter filter : {NormalFilter::ggx, NormalFilter::slopes, NormalFilter::listing32}) {
    for (const double alpha : {0.0, 0.01, 0.3, 1.0}) {
      EXPECT_EQ(filtered_lobe(alpha, 1, filter).alpha, alpha);
      EXPECT_NEAR(filtered_lobe(alpha, 1 - 1e-12, filter).alpha, alpha, 2e-6);  // sqrt(2 / kappa) at alpha 0
      for (const double length : {0.0, 1e-9, 0.5, 0.9}) {
        const double a = filtered_lobe(alpha, length, filter).alpha;
        EXPECT_TRUE(a >= 0.9 * alpha && a <= 1) << alpha << " " << length;
      }
    }
    // The shorter the mean, the wider the lobe; the wider each lobe, the wider their average.
    double before = 0;
    for (int i = 0; i <= 200; ++i) {
      const double a = filtered_lobe(0.1, 1 - i / 200.0, filter).alpha;
      EXPECT_GE(a, before - 1e-12) << i;
      before = a;
    }
  }
  EXPECT_EQ(filtered_lobe(0.02, 0).alpha, 1);
}

// The facts of listing 32's slips: alpha .05 and kappa 200 give .112, the listing .071.
TEST(FilteredLobe, Listing32AsPrintedAndMended) {
  const double r = mean_normal_length(200);
  EXPECT_NEAR(filtered_lobe(0.05, r, NormalFilter::slopes).alpha, 0.1118, 5e-5);
  // Printed: kappa = (3 r - r^2) / (1 - r^2) is half as much again as meant near 1... at kappa 200 exactly:
  const double printed = (3 * r - r * r) / (1 - r * r);
  EXPECT_NEAR(filtered_lobe(0.05, r, NormalFilter::listing32).alpha, std::sqrt(0.0025 + 0.5 / printed), 1e-12);
  EXPECT_NEAR(filtered_lobe(0.05, r, NormalFilter::listing32).alpha, 0.071, 1e-3);
}

std::vector<Vec3f> ridges(std::uint32_t width, std::uint32_t height, float slope) {
  std::vector<Vec3f> normals;
  for (std::uint32_t i = 0; i < width * height; ++i) normals.push_back({(i % width) % 2 == 0 ? slope : -slope, 0, 1});
  return normals;
}

TEST(FilterNormals, KeepsMeansAndFindsRidges) {
  // Ridges of slope 1/2: the mean of two sides is (0, 0, 1 / sqrt(1.25)).
  const auto normals = ridges(8, 4, 0.5f);
  const float alpha = 0.1f;
  const auto levels = filter_normals({8, 4, normals, {&alpha, 1}});
  ASSERT_TRUE(levels);
  ASSERT_EQ(levels->size(), 4u);
  EXPECT_EQ((*levels)[1].width, 4u);
  EXPECT_EQ((*levels)[1].height, 2u);
  EXPECT_EQ((*levels)[3].width, 1u);
  EXPECT_EQ((*levels)[3].height, 1u);
  EXPECT_FLOAT_EQ((*levels)[0].alphas[5], 0.1f);
  const double length = 1 / std::sqrt(1.25);
  for (std::size_t l = 1; l < 4; ++l) {
    for (std::size_t i = 0; i < (*levels)[l].means.size(); ++i) {
      EXPECT_NEAR((*levels)[l].means[i].z, length, 1e-6);
      EXPECT_NEAR((*levels)[l].means[i].x, 0, 1e-6);
      EXPECT_NEAR((*levels)[l].alphas[i], filtered_lobe(0.1f, length).alpha, 1e-6);
      EXPECT_FLOAT_EQ((*levels)[l].authored_alphas[i], 0.1f);
    }
  }
}

// Sizes that are not halved evenly: every level has the mean of the field, which for normals (x, y, z) and alpha^2 is linear.
TEST(FilterNormals, OddSizesKeepTheMean) {
  constexpr std::uint32_t width = 13, height = 7;
  std::vector<Vec3f> normals;
  std::vector<float> alphas;
  for (std::uint32_t i = 0; i < width * height; ++i) {
    normals.push_back({std::sin(0.7f * static_cast<float>(i)), std::cos(1.3f * static_cast<float>(i * i % 17)), 1.5f});
    alphas.push_back(static_cast<float>(i) / (width * height));
  }
  const auto levels = filter_normals({width, height, normals, alphas});
  ASSERT_TRUE(levels);
  const auto mean_of = [](const NormalLevel& level) {
    Vec3d mean;
    double square = 0;
    const auto count = static_cast<double>(level.means.size());
    for (std::size_t i = 0; i < level.means.size(); ++i) {
      mean += Vec3d{level.means[i].x, level.means[i].y, level.means[i].z} / count;
      square += std::pow(level.authored_alphas[i], 2) / count;
    }
    return std::pair{mean, square};
  };
  const auto first = mean_of(levels->front());
  ASSERT_EQ(levels->size(), 4u);
  for (const NormalLevel& level : *levels) {
    const auto [mean, square] = mean_of(level);
    EXPECT_NEAR(length(mean - first.first), 0, 1e-6) << level.width;
    EXPECT_NEAR(square, first.second, 1e-6) << level.width;
  }
}

TEST(FilterNormals, RefusesWhatIsNoField) {
  const std::vector<Vec3f> normals{{0, 0, 1}, {0, 0, 0}};
  const std::vector<float> alphas{0.5f, 1.5f};
  const auto code = [](const auto& result) { return result ? std::string("none") : result.error().text; };
  EXPECT_EQ(code(filter_normals({2, 1, normals, alphas})), "expected a normal with a direction, found none at column 1, row 0");
  EXPECT_EQ(code(filter_normals({1, 1, {normals.data(), 1}, {alphas.data() + 1, 1}})),
            "expected an alpha from 0 to 1, found 1.500000 at column 0, row 0");
  EXPECT_EQ(code(filter_normals({3, 1, normals, alphas})), "expected 3 normals, at least one, found 2");
  EXPECT_EQ(code(filter_normals({0, 0, {}, alphas})), "expected 0 normals, at least one, found 0");
}

}  // namespace
}  // namespace etendue
