// What data sheets say of a luminaire, against published figures.
#include "etendue/photometric_quantities.h"

#include <gtest/gtest.h>

#include <cmath>

#include "photometry_builder.h"

namespace etendue {
namespace {

using test::distribution_of;
using test::steps;
using test::web_of;

// One plane of values at these angles, with a EULUMDAT record whose conversion factor makes cd/klm of them.
IntensityDistribution eulumdat_of(double flux_lm, std::vector<double> gamma, std::vector<double> cd_klm) {
  EulumdatRecord record;
  record.lamp_sets = {{1, "", flux_lm, "", "", 0}};
  IntensityDistribution d;
  d.record = record;
  d.grid = {WebType::c, WebSymmetry::rotational, std::move(gamma), {0}, std::move(cd_klm)};
  return d;
}

Vec3d towards(double c_deg, double gamma_deg) { return direction_of(WebType::c, {gamma_deg, c_deg}); }

// Photometric report of ICDLR12WCTA-WH 6K (GON-2000, 2019-01-14): 890.169 lm at 12.030 W are 73.996 lm/W; 875.488 lm go down, 98.35 %, and
// 14.681 lm up, 1.65 %. The light is spread evenly over each hemisphere here, which changes none of these.
TEST(PhotometricQuantities, EfficacyAndSharesOfAReport) {
  const double down = 875.488 / (2 * pi), up = 14.681 / (2 * pi);
  IntensityDistribution d = distribution_of(WebType::c, WebSymmetry::rotational, {0, 90, 90 + 1e-9, 180}, {0},
                                            [&](const Vec3d& u) { return u.z <= 0 ? down : up; });
  std::get_if<IesRecord>(&d.record)->watts = 12.030;
  std::get_if<IesRecord>(&d.record)->lumens_per_lamp = 890.170;
  const LightOutput out = light_output(d, web_of(d));
  EXPECT_NEAR(out.flux_lm, 890.169, 1e-4);
  EXPECT_NEAR(out.efficacy_lm_w.value_or(0), 73.996, 5e-4);
  EXPECT_NEAR(100 * out.downward_share, 98.35, 5e-3);
  EXPECT_NEAR(100 * out.upward_lm / out.flux_lm, 1.65, 5e-3);
  EXPECT_NEAR(100 * out.lor.value_or(0), 100.00, 5e-3);
  EXPECT_DOUBLE_EQ(*out.dlor + *out.ulor, *out.lor);
}

TEST(PhotometricQuantities, WithoutStatedLampsOrWattsThereAreNoRatios) {
  const IntensityDistribution d = distribution_of(WebType::c, WebSymmetry::rotational, {0, 180}, {0}, [](const Vec3d&) { return 1.0; });
  const LightOutput out = light_output(d, web_of(d));
  EXPECT_FALSE(out.lor || out.dlor || out.ulor || out.efficacy_lm_w);
  EXPECT_NEAR(out.downward_share, 0.5, 1e-14);
}

// CIE 190:2010, worksheet of section 4.2: the cones end at .130 of the zone from 40 to 50 degrees and at .547 of that from 70 to 80.
TEST(PhotometricQuantities, CieConesCutTheZonesWhereCie190Does) {
  const IntensityWeb web =
      web_of(distribution_of(WebType::c, WebSymmetry::rotational, steps(0, 180, 10), {0}, [](const Vec3d&) { return 1.0; }));
  EXPECT_NEAR(web.flux_between(40, cie_cone_deg[0]) / web.flux_between(40, 50), .130, 5e-4);
  EXPECT_NEAR(web.flux_between(70, cie_cone_deg[2]) / web.flux_between(70, 80), .547, 5e-4);
  const std::array<double, 4> flux = cie_cone_flux_lm(web);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(flux[i], 2 * pi * static_cast<double>(i + 1) / 4, 1e-13);
}

// "How to calculate Beam Angle, Field Angle and Nema class" (ransenlightingandcolor.blogspot.com, 2016): 113 and 97.7 degrees are type 6
// x 5. Training manual NAVEDTRA 14027, chapter 6: floodlights of 22 x 21 degrees are type 2, of 77 x 77 degrees type 5.
TEST(PhotometricQuantities, NemaTypesOfPublishedFloodlights) {
  EXPECT_EQ(nema_type(113), 6);
  EXPECT_EQ(nema_type(97.7), 5);
  EXPECT_EQ(nema_type(22), 2);
  EXPECT_EQ(nema_type(21), 2);
  EXPECT_EQ(nema_type(77), 5);
  EXPECT_EQ(nema_type(10), 1);
  EXPECT_EQ(nema_type(18), 1);
  EXPECT_EQ(nema_type(130.1), 7);
  EXPECT_FALSE(nema_type(9.9));
}

struct ReluxRow {
  double c_deg, gamma_deg, cd_klm, luminance;
};

void expect_luminance(const IntensityDistribution& d, const ReluxRow& row) {
  const IntensityWeb web = web_of(d);
  const std::optional<double> luminance = opening_luminance(d, web, towards(row.c_deg, row.gamma_deg));
  ASSERT_TRUE(luminance);
  // Relux prints whole cd/m2, and its own angles and areas in single precision.
  EXPECT_NEAR(*luminance, row.luminance, 0.5 + 5e-4 * row.luminance) << row.c_deg << " " << row.gamma_deg;
}

// Luminance tables of Relux Desktop (report of 2026-03-23, in 123VincentB/eulumdat-luminance, data/reference/relux_reference.json).
TEST(PhotometricQuantities, LuminanceIsReluxs) {
  // sample_01: round, 530 mm, 59 mm high, 4828 lm.
  for (const ReluxRow& row : {ReluxRow{0, 65, 56.8375, 2257}, ReluxRow{40, 70, 47.854583, 2204}, ReluxRow{90, 75, 41.434583, 2291},
                              ReluxRow{200, 80, 35.290833, 2466}, ReluxRow{300, 85, 27.729167, 2657}}) {
    IntensityDistribution d = eulumdat_of(4828, {0, 180}, {row.cd_klm, row.cd_klm});
    auto& record = *std::get_if<EulumdatRecord>(&d.record);
    record.opening_length_mm = 530;
    record.opening_height_mm.fill(59);
    expect_luminance(d, row);
  }
  // sample_06: 1208 mm x 105 mm, 51 mm high towards C0 and C180 alone, 1983 lm of the first lamp set.
  for (const ReluxRow& row : {ReluxRow{0, 65, 92.55, 1677}, ReluxRow{180, 85, 32.04, 877}, ReluxRow{45, 65, 88.74, 1890},
                              ReluxRow{60, 75, 49.13, 1557}, ReluxRow{90, 65, 82.23, 3042}, ReluxRow{90, 85, 11.57, 2075}}) {
    IntensityDistribution d = eulumdat_of(1983, {0, 180}, {row.cd_klm, row.cd_klm});
    auto& record = *std::get_if<EulumdatRecord>(&d.record);
    record.opening_length_mm = 1208;
    record.opening_width_mm = 105;
    record.opening_height_mm = {51, 0, 51, 0};
    expect_luminance(d, row);
  }
  // sample_04: 1480 mm x 63 mm, flat, 12334 lm.
  for (const ReluxRow& row : {ReluxRow{0, 65, 17.9, 5603}, ReluxRow{45, 80, 3.405, 2594}, ReluxRow{90, 85, 2.535, 3848}}) {
    IntensityDistribution d = eulumdat_of(12334, {0, 180}, {row.cd_klm, row.cd_klm});
    auto& record = *std::get_if<EulumdatRecord>(&d.record);
    record.opening_length_mm = 1480;
    record.opening_width_mm = 63;
    expect_luminance(d, row);
  }
}

// Cauchy: the mean over all directions of a convex body's projected area is a quarter of its surface.
TEST(PhotometricQuantities, ProjectedAreasAverageToAQuarterOfTheSurface) {
  struct Case {
    double width, length, height, surface;
  };
  const double thin_box = 2 * (2 * 3 + 2 * 1 + 3 * 1), cylinder = 2 * pi * 1 + 2 * pi * 1 * 5, ball = 4 * pi * 1.5 * 1.5;
  for (const Case& c : {Case{2, 3, 0, 2 * 2 * 3}, Case{2, 3, 1, thin_box}, Case{-2, -2, 0, 2 * pi}, Case{-2, -2, 5, cylinder},
                        Case{-2, 5, -2, cylinder}, Case{5, -2, -2, cylinder}, Case{-3, -3, -3, ball}, Case{-2, 0, -2, 2 * pi}}) {
    IntensityDistribution d = distribution_of(WebType::c, WebSymmetry::rotational, {0, 180}, {0}, [](const Vec3d&) { return 1.0; });
    auto& record = *std::get_if<IesRecord>(&d.record);
    record.version = IesVersion::lm_63_2002;
    record.width = c.width, record.length = c.length, record.height = c.height;
    const IntensityWeb web = web_of(d);
    double sum = 0;
    constexpr int latitudes = 400, longitudes = 400;
    for (int i = 0; i < latitudes; ++i) {
      const double z = -1 + (2 * i + 1.0) / latitudes, r = std::sqrt(1 - z * z);
      for (int j = 0; j < longitudes; ++j) {
        const double phi = 2 * pi * (j + 0.5) / longitudes;
        sum += *projected_opening_m2(d, web, {r * std::cos(phi), r * std::sin(phi), z});
      }
    }
    // The midpoint rule errs with the square of a step of 1/200, times a bend of order one, at the edges with the step to 3/2.
    EXPECT_NEAR(sum / (latitudes * longitudes), c.surface / 4, 5e-4 * c.surface) << c.width << " " << c.length << " " << c.height;
  }
}

TEST(PhotometricQuantities, FlatOpeningsAreNotSeenFromTheEdgeAndPointsNever) {
  IntensityDistribution d = distribution_of(WebType::c, WebSymmetry::rotational, {0, 180}, {0}, [](const Vec3d&) { return 100.0; });
  EXPECT_FALSE(projected_opening_m2(d, web_of(d), towards(0, 0)));
  auto& record = *std::get_if<IesRecord>(&d.record);
  record.width = 0.5, record.length = 1;
  const IntensityWeb web = web_of(d);
  EXPECT_FALSE(opening_luminance(d, web, towards(30, 90)));
  EXPECT_NEAR(opening_luminance(d, web, towards(30, 60)).value_or(0), 100 / (0.5 * 0.5), 1e-9);
  EXPECT_FALSE(opening_luminance(d, web, {0, 0, 0}));
}

// The opening turns with the web: what faces C90 in the file faces C180 in the other orientation.
TEST(PhotometricQuantities, TheOpeningTurnsWithTheWeb) {
  IntensityDistribution d = distribution_of(WebType::c, WebSymmetry::rotational, {0, 180}, {0}, [](const Vec3d&) { return 1.0; });
  auto& record = *std::get_if<IesRecord>(&d.record);
  record.width = 0.5, record.length = 2, record.height = 0.1;
  const IntensityWeb own = web_of(d), turned = web_of(d, Interpolation::linear, {false, 90});
  EXPECT_NEAR(*projected_opening_m2(d, own, towards(90, 90)), 2 * 0.1, 1e-12);
  EXPECT_NEAR(*projected_opening_m2(d, turned, towards(180, 90)), 2 * 0.1, 1e-12);
}

// By the middles of 2000 rings and 360 sectors about the nadir, of the intensity times the share: they miss the bends of a table by about
// their width squared.
double flux_by_rings(const IntensityWeb& web, double inner_deg, double outer_deg) {
  constexpr int rings = 2000, sectors = 360;
  const double inner = std::cos(inner_deg * pi / 180), outer = std::cos(outer_deg * pi / 180), step = outer_deg * pi / 180 / rings;
  double sum = 0;
  for (int i = 0; i < rings; ++i) {
    const double gamma = (i + 0.5) * step, cosine = std::cos(gamma), x = cosine >= inner ? 1 : (cosine - outer) / (inner - outer);
    for (int j = 0; j < sectors; ++j) {
      const double phi = 2 * pi * (j + 0.5) / sectors;
      sum += x * x * web.towards({std::sin(gamma) * std::cos(phi), std::sin(gamma) * std::sin(phi), -cosine}) * std::sin(gamma);
    }
  }
  return sum * step * 2 * pi / sectors;
}

TEST(PhotometricQuantities, WhatPassesAConeIsTheIntegralOfTheProduct) {
  const auto form = [](const Vec3d& u) { return std::max(0.0, 100 + 40 * u.x - 70 * u.z + 30 * u.y * u.x); };
  const std::vector<double> whole = steps(-90, 90, 5), half = steps(0, 90, 5);
  for (const auto& d : {distribution_of(WebType::c, WebSymmetry::none, steps(0, 180, 7.5), steps(0, 345, 15), form),
                        distribution_of(WebType::c, WebSymmetry::quadrant, steps(0, 90, 2.5), half, form),
                        distribution_of(WebType::b, WebSymmetry::none, whole, whole, form),
                        distribution_of(WebType::a, WebSymmetry::lateral, whole, half, form)}) {
    const IntensityWeb web = web_of(d);
    for (const auto& [inner, outer] : {std::pair(20.0, 50.0), std::pair(0.0, 12.0), std::pair(40.0, 41.0), std::pair(60.0, 90.0)})
      EXPECT_NEAR(flux_through_cone(web, inner, outer), flux_by_rings(web, inner, outer), 3e-6 * web.flux_lm())
          << name_of(d.grid.type) << " " << inner << " " << outer;
    EXPECT_EQ(flux_through_cone(web, 33, 33), web.flux_between(0, 33));
  }
}

}  // namespace
}  // namespace etendue
