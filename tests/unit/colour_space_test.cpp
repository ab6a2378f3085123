#include "etendue/colour_space.h"
#include "etendue/srgb.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

void expect_near(const Vec3d& found, const Vec3d& expected, double tolerance) {
  EXPECT_NEAR(found.x, expected.x, tolerance);
  EXPECT_NEAR(found.y, expected.y, tolerance);
  EXPECT_NEAR(found.z, expected.z, tolerance);
}
void expect_rows(const Matrix3& m, const Vec3d& r, const Vec3d& g, const Vec3d& b, double tolerance) {
  const Matrix3 rows = transposed(m);
  expect_near(rows.a, r, tolerance);
  expect_near(rows.b, g, tolerance);
  expect_near(rows.c, b, tolerance);
}

// Matrices as others print them: ITU-R BT.2087 (4 digits), ACES' S-2014-004 (10 digits), and AP1 by Bradford as the ACES configurations
// have it (6 digits).
TEST(ColourSpace, MatchesPublishedMatrices) {
  expect_rows(*conversion(rec2020, rec709, ChromaticAdaptation::none), {1.6605, -0.5876, -0.0728}, {-0.1246, 1.1329, -0.0083},
              {-0.0182, -0.1006, 1.1187}, 5.1e-5);
  expect_rows(rgb_to_xyz(acescg), {0.6624541811, 0.1340042065, 0.1561876870}, {0.2722287168, 0.6740817658, 0.0536895174},
              {-0.0055746495, 0.0040607335, 1.0103391003}, 5.1e-11);
  expect_rows(*conversion(rec709, acescg, ChromaticAdaptation::bradford), {0.613097, 0.339523, 0.047379}, {0.070194, 0.916354, 0.013452},
              {0.020616, 0.109570, 0.869815}, 1.5e-6);
  // IEC 61966-2-1 has the luminances of sRGB's primaries to 4 digits.
  expect_near(transposed(rgb_to_xyz(rec709)).b, {0.2126, 0.7152, 0.0722}, 5.1e-5);
}

TEST(ColourSpace, WhiteIsWhiteAndBackIsBack) {
  for (const ColourSpace& from : colour_spaces()) {
    EXPECT_EQ(colour_space(from.name)->name, from.name);
    expect_near(to_space(from.white, from, {})->rgb, {1, 1, 1}, 1e-14);
    for (const ColourSpace& to : colour_spaces())
      for (const ChromaticAdaptation by : {ChromaticAdaptation::none, ChromaticAdaptation::xyz_scaling, ChromaticAdaptation::von_kries,
                                           ChromaticAdaptation::bradford, ChromaticAdaptation::cat02, ChromaticAdaptation::cat16}) {
        const Matrix3 there = *conversion(from, to, by), back = *conversion(to, from, by);
        expect_near(back * (there * Vec3d{0.3, -0.1, 0.9}), {0.3, -0.1, 0.9}, 1e-13);
        if (by != ChromaticAdaptation::none) expect_near(there * Vec3d{1, 1, 1}, {1, 1, 1}, 1e-14);
        EXPECT_EQ(*adaptation_of(name_of(by)), by);
      }
  }
}

// ACES' white, not adapted, in linear sRGB (computed independently); it is no D60.
TEST(ColourSpace, UnadaptedWhiteKeepsItsTint) {
  expect_near(*conversion(acescg, rec709, ChromaticAdaptation::none) * Vec3d{1, 1, 1}, {1.0471, 0.9945, 0.9153}, 5.1e-5);
}

// D65 as CIE prints it, as the daylight locus gives it, and for an eye that is adapted to whatever light there is.
TEST(ColourSpace, WhitePolicies) {
  expect_near(to_space({0.31272, 0.32903}, rec709, {})->rgb, {1, 1, 1}, 1e-3);
  expect_near(to_space(*daylight(6503.6), rec709, {})->rgb, {1, 1, 1}, 1e-3);
  const Chromaticity lamp = *planckian(2700);
  EXPECT_GT(to_space(lamp, rec709, {})->rgb.x, 1.5);
  for (const ChromaticAdaptation by :
       {ChromaticAdaptation::von_kries, ChromaticAdaptation::bradford, ChromaticAdaptation::cat02, ChromaticAdaptation::cat16})
    for (const ColourSpace& space : colour_spaces()) expect_near(to_space(lamp, space, {by, lamp})->rgb, {1, 1, 1}, 1e-13);
  // Without a policy it is what to_rgb gives, but for the luminance's weights, which that rounds to 4 digits.
  const Rgb same = to_rgb(lamp);
  expect_near(to_space(lamp, rec709, {})->rgb, same, 2e-4);
}

// A candle is redder than Rec.709's red at full saturation, and within Rec.2020; nothing is clipped.
TEST(ColourSpace, OutOfGamutIsSaid) {
  const Chromaticity candle = *planckian(1500);
  const InSpace narrow = *to_space(candle, rec709, {}), wide = *to_space(candle, rec2020, {});
  EXPECT_FALSE(narrow.in_gamut);
  EXPECT_LT(narrow.rgb.z, 0);
  EXPECT_TRUE(wide.in_gamut);
  // The locus leaves Rec.709 at 1901 K.
  EXPECT_TRUE(to_space(*planckian(1903), rec709, {})->in_gamut);
  EXPECT_FALSE(to_space(*planckian(1899), rec709, {})->in_gamut);
  // Its green, too, is negative below 964 K.
  EXPECT_GT(to_space(*planckian(966), rec709, {})->rgb.y, 0);
  EXPECT_LT(to_space(*planckian(962), rec709, {})->rgb.y, 0);
  EXPECT_TRUE(to_space({0.64, 0.33}, rec709, {})->in_gamut);  // the primary itself, but for rounding
}

TEST(ColourSpace, BadInput) {
  EXPECT_EQ(colour_space("rec7009").error().code, "COLOUR_SPACE_UNKNOWN");
  EXPECT_NE(colour_space("rec7009").error().hint.find("rec709"), std::string::npos);
  EXPECT_EQ(adaptation_of("bradfort").error().code, "ADAPTATION_UNKNOWN");
  for (const Chromaticity& bad : {Chromaticity{0.3, 0}, {0, 0}, {0.3, -0.1}, {std::nan(""), 0.3}, {0.3, HUGE_VAL}}) {
    EXPECT_EQ(to_space(bad, rec709, {}).error().code, "CHROMATICITY_INVALID");
    EXPECT_EQ(to_space({0.3, 0.3}, rec709, {ChromaticAdaptation::cat02, bad}).error().code, "WHITE_POINT_INVALID");
  }
  // A white so purple that a response is negative.
  EXPECT_EQ(adaptation_matrix({0.7, 0.2}, {0.3, 0.3}, ChromaticAdaptation::bradford).error().code, "WHITE_POINT_INVALID");
}

// Errata E19 of Frostbite 3.0: listing 30 offers powers of 2.2 instead; they are off by .0085 and .0335 and give NaN below 0.
TEST(Srgb, E19PowersAreNoSrgb) {
  double decoding = 0, encoding = 0, back = 0;
  for (int i = 0; i <= 100000; ++i) {
    const double x = i / 100000.0;
    decoding = std::max(decoding, std::abs(std::pow(x, 2.2) - srgb_to_linear(x)));
    encoding = std::max(encoding, std::abs(std::pow(x, 1 / 2.2) - linear_to_srgb(x)));
    back = std::max(back, std::abs(linear_to_srgb(srgb_to_linear(x)) - x));
  }
  EXPECT_NEAR(decoding, 0.0085, 5e-5);
  EXPECT_NEAR(encoding, 0.0335, 5e-5);
  EXPECT_NEAR(std::pow(0.00216, 1 / 2.2) - linear_to_srgb(0.00216), encoding, 1e-5);
  // The standard's rounded constants leave a step where the pieces meet.
  EXPECT_LE(back, 5e-7);
  EXPECT_TRUE(std::isnan(std::pow(-0.1, 2.2)));
  EXPECT_EQ(srgb_to_linear(-0.1), -0.1 / 12.92);
  EXPECT_EQ(linear_to_srgb(-0.1), -0.1 * 12.92);
  EXPECT_EQ(srgb_to_linear(1), 1);
  EXPECT_NEAR(linear_to_srgb(1), 1, 1e-15);
}

}  // namespace
}  // namespace etendue
