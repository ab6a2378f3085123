#include "etendue/intensity_web.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "photometry/gauss.h"
#include "photometry_builder.h"

namespace etendue {
namespace {

using test::distribution_of;
using test::steps;
using test::web_of;

constexpr Interpolation all_interpolations[] = {Interpolation::linear, Interpolation::cosine, Interpolation::cubic};
constexpr double degree = pi / 180;

// Integral over the sphere of what the web says in its own angles: Gauss between all angles at which it has a kink.
double quadrature(const IntensityWeb& web, const std::set<double>& vertical, const std::set<double>& horizontal) {
  const auto integrate = [](const std::set<double>& splits, const auto& f) {
    double sum = 0;
    for (auto a = splits.begin(), b = std::next(a); b != splits.end(); ++a, ++b)
      for (const auto& node : photometry::gauss_16)
        sum += node.weight * 0.5 * (*b - *a) * degree * f(0.5 * (*a + *b) + 0.5 * (*b - *a) * node.x);
    return sum;
  };
  return integrate(horizontal, [&](double h) {
    return integrate(vertical, [&](double v) {
      const double latitude_cosine =
          web.type() == WebType::c ? std::sin(v * degree) : std::cos((web.type() == WebType::b ? h : v) * degree);
      return latitude_cosine * web.at_own_angles({v, h});
    });
  });
}

std::set<double> with_mirrored(const std::vector<double>& angles) {
  std::set<double> all(angles.begin(), angles.end());
  for (const double angle : angles) all.insert(-angle);
  return all;
}

// Uneven, not monotone, and different in all planes.
double bumpy(const Vec3d& u) { return 160 + 60 * u.x + 35 * std::sin(5 * u.y) - 30 * u.z + 20 * std::cos(9 * u.x * u.z); }

TEST(IntensityWeb, FluxIsTheIntegralOfItsInterpolant) {
  const std::vector<double> gamma{0, 3, 10, 11, 40, 77.5, 90, 120, 180}, c{0, 20, 35, 90};
  for (const Interpolation interpolation : all_interpolations) {
    const auto expect_own_flux = [&](const IntensityDistribution& d, const std::set<double>& v, const std::set<double>& h) {
      const IntensityWeb web = web_of(d, interpolation);
      ASSERT_GT(web.flux_lm(), 0);
      EXPECT_NEAR(quadrature(web, v, h) / web.flux_lm(), 1, 1e-12) << name_of(d.grid.type) << " " << name_of(d.grid.symmetry);
    };
    const std::set<double> v(gamma.begin(), gamma.end());
    const std::set<double> quadrants{0, 20, 35, 90, 145, 160, 180, 200, 215, 270, 325, 340, 360};
    expect_own_flux(distribution_of(WebType::c, WebSymmetry::quadrant, gamma, c, bumpy), v, quadrants);
    expect_own_flux(distribution_of(WebType::c, WebSymmetry::about_0_180, gamma, {0, 20, 100, 180}, bumpy), v,
                    {0, 20, 100, 180, 260, 340, 360});
    expect_own_flux(distribution_of(WebType::c, WebSymmetry::about_90_270, gamma, {-90, -80, 30, 90}, bumpy), v,
                    {0, 30, 90, 150, 260, 270, 280, 360});
    expect_own_flux(distribution_of(WebType::c, WebSymmetry::none, gamma, {0, 110, 200, 310}, bumpy), v, {0, 110, 200, 310, 360});
    expect_own_flux(distribution_of(WebType::c, WebSymmetry::rotational, gamma, {0}, bumpy), v, {0, 360});
    const std::vector<double> half{0, 7, 30, 90}, whole{-90, -22, 0, 5, 90};
    for (const WebType type : {WebType::a, WebType::b}) {
      expect_own_flux(distribution_of(type, WebSymmetry::none, whole, whole, bumpy), {whole.begin(), whole.end()},
                      {whole.begin(), whole.end()});
      expect_own_flux(distribution_of(type, WebSymmetry::lateral, whole, half, bumpy), {whole.begin(), whole.end()}, with_mirrored(half));
      expect_own_flux(distribution_of(type, WebSymmetry::lateral_and_vertical, half, half, bumpy), with_mirrored(half),
                      with_mirrored(half));
    }
  }
}

TEST(IntensityWeb, IsotropicLightHasItsExactFluxAtAnyStep) {
  for (const Interpolation interpolation : all_interpolations) {
    for (const double step : {1.0, 5.0, 30.0, 90.0, 180.0}) {
      const auto d = distribution_of(WebType::c, WebSymmetry::rotational, steps(0, 180, step), {0}, [](const Vec3d&) { return 7; });
      EXPECT_NEAR(web_of(d, interpolation).flux_lm() / (28 * pi), 1, 1e-14) << step;
    }
    const auto b = distribution_of(WebType::b, WebSymmetry::none, steps(-90, 90, 15), steps(-90, 90, 10), [](const Vec3d&) { return 7; });
    EXPECT_NEAR(web_of(b, interpolation).flux_lm() / (14 * pi), 1, 1e-14);
  }
}

// The error of the chord of cos(gamma) is of second order: -6.4e-4 at 5 degrees, four times that at 10.
TEST(IntensityWeb, LambertianIsExactInTheCosineAndConvergesInTheAngle) {
  const auto error = [](double step, Interpolation interpolation) {
    const auto d =
        distribution_of(WebType::c, WebSymmetry::rotational, steps(0, 90, step), {0}, [](const Vec3d& u) { return std::max(0.0, -u.z); });
    return web_of(d, interpolation).flux_lm() / pi - 1;
  };
  EXPECT_NEAR(error(5, Interpolation::cosine), 0, 1e-14);
  EXPECT_NEAR(error(45, Interpolation::cosine), 0, 1e-14);
  EXPECT_NEAR(error(5, Interpolation::linear), -6.4e-4, 0.1e-4);
  EXPECT_NEAR(error(10, Interpolation::linear) / error(5, Interpolation::linear), 4, 0.01);
  EXPECT_NEAR(error(5, Interpolation::linear) / error(2.5, Interpolation::linear), 4, 0.01);
}

TEST(IntensityWeb, AllTypesConvergeToTheClosedFormOfOneFloodlight) {
  const auto error = [](WebType type, double step) {
    const auto d = type == WebType::c
                       ? distribution_of(type, WebSymmetry::none, steps(0, 90, step), steps(0, 360, step), test::floodlight)
                       : distribution_of(type, WebSymmetry::none, steps(-90, 90, step), steps(-90, 90, step), test::floodlight);
    return web_of(d).flux_lm() / test::floodlight_flux_lm - 1;
  };
  for (const WebType type : {WebType::a, WebType::b, WebType::c}) {
    EXPECT_NEAR(error(type, 1) / error(type, 0.5), 4, 0.2) << name_of(type);
    EXPECT_LT(std::abs(error(type, 0.25)), 1e-5) << name_of(type);
  }
}

TEST(IntensityWeb, ZonesAddUpAndAreThoseOfTheConeForEveryType) {
  for (const Interpolation interpolation : all_interpolations) {
    const auto c = distribution_of(WebType::c, WebSymmetry::none, {0, 4, 31, 90, 170, 180}, {0, 50, 200}, bumpy);
    const IntensityWeb web = web_of(c, interpolation);
    EXPECT_NEAR(web.flux_between(0, 17) + web.flux_between(17, 63.5) + web.flux_between(63.5, 180), web.flux_lm(), 1e-12 * web.flux_lm());
  }
  // Inside a cone about the beam the same light has the same flux in all types of web, up to their steps.
  const auto flux = [](WebType type, double from, double to) {
    const auto d = type == WebType::c ? distribution_of(type, WebSymmetry::none, steps(0, 90, 1), steps(0, 360, 1), test::floodlight)
                                      : distribution_of(type, WebSymmetry::none, steps(-90, 90, 1), steps(-90, 90, 1), test::floodlight);
    return web_of(d).flux_between(from, to);
  };
  for (const auto& [from, to] : {std::pair{0.0, 10.0}, {0.0, 30.0}, {30.0, 60.0}, {60.0, 90.0}}) {
    EXPECT_NEAR(flux(WebType::a, from, to) / flux(WebType::c, from, to), 1, 1e-3);
    EXPECT_NEAR(flux(WebType::b, from, to) / flux(WebType::c, from, to), 1, 1e-3);
    EXPECT_NEAR(flux(WebType::b, 90, 180), 0, 1e-9);
  }
}

// A constant web of type B over the whole sphere: a cone holds 2 pi (1 - cos G), behind the beam's plane too.
TEST(IntensityWeb, ConesOfTypeBHoldTheirSolidAngle) {
  for (const WebType type : {WebType::a, WebType::b}) {
    const auto d = type == WebType::b
                       ? distribution_of(type, WebSymmetry::none, steps(-180, 180, 30), steps(-90, 90, 15), [](const Vec3d&) { return 1; })
                       : distribution_of(type, WebSymmetry::none, steps(-90, 90, 15), steps(-180, 180, 30), [](const Vec3d&) { return 1; });
    for (const double cone : {0.5, 20.0, 89.0, 90.0, 91.0, 140.0, 179.0})
      EXPECT_NEAR(web_of(d).flux_between(0, cone), 2 * pi * (1 - std::cos(cone * degree)), 1e-8 * 4 * pi) << cone;
  }
}

TEST(IntensityWeb, NeverOvershootsAndEndsInTheDark) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> value(0, 1);
  for (const Interpolation interpolation : all_interpolations) {
    IntensityDistribution d = distribution_of(WebType::c, WebSymmetry::none, {10, 20, 27, 60, 61, 140}, {0, 90, 120, 250}, bumpy);
    for (double& x : d.grid.values) x = value(random) < 0.3 ? 0 : value(random);
    const IntensityWeb web = web_of(d, interpolation);
    for (int i = 0; i < 20000; ++i) {
      const double c = 720 * value(random) - 360, gamma = 10 + 130 * value(random);
      const double found = web.at(c, gamma);
      ASSERT_GE(found, 0);
      ASSERT_LE(found, web.max_cd());
      ASSERT_NEAR(found, web.at(c + 360, gamma), 1e-12);
    }
    EXPECT_EQ(web.at(33, 9.999), 0);
    EXPECT_EQ(web.at(33, 140.001), 0);
    EXPECT_DOUBLE_EQ(web.at(90, 27), d.grid.values[6 + 2]);
    EXPECT_DOUBLE_EQ(web.at(0, 140), d.grid.values[5]);
  }
}

TEST(Frames, DirectionsComeBackThroughEveryKindOfAngles) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<Vec3d> directions{{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
  for (const double tiny : {1e-9, 1e-12, 1e-16, 1e-200}) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d u{tiny, -tiny, 2 * tiny};
      u[axis] = axis == 1 ? -1 : 1;
      directions.push_back(normalised(u));
    }
  }
  for (int i = 0; i < 1000; ++i) directions.push_back(normalised(Vec3d{normal(random), normal(random), normal(random)}));
  for (const WebFrame& frame : {WebFrame{}, WebFrame{true, 0}, WebFrame{false, 90}, WebFrame{true, -17}}) {
    for (const WebType type : {WebType::a, WebType::b, WebType::c}) {
      for (const Vec3d& u : directions) EXPECT_LE(length(direction_of(type, angles_of(type, u, frame), frame) - u), 1e-14) << name_of(type);
    }
  }
}

// tan V = cos C tan gamma, sin H = sin C sin gamma of type B; with the roles of V and H swapped for type A.
TEST(Frames, AnglesOfTypesAAndBFollowFromThoseOfTypeC) {
  for (const double c : {0.0, 20.0, 90.0, 200.0, 333.0}) {
    for (const double gamma : {1.0, 30.0, 60.0, 88.0}) {
      const Vec3d u = direction_of(WebType::c, {gamma, c});
      const WebAngles b = angles_of(WebType::b, u), a = angles_of(WebType::a, u);
      EXPECT_NEAR(std::tan(b.vertical_deg * degree), std::cos(c * degree) * std::tan(gamma * degree), 1e-12);
      EXPECT_NEAR(std::sin(b.horizontal_deg * degree), std::sin(c * degree) * std::sin(gamma * degree), 1e-14);
      EXPECT_NEAR(std::sin(a.vertical_deg * degree), std::cos(c * degree) * std::sin(gamma * degree), 1e-14);
      EXPECT_NEAR(std::tan(a.horizontal_deg * degree), std::sin(c * degree) * std::tan(gamma * degree), 1e-12);
    }
  }
}

TEST(Frames, OrientationAndHandednessMoveTheWeb) {
  const auto d = distribution_of(WebType::c, WebSymmetry::none, steps(0, 180, 10), steps(0, 360, 10), bumpy);
  const IntensityWeb plain = web_of(d), cie = web_of(d, Interpolation::linear, {false, turn_between(Orientation::ies, Orientation::cie)});
  const IntensityWeb mirrored = web_of(d, Interpolation::linear, {true, 0});
  EXPECT_NEAR(cie.at(123, 40), plain.at(33, 40), 1e-12);
  EXPECT_NEAR(mirrored.at(33, 40), plain.at(327, 40), 1e-12);
  EXPECT_NEAR(cie.towards(direction_of(WebType::c, {40, 123})), plain.at(33, 40), 1e-10);
  EXPECT_EQ(cie.flux_lm(), plain.flux_lm());
}

TEST(IntensityDistribution, InvalidGridsAreRefused) {
  const auto good = distribution_of(WebType::c, WebSymmetry::quadrant, {0, 90}, {0, 90}, bumpy);
  ASSERT_TRUE(check(good));
  const auto refused = [&](auto&& change) {
    IntensityDistribution d = good;
    change(d);
    return !check(d).ok() && !IntensityWeb::of(d).ok();
  };
  EXPECT_TRUE(refused([](auto& d) { d.grid.values.pop_back(); }));
  EXPECT_TRUE(refused([](auto& d) { d.grid.values[0] = -1; }));
  EXPECT_TRUE(refused([](auto& d) { d.grid.values[0] = std::nan(""); }));
  EXPECT_TRUE(refused([](auto& d) { d.grid.vertical_deg = {90, 0}; }));
  EXPECT_TRUE(refused([](auto& d) { d.grid.vertical_deg = {0, 181}; }));
  EXPECT_TRUE(refused([](auto& d) { d.grid.symmetry = WebSymmetry::lateral; }));
  EXPECT_TRUE(refused([](auto& d) { d.grid.horizontal_deg = {0, 80}; }));
  EXPECT_TRUE(
      refused([](auto& d) { std::get<IesRecord>(d.record).multiplier = 1e308, std::get<IesRecord>(d.record).ballast_factor = 1e10; }));
}

}  // namespace
}  // namespace etendue
