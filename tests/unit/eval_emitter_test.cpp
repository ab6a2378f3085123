// From lights as authored to emitters: flux in, lux out, orientation, and what is refused.
#include "etendue/eval.h"

#include <gtest/gtest.h>

#include "photometry_builder.h"

#include <cmath>

namespace {

using namespace etendue;
using namespace etendue::eval;

Light light_with(Shape shape, Emission::Given given, double value) {
  Light light;
  light.name = "lamp";
  light.shape = std::move(shape);
  light.emission.given = given;
  light.emission.value = value;
  return light;
}

// What a light emits in all, caught by the inside of a large sphere around it: the mean over directions of E r^2, times 4 pi. The sphere is
// so large that every light is nearly a point; its own size enters as (size / r)^2.
double caught_flux(const Emitter& emitter, const Vec3d& centre) {
  constexpr int nz = 200, nphi = 200;
  constexpr double r = 200;
  double sum = 0;
  for (int i = 0; i < nz; ++i) {
    const double z = -1 + 2 * (i + 0.5) / nz, s = std::sqrt(1 - z * z);
    for (int j = 0; j < nphi; ++j) {
      const double phi = 2 * pi * (j + 0.5) / nphi;
      const Vec3d d{s * std::cos(phi), s * std::sin(phi), z};
      sum += luminance_of(illuminance(emitter, centre + d * r, -d)) * r * r;
    }
  }
  return sum * 4 * pi / (nz * nphi);
}

Transform posed() {
  return Transform::from_trs({1, 2, 3}, {0.1825741858350554, 0.3651483716701107, 0.5477225575051661, 0.7302967433402214});
}

// 1000 lm in, 1000 lm out, whatever the shape, in colour, turned and moved. The midpoint rule is good to 1e-3 for lights that end abruptly.
TEST(EmitterOf, LumensInLumensOut) {
  const std::vector<Shape> shapes{PointShape{},
                                  SpotShape{0.3, 0.9},
                                  FrustumShape{1.0, 0.7},
                                  SphereShape{0.1},
                                  DiskShape{0.3},
                                  RectShape{0.6, 0.3},
                                  PolygonShape{{{0, 0}, {0.4, 0}, {0.4, 0.2}, {0.2, 0.2}, {0.2, 0.4}, {0, 0.4}}},
                                  TubeShape{0.6, 0.02, Caps::round},
                                  TubeShape{0.6, 0.02, Caps::flat},
                                  TubeShape{0.6, 0.02, Caps::none},
                                  LineShape{0.5}};
  for (const Shape& shape : shapes) {
    Light light = light_with(shape, Emission::Given::flux, 1000);
    light.colour = TemperatureColour{3000};
    light.transform = posed();
    const Result<Emitter> emitter = emitter_of(light);
    ASSERT_TRUE(emitter) << name_of(shape) << ": " << emitter.error().text;
    EXPECT_NEAR(caught_flux(*emitter, {1, 2, 3}), 1000, 6) << name_of(shape);
  }
}

TEST(EmitterOf, TwoSidedFluxIsThatOfBothSides) {
  for (const Shape& shape : {Shape{DiskShape{0.3}}, Shape{RectShape{0.6, 0.3}}}) {
    Light light = light_with(shape, Emission::Given::flux, 1000);
    light.two_sided = true;
    EXPECT_NEAR(caught_flux(*emitter_of(light), {}), 1000, 5) << name_of(shape);
  }
}

// Lights emit along their own -Z; an unturned light lights what is below z = 0.
TEST(EmitterOf, EmissionIsAlongMinusZ) {
  for (const Shape& shape : {Shape{SpotShape{0.3, 0.9}}, Shape{FrustumShape{1.0, 0.7}}, Shape{DiskShape{0.3}}, Shape{RectShape{0.6, 0.3}},
                             Shape{PolygonShape{{{0, 0}, {1, 0}, {0, 1}}}}, Shape{PolygonShape{{{0, 0}, {0, 1}, {1, 0}}}}}) {
    const Emitter e = *emitter_of(light_with(shape, Emission::Given::flux, 100));
    EXPECT_GT(illuminance(e, {0.1, 0.1, -2}, {0, 0, 1}).x, 0) << name_of(shape);
    EXPECT_EQ(illuminance(e, {0.1, 0.1, 2}, {0, 0, -1}).x, 0) << name_of(shape);
  }
  // A true direction and the sun shine along -Z as well: they are seen towards +Z.
  for (const double diameter : {0.0, 0.0093}) {
    const Emitter e = *emitter_of(light_with(DistantShape{diameter}, Emission::Given::illuminance, 1000));
    EXPECT_NEAR(luminance_of(illuminance(e, {}, {0, 0, 1})), 1000, 1e-6);
    EXPECT_EQ(illuminance(e, {}, {0, 0, -1}), Rgb{});
  }
}

// Width along X, height along Y; the line and the tube along X; frustum width along X.
TEST(EmitterOf, Extents) {
  const Emitter rect = *emitter_of(light_with(RectShape{2, 0.5}, Emission::Given::luminance, 1));
  EXPECT_GT(light_along(rect, {0.9, 0, -1}, {0, 0, 1}).radiance.x, 0);
  EXPECT_EQ(light_along(rect, {0, 0.9, -1}, {0, 0, 1}).radiance.x, 0);
  const Emitter tube = *emitter_of(light_with(TubeShape{2, 0.1, Caps::round}, Emission::Given::luminance, 1));
  EXPECT_GT(light_along(tube, {0.9, 0, -1}, {0, 0, 1}).radiance.x, 0);
  EXPECT_EQ(light_along(tube, {0, 0.9, -1}, {0, 0, 1}).radiance.x, 0);
  EXPECT_GT(light_along(tube, {1.05, 0, -1}, {0, 0, 1}).radiance.x, 0);  // the round cap
  EXPECT_EQ(light_along(tube, {1.15, 0, -1}, {0, 0, 1}).radiance.x, 0);
}

// Seen from the front with +Y up, +X is to the left: u grows towards -X, v downwards.
TEST(EmitterOf, PatternsStandUprightFromTheFront) {
  for (const Shape& shape :
       {Shape{RectShape{1, 1}}, Shape{DiskShape{0.5}}, Shape{PolygonShape{{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}}}}) {
    EmitterParts parts;
    parts.pattern = [](Vec2d uv) { return Rgb{uv.x, uv.y, 0}; };
    const Emitter e = *emitter_of(light_with(shape, Emission::Given::luminance, 1), parts);
    const Rgb at = light_along(e, {0.25, 0.3, -1}, {0, 0, 1}).radiance;
    EXPECT_NEAR(at.x, 0.25, 1e-12) << name_of(shape);
    EXPECT_NEAR(at.y, 0.2, 1e-12) << name_of(shape);
  }
}

// A mesh light emits on its counter-clockwise side, also under a mirroring scale; its flux is L pi A of the scaled area.
TEST(EmitterOf, Meshes) {
  EmitterParts parts;
  parts.triangles = {{Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}}};  // counter-clockwise seen from +Z
  for (const Vec3d& scale : {Vec3d{1, 1, 1}, Vec3d{0.5, 2, 1}, Vec3d{-1, 1, 1}}) {
    const Emitter e = *emitter_of(light_with(MeshShape{0, scale}, Emission::Given::flux, 100), parts);
    EXPECT_GT(illuminance(e, {0, 0, 1}, {0, 0, -1}).x, 0);
    EXPECT_EQ(illuminance(e, {0, 0, -1}, {0, 0, 1}).x, 0);
    EXPECT_NEAR(luminance_of(e.radiance) * pi * 0.5 * std::abs(scale.x * scale.y), 100, 1e-9);
  }
}

// Texture coordinates belong to corners: the pattern is interpolated between them, mirrored or not.
TEST(EmitterOf, MeshesWithPatterns) {
  EmitterParts parts;
  parts.triangles = {{Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}}};
  parts.uvs = {{Vec2d{0, 0}, Vec2d{1, 0}, Vec2d{0, 1}}};
  parts.pattern = [](Vec2d uv) { return Rgb{uv.x, uv.y, 0}; };
  for (const double mirror : {1.0, -1.0}) {
    const Emitter e = *emitter_of(light_with(MeshShape{0, {mirror, 1, 1}}, Emission::Given::luminance, 1), parts);
    const Rgb at = light_along(e, {mirror * 0.2, 0.3, 1}, {0, 0, -1}).radiance;
    EXPECT_NEAR(at.x, 0.2, 1e-12);
    EXPECT_NEAR(at.y, 0.3, 1e-12);
  }
}

TEST(EmitterOf, WindowAndColour) {
  Light light = light_with(PointShape{}, Emission::Given::intensity, 10);
  light.range_m = 4;
  light.falloff = Falloff::gltf;
  light.colour = RgbColour{{1, 0.5, 0.25}};
  const Emitter e = *emitter_of(light);
  const Rgb lux = illuminance(e, {0, 0, -2}, {0, 0, 1});
  EXPECT_NEAR(luminance_of(lux), 10.0 / 4 * (1 - 1.0 / 16), 1e-12);
  EXPECT_NEAR(lux.y / lux.x, 0.5, 1e-12);
  EXPECT_EQ(illuminance(e, {0, 0, -4.01}, {0, 0, 1}), Rgb{});
}

// The web's own frame is the light's: the nadir along -Z, C0 along +X. A stated flux scales the whole web.
TEST(EmitterOf, PhotometricLightsSendTheirWeb) {
  const auto web = std::make_shared<const IntensityDistribution>(
      test::distribution_of(WebType::c, WebSymmetry::none, test::steps(0, 180, 5), test::steps(0, 360, 5),
                            [](const Vec3d& u) { return 100 + 30 * u.x - 20 * u.y - 40 * u.z; }));
  const Emitter e = *emitter_of(light_with(PhotometricShape{"", {}, web}, Emission::Given::as_file, 0));
  EXPECT_NEAR(luminance_of(illuminance(e, {0, 0, -2}, {0, 0, 1})), 140.0 / 4, 1e-9);
  EXPECT_NEAR(luminance_of(illuminance(e, {2, 0, 0}, {-1, 0, 0})), 130.0 / 4, 1e-9);
  EXPECT_NEAR(luminance_of(illuminance(e, {0, 2, 0}, {0, -1, 0})), 80.0 / 4, 1e-9);
  const Emitter scaled = *emitter_of(light_with(PhotometricShape{"", {}, web}, Emission::Given::flux, 4000 * pi));
  EXPECT_NEAR(luminance_of(illuminance(scaled, {0, 0, -2}, {0, 0, 1})), 10 * 140.0 / 4,
              0.05);  // the web's own flux is 400 pi within its steps
}

// A cone over the web multiplies it, as a spot's own falloff does; a stated flux is what passes. The web is the closed form 100 (1 - z) in
// steps of half a degree, so with c = -z the flux through a cone is 200 pi (integral of (1 + c) share dc), and with x = (c - o) / (i - o)
//   share = x^2 between o and i: (i - o) ((1 + o) / 3 + (i - o) / 4), and 1 from i to 1: (1 - i) + (1 - i^2) / 2.
TEST(EmitterOf, AConeOverAPhotometricLightMultipliesIt) {
  const auto web = std::make_shared<const IntensityDistribution>(test::distribution_of(
      WebType::c, WebSymmetry::rotational, test::steps(0, 180, 0.5), {0}, [](const Vec3d& u) { return 100 - 100 * u.z; }));
  const SpotShape cone{0.4, 0.9};
  const Emitter plain = *emitter_of(light_with(PhotometricShape{"", {}, web}, Emission::Given::as_file, 0));
  const Emitter through = *emitter_of(light_with(PhotometricShape{"", {}, web, cone}, Emission::Given::as_file, 0));
  const Emitter spot = *emitter_of(light_with(cone, Emission::Given::intensity, 1));
  for (int k = 0; k < 315; ++k) {
    const double theta = 0.01 * k;
    const Vec3d place{2 * std::sin(theta) * std::cos(7 * theta), 2 * std::sin(theta) * std::sin(7 * theta), -2 * std::cos(theta)};
    const auto lux = [&](const Emitter& e) { return luminance_of(illuminance(e, place, -place / 2)); };
    EXPECT_NEAR(lux(through), lux(plain) * lux(spot) * 4, 1e-12 * lux(plain)) << theta;
  }
  const double i = std::cos(cone.inner_rad), o = std::cos(cone.outer_rad), a = i - o;
  const double passed = 200 * pi * (a * ((1 + o) / 3 + a / 4) + (1 - i) + (1 - i * i) / 2);
  const auto& profile = std::get<ProfileShape>(std::get<PunctualEmitter>(through.shape).shape);
  EXPECT_NEAR(flux_lm(profile) / passed, 1, 1e-5);  // a web in steps of h misses h^2 / 12 of its second derivative
  const Emitter scaled = *emitter_of(light_with(PhotometricShape{"", {}, web, cone}, Emission::Given::flux, 10 * flux_lm(profile)));
  EXPECT_NEAR(luminance_of(illuminance(scaled, {0, 0, -2}, {0, 0, 1})), 10 * 200.0 / 4, 1e-9);
  // Nothing passes where the web is dark inside the cone.
  const auto upwards = std::make_shared<const IntensityDistribution>(
      test::distribution_of(WebType::c, WebSymmetry::rotational, {0, 90, 180}, {0}, [](const Vec3d& u) { return std::max(0.0, u.z); }));
  EXPECT_EQ(emitter_of(light_with(PhotometricShape{"", {}, upwards, cone}, Emission::Given::flux, 5)).error().code,
            "EVALUATION_UNSUPPORTED");
}

TEST(EmitterOf, RefusesWhatItCannotDo) {
  const Result<Emitter> ies = emitter_of(light_with(PhotometricShape{"lamp.ies"}, Emission::Given::as_file, 0));
  ASSERT_FALSE(ies);
  EXPECT_EQ(ies.error().code, "EVALUATION_UNSUPPORTED");
  Light open = light_with(TubeShape{1, 0.1, Caps::none}, Emission::Given::luminance, 1);
  open.two_sided = true;
  ASSERT_FALSE(emitter_of(open));
  EXPECT_EQ(emitter_of(open).error().code, "EVALUATION_UNSUPPORTED");
  const Result<Emitter> lux = emitter_of(light_with(PointShape{}, Emission::Given::illuminance, 100));
  ASSERT_FALSE(lux);
  EXPECT_EQ(lux.error().code, "DISTANCE_MISSING");
}

TEST(EmitterOf, EnvironmentTurnsWithItsLight) {
  std::vector<Vec3f> pixels(128, Vec3f{0, 0, 0});
  for (std::size_t i = 0; i < 16; ++i) pixels[i] = pixels[16 + i] = {1, 1, 1};  // 16 x 8, bright around +Y
  EmitterParts parts;
  parts.environment = make_environment(16, 8, pixels);
  Light light = light_with(EnvironmentShape{0u}, Emission::Given::as_file, 0);
  EXPECT_GT(light_along(*emitter_of(light, parts), {}, {0, 1, 0}).radiance.x, 0.5);
  light.transform = Transform::from_trs({}, {0, 0, std::sqrt(0.5), std::sqrt(0.5)});  // +Y to -X
  EXPECT_GT(light_along(*emitter_of(light, parts), {}, {-1, 0, 0}).radiance.x, 0.5);
  EXPECT_EQ(light_along(*emitter_of(light, parts), {}, {1, 0, 0}).radiance.x, 0);
}

}  // namespace
