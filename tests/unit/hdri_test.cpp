#include "etendue/hdri.h"

#include "etendue/colour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace etendue {
namespace {

constexpr PanoramaSize size{256, 128};
std::vector<Vec3f> even(float x) { return std::vector<Vec3f>(size.width * size.height, Vec3f{x, x, x}); }

// Every texel within a cone becomes `radiance`, by its middle.
void paint_disc(std::vector<Vec3f>& texels, const Vec3d& towards, double radius_rad, const Vec3f& radiance) {
  for (std::size_t row = 0; row < size.height; ++row)
    for (std::size_t column = 0; column < size.width; ++column)
      if (dot(direction_of_texel(size, column, row), normalised(towards)) >= std::cos(radius_rad))
        texels[row * size.width + column] = radiance;
}

TEST(Panorama, SolidAnglesFillTheSphere) {
  double sum = 0;
  for (std::size_t row = 0; row < size.height; ++row) sum += size.width * solid_angle_of_texel(size, row);
  EXPECT_NEAR(sum, 4 * pi, 4 * pi * 1e-14);
  // A cap of one row around the pole, 2 pi (1 - cos), by its series: what cos loses at 1e-3 degrees.
  const PanoramaSize fine{1, 180000};
  const double a = pi / 180000, cap = 2 * pi * (a * a / 2 - a * a * a * a / 24);
  EXPECT_NEAR(solid_angle_of_texel(fine, 0) / cap, 1, 1e-14);
}

// Row 0 is +Y; u = 1/2 is +Z (atan2(0, 1) = 0), and u grows towards -X.
TEST(Panorama, DirectionsAreThoseOfEnvironments) {
  for (const auto& [u, v] : {std::pair{0.3, 0.2}, {0.5, 0.5}, {0.9, 0.7}}) {
    const PanoramaSize fine{2000, 1000};
    const Vec3d d = direction_of_texel(fine, static_cast<std::size_t>(u * 2000), static_cast<std::size_t>(v * 1000));
    EXPECT_NEAR(0.5 - std::atan2(d.x, d.z) / (2 * pi), u, 1.0 / 2000);
    EXPECT_NEAR(std::acos(d.y) / pi, v, 1.0 / 1000);
  }
}

// A plane under an even sky of L has E = pi L, whatever its normal; texels on the horizon are divided 8 x 8: error of the order of
// (texel / 8)^2.
TEST(Panorama, EvenSkyGivesPi) {
  const std::vector<Vec3f> texels = even(100);
  for (const Vec3d n : {Vec3d{0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {0.3, 0.5, -0.7}, {-2, 0.1, 0.4}})
    EXPECT_NEAR(illuminance_of_panorama(texels, size, n)->x / (100 * pi), 1, 2e-5) << n.x << " " << n.y;
  EXPECT_NEAR(illuminance_of_panorama(texels, size, {0, 1, 0})->y / (100 * pi), 1, 1e-12);
}
// A gradient L = 1 + y: E on the ground is pi + 2 pi/3.
TEST(Panorama, GradientSkyIsItsIntegral) {
  std::vector<Vec3f> texels = even(0);
  for (std::size_t row = 0; row < size.height; ++row)
    for (std::size_t column = 0; column < size.width; ++column) {
      const auto l = static_cast<float>(1 + direction_of_texel(size, column, row).y);
      texels[row * size.width + column] = {l, 2 * l, 0};
    }
  const Rgb e = *illuminance_of_panorama(texels, size, {0, 1, 0});
  EXPECT_NEAR(e.x, pi + 2 * pi / 3, 1e-3);  // constant texels of 1.4 degrees: (pi/128)^2 / 12 of the second derivative, and float
  EXPECT_EQ(e.z, 0);
  EXPECT_NEAR(e.y, 2 * e.x, 1e-5);
}

TEST(Calibration, FromALuxMeterAndFromASpotMeter) {
  std::vector<Vec3f> texels = even(0.25F);
  paint_disc(texels, {1, 1, 0}, 0.2, {0.5, 0.5, 0.5});
  const double by_lux = *factor_for_illuminance(texels, size, {0, 1, 0}, 12000);
  for (Vec3f& t : texels) t *= static_cast<float>(by_lux);
  EXPECT_NEAR(luminance_of(*illuminance_of_panorama(texels, size, {0, 1, 0})), 12000, 12000 * 1e-6);
  // A spot of 1 degree in the disc reads twice what one beside it reads; a cone smaller than a texel reads the texel.
  EXPECT_NEAR(*factor_for_luminance(texels, size, {1, 1, 0}, 1 * pi / 180, 8000) * texels[0].x * 2, 8000, 8000 * 1e-6);
  EXPECT_NEAR(*factor_for_luminance(texels, size, {-1, -1, 0}, 1e-9, 2000) * texels[0].x, 2000, 2000 * 1e-6);
}

// Sun and sky apart give every plane that sees the whole sun what they gave together, and the light alone pi L sin^2(radius) nearly.
TEST(Sun, LightAndRestKeepEveryIlluminance) {
  std::vector<Vec3f> texels = even(4000);
  const Vec3d towards = normalised(Vec3d{0.4, 0.7, -0.3});
  paint_disc(texels, towards, 0.05, {2e6F, 1.8e6F, 1.5e6F});
  const std::vector<Vec3f> before = texels;
  const Result<SunCut> sun = cut_sun(texels, size, 0.09);
  ASSERT_TRUE(sun.ok());
  EXPECT_NEAR(dot(sun->direction, towards), 1, 1e-4);
  EXPECT_EQ(sun->at_maximum, static_cast<std::size_t>(std::count(before.begin(), before.end(), Vec3f{2e6F, 1.8e6F, 1.5e6F})));
  EXPECT_EQ(texels[0], before[0]);
  for (const Vec3f& t : texels) ASSERT_LT(t.x, 4001);
  const Rgb light = resolve(sun->light)->rgb * (pi * std::pow(std::sin(0.2666 * pi / 180), 2));  // E of the disc of its luminance
  EXPECT_NEAR(luminance_of(light), sun->illuminance_lx, sun->illuminance_lx * 1e-9);
  for (const Vec3d n : {Vec3d{0, 1, 0}, {0.4, 0.7, -0.3}, {1, 1, 0.5}, {0.2, 0.3, -1}}) {
    const double whole = luminance_of(*illuminance_of_panorama(before, size, n)),
                 rest = luminance_of(*illuminance_of_panorama(texels, size, n));
    EXPECT_NEAR(rest + sun->illuminance_lx * dot(normalised(n), sun->direction), whole, whole * 1e-7);  // texels are floats
  }
  // It shines away from the sun, with the colour of what was cut out.
  EXPECT_NEAR(dot(sun->light.transform.vector({0, 0, -1}), sun->direction), -1, 1e-12);
  EXPECT_NEAR(light.x / light.z, (2e6 - 4000) / (1.5e6 - 4000), 1e-3);
}

// The nadir and zenith, where rows shrink to points, and the seam.
TEST(Sun, IsFoundAtThePolesAndTheSeam) {
  for (const Vec3d towards : {Vec3d{0, 1, 0}, {0.01, -1, 0}, {0.001, 0.3, -1}}) {
    std::vector<Vec3f> texels = even(1);
    paint_disc(texels, towards, 0.06, {1e5F, 1e5F, 1e5F});
    const Result<SunCut> sun = cut_sun(texels, size, 0.1);
    ASSERT_TRUE(sun.ok());
    EXPECT_NEAR(dot(sun->direction, normalised(towards)), 1, 2e-4);
    for (const Vec3f& t : texels) ASSERT_LT(t.x, 2);
  }
}

TEST(Panorama, BadInputIsNamed) {
  std::vector<Vec3f> texels = even(1);
  EXPECT_EQ(illuminance_of_panorama(std::span(texels).first(7), size, {0, 1, 0}).error().code, "PANORAMA_INVALID");
  EXPECT_EQ(illuminance_of_panorama(texels, size, {0, 0, 0}).error().code, "DIRECTION_INVALID");
  EXPECT_EQ(factor_for_illuminance(texels, size, {0, 1, 0}, 0).error().code, "CALIBRATION_IMPOSSIBLE");
  EXPECT_EQ(factor_for_illuminance(even(0), size, {0, 1, 0}, 100).error().code, "CALIBRATION_IMPOSSIBLE");
  EXPECT_EQ(cut_sun(texels, size, 0.1).error().code, "SUN_NOT_FOUND");
  EXPECT_EQ(cut_sun(texels, size, 1e-4).error().code, "SUN_RADIUS_INVALID");
  EXPECT_EQ(cut_sun(texels, size, 2).error().code, "SUN_RADIUS_INVALID");
  texels[5 * size.width + 3].y = std::numeric_limits<float>::quiet_NaN();
  const Error error = illuminance_of_panorama(texels, size, {0, 1, 0}).error();
  EXPECT_EQ(error.code, "PANORAMA_INVALID");
  EXPECT_NE(error.text.find("column 3, row 5"), std::string::npos);
}

}  // namespace
}  // namespace etendue
