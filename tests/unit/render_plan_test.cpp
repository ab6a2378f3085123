// Glossy floors under lights that the planner meets in its different ways, against the reference over each pixel's area.
#include "etendue/light_pictures.h"
#include "etendue/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "folder.h"

namespace etendue {
namespace {

constexpr Vec3d normal{0, 1, 0};

Light with_luminance(Shape shape, double luminance, const Transform& transform) {
  Light light;
  light.name = "light";
  light.shape = std::move(shape);
  light.emission.given = Emission::Given::luminance;
  light.emission.value = luminance;
  light.transform = transform;
  return light;
}
Transform facing_down(const Vec3d& position) { return {{Vec3d{1, 0, 0}, Vec3d{0, 0, -1}, Vec3d{0, 1, 0}}, position}; }

// A rectangle, a sphere and a disk in cells, two of them far away too, by a few places. Nothing stands in their way.
TEST(RenderPlan, PicturesKeepTheTolerance) {
  Scene scene;
  Object floor;
  floor.name = "floor";
  floor.geometry = PlaneGeometry{20};
  floor.material = 0;
  scene.objects.push_back(floor);
  scene.cameras.push_back(look_at({0, 3, 3}, {0, 0, 0}, 0.6));
  scene.lights = {with_luminance(RectShape{1.2, 0.6}, 900, facing_down({0, 1.4, -1})),
                  with_luminance(RectShape{0.2, 0.1}, 5e4, facing_down({-1, 8, -9})),
                  with_luminance(SphereShape{0.1}, 4e4, facing_down({3, 6, -8})),
                  with_luminance(SphereShape{0.3}, 500, facing_down({-0.4, 0.9, -1})),
                  with_luminance(DiskShape{0.25}, 400, facing_down({0.9, 0.8, -0.6}))};
  for (Light& light : scene.lights) light.visible = false;
  RenderOptions options;
  options.width = options.height = 20;
  for (const SurfaceModel& model :
       {SurfaceModel{Standard{{0.6, 0.4, 0.2}, 0.3, 0.5, 0.5}}, SurfaceModel{MetalRough{{0.6, 0.4, 0.2}, 0.5, 0.55}},
        SurfaceModel{Principled{{0.6, 0.4, 0.2}, 0.5, 0.6}}}) {
    scene.materials = {Material{}};
    scene.materials[0].name = "floor";
    scene.materials[0].model = model;
    const Result<Rendered> out = render(scene, options);
    ASSERT_TRUE(out) << out.error().text;
    const std::array<std::uint32_t, 5> all{0, 1, 2, 3, 4};
    const auto emitters = emitters_of(scene, all);
    ASSERT_TRUE(emitters);
    const eval::Brdf brdf = std::visit(
        [](const auto& m) -> eval::Brdf {
          if constexpr (std::is_constructible_v<eval::Brdf, decltype(m)>) return m;
          return Lambert{};
        },
        model);
    const double half = std::tan(0.3), away = std::sqrt(0.15);
    const std::array<double, 3> place{0.5 - away, 0.5, 0.5 + away}, weight{5 / 18.0, 8 / 18.0, 5 / 18.0};
    // Of the picture's border a pixel has no second differences.
    for (std::size_t pixel = 27; pixel < 378; pixel += 29) {
      if (pixel % 20 == 0 || pixel % 20 == 19) continue;
      Rgb expected;
      for (std::size_t k = 0; k < 9; ++k) {
        const std::size_t column = pixel % 20, row = pixel / 20;
        const double x = static_cast<double>(column) + place[k % 3], y = static_cast<double>(row) + place[k / 3];
        const Vec3d d = scene.cameras[0].transform.vector({(2 * x / 20 - 1) * half, (1 - 2 * y / 20) * half, -1});
        const Vec3d eye = scene.cameras[0].transform.translation, at = eye + d * (-eye.y / d.y);
        for (const eval::Emitter& emitter : *emitters) {
          const eval::Estimate light = eval::reference(emitter, {at, normal, normal, normalised(eye - at), brdf}, {1e-7, 0});
          expected += light.value * (weight[k % 3] * weight[k / 3]);
        }
      }
      // Shading is asked for a fiftieth of the noise that is expected, 1e-2, of each light; as much may be left of a pixel's mean.
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(static_cast<double>(out->picture.find("")->pixels[3 * pixel + c]), expected[static_cast<int>(c)],
                    4e-4 * expected[static_cast<int>(c)])
            << pixel << " model " << model.index();
    }
  }
}

// A screen with a picture over a matt and a rough floor is as good as one without: no noise, and within the tolerance of the pixel's mean.
TEST(RenderPlan, ScreensAreNotSampled) {
  const test::Folder folder;
  const auto file = folder.write(
      "screen.ppm", "P6\n3 2\n255\n" + std::string("\xff\x10\x10\x10\xff\x10\x10\x10\xff\x80\x80\x80\xff\xff\x10\x10\xff\xff", 18));
  Scene scene;
  Object floor;
  floor.name = "floor";
  floor.geometry = PlaneGeometry{20};
  floor.material = 0;
  scene.objects.push_back(floor);
  scene.materials.push_back({});
  scene.materials[0].name = "floor";
  scene.cameras.push_back(look_at({0, 3, 3}, {0, 0, 0}, 0.6));
  scene.images.push_back({file.string(), nullptr, "", "screen"});
  scene.lights = {with_luminance(RectShape{1.6, 0.9}, 300, facing_down({0, 1.4, -1}))};
  scene.lights[0].visible = false;
  scene.lights[0].emission.texture = Texture{};
  RenderOptions options;
  options.width = options.height = 20;
  const std::array<std::uint32_t, 1> all{0};
  const auto pictured = pictured_emitters_of(scene, all);
  ASSERT_TRUE(pictured);
  const PicturedEmitter& light = pictured->front();
  ASSERT_NE(light.picture, nullptr);
  const std::array<eval::Brdf, 2> brdfs{Lambert{{0.5, 0.5, 0.5}}, Conductor{{0.2, 0.9, 1.1}, {3.9, 2.4, 2.1}, 0.4}};
  for (const eval::Brdf& brdf : brdfs) {
    if (const auto* matt = std::get_if<Lambert>(&brdf)) scene.materials[0].model = *matt;
    if (const auto* metal = std::get_if<Conductor>(&brdf)) scene.materials[0].model = *metal;
    const Result<Rendered> out = render(scene, options);
    ASSERT_TRUE(out) << out.error().text;
    EXPECT_EQ(out->stats.shadow_rays, 0U);
    const double half = std::tan(0.3), away = std::sqrt(0.15);
    const std::array<double, 3> place{0.5 - away, 0.5, 0.5 + away}, weight{5 / 18.0, 8 / 18.0, 5 / 18.0};
    for (std::size_t pixel = 27; pixel < 378; pixel += 29) {
      if (pixel % 20 == 0 || pixel % 20 == 19) continue;
      Rgb expected;
      for (std::size_t k = 0; k < 9; ++k) {
        const std::size_t column = pixel % 20, row = pixel / 20;
        const double x = static_cast<double>(column) + place[k % 3], y = static_cast<double>(row) + place[k / 3];
        const Vec3d d = scene.cameras[0].transform.vector({(2 * x / 20 - 1) * half, (1 - 2 * y / 20) * half, -1});
        const Vec3d eye = scene.cameras[0].transform.translation, at = eye + d * (-eye.y / d.y);
        const auto exact =
            eval::picture_luminance(light.emitter, *light.picture, {at, normal, normal, normalised(eye - at), brdf}, {1e-5, 0});
        ASSERT_TRUE(exact);
        expected += exact->value * (weight[k % 3] * weight[k / 3]);
      }
      for (std::size_t c = 0; c < 3; ++c) {
        const double want = expected[static_cast<int>(c)];
        EXPECT_NEAR(static_cast<double>(out->picture.find("")->pixels[3 * pixel + c]), want, 4e-4 * want) << pixel << ' ' << brdf.index();
      }
    }
  }
}

}  // namespace
}  // namespace etendue
