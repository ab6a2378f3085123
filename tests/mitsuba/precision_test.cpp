// Where single precision or coincident surfaces could spoil a picture: far suns, clipping planes, two-sided lights, holes, textures.
#include "fixture.h"

#include "etendue/picture.h"

#include <cmath>

namespace etendue::testing {
namespace {

// A white floor of 2 m seen from above through a narrow lens, so that all of the picture is floor.
Scene white_floor(Light light) {
  Scene scene;
  Material white;
  white.name = "white";
  white.model = Lambert{{1, 1, 1}};
  scene.materials.push_back(white);
  Object floor;
  floor.geometry = PlaneGeometry{2};
  floor.material = 0;
  scene.objects.push_back(floor);
  scene.cameras.push_back(look_at({0, 3, 0.01}, {0, 0, 0}, 0.05));
  scene.lights.push_back(std::move(light));
  return scene;
}

// A sun's disk stands 1e5 times the scene away. Every pixel has E / pi, and the camera that turns to it sees its luminance.
TEST(Precision, Sun) {
  ETENDUE_NEEDS_MITSUBA();
  Light sun = light_of(DistantShape{0.0093});
  sun.transform = aimed({0, 0, 0}, {-1, -1, -0.5});
  const Picture floor = rendered(white_floor(sun), "sun_floor", 8, 64, 5);
  ASSERT_FALSE(floor.layers.empty());
  const double cosine = 1 / 1.5;  // of (1, 1, .5)
  for (std::uint32_t i = 0; i < 8; ++i) EXPECT_NEAR(pixel(floor, i, i).y * pi / (1000 * cosine), 1, 3e-4);

  Scene towards = white_floor(sun);
  towards.cameras[0] = look_at({0, 1, 0}, {100, 101, 50}, 0.0186);  // twice the sun's diameter
  const Picture sky = rendered(towards, "sun_sky", 32, 64, 5);
  ASSERT_FALSE(sky.layers.empty());
  const double luminance = 1000 / (pi * std::sin(0.00465) * std::sin(0.00465));
  EXPECT_NEAR(pixel(sky, 16, 16).y / luminance, 1, 1e-5);
  EXPECT_EQ(pixel(sky, 2, 16).y, 0);
  // A disk of half the picture's height covers pi / 16 of it; 1024 pixels on a border of 50 leave .5 %.
  EXPECT_NEAR(mean_luminance(sky).value / luminance / (pi / 16), 1, 0.005);
}

// Both faces of a two-sided light are seen evenly: neither hides the other.
TEST(Precision, TwoSidedLightsAreEven) {
  ETENDUE_NEEDS_MITSUBA();
  for (const Shape& shape : {Shape{RectShape{1, 1}}, Shape{DiskShape{0.6}}, Shape{PolygonShape{{{-1, -1}, {1, -1}, {0, 1}}}}}) {
    Light light = light_of(shape);
    light.two_sided = true;
    light.transform = aimed({0, 1, 0}, {0.3, 0.1, 1});
    Scene scene = white_floor(light);
    for (const double side : {-1.0, 1.0}) {
      scene.cameras[0] = look_at({0.2 * side, 1.1, 3 * side}, {0, 1, 0}, 0.05);
      const Picture picture = rendered(scene, light.name + "_even", 8, 64, 5);
      ASSERT_FALSE(picture.layers.empty());
      EXPECT_NEAR(mean_luminance(picture).value, 1000, 0.01) << light.name << side;
    }
  }
}

// A two-sided square lights the floor as a one-sided one does, from either side.
TEST(Precision, TwoSidedLightsShineBothWays) {
  ETENDUE_NEEDS_MITSUBA();
  Light light = light_of(RectShape{0.5, 0.5});
  light.transform = aimed({0.7, 1, 0}, {0, -1, 0});  // beside what the camera sees
  const Mean one = mean_luminance(rendered(white_floor(light), "one_side", 8, 2048));
  light.two_sided = true;
  const Mean down = mean_luminance(rendered(white_floor(light), "two_sides_down", 8, 2048));
  light.transform = aimed({0.7, 1, 0}, {0, 1, 0});
  const Mean up = mean_luminance(rendered(white_floor(light), "two_sides_up", 8, 2048));
  for (const Mean& both : {down, up}) {
    EXPECT_NEAR(both.value / one.value, 1, 1e-3 + 4 * std::hypot(both.standard_error, one.standard_error) / one.value);
  }
}

// A camera 1 cm from a wall still sees it.
TEST(Precision, NearClip) {
  ETENDUE_NEEDS_MITSUBA();
  Light light = light_of(PointShape{});
  light.transform.translation = {0, 1, 0};
  Scene scene = white_floor(light);
  scene.cameras[0] = look_at({0, 0.005, 0}, {0, 0, 0.0001}, 0.4);
  const Picture picture = rendered(scene, "near", 8, 16, 5);
  ASSERT_FALSE(picture.layers.empty());
  EXPECT_NEAR(mean_luminance(picture).value * pi, 1000, 1);
}

}  // namespace
}  // namespace etendue::testing
