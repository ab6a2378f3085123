// The real Mitsuba loads every kind of light, geometry and material that the exporter writes; it refuses properties that it does not read.
#include "fixture.h"

namespace etendue::testing {
namespace {

// A room corner with one light in it.
Scene room_with(Light light) {
  Scene scene;
  scene.materials.push_back({});
  scene.materials[0].name = "floor";
  scene.materials[0].model = Lambert{{0.5, 0.4, 0.3}};
  Object floor;
  floor.name = "floor";
  floor.geometry = PlaneGeometry{8};
  floor.material = 0;
  scene.objects.push_back(floor);
  scene.cameras.push_back(look_at({0, 2, 6}, {0, 1, 0}, 0.8));
  light.transform = aimed({0.5, 2, 0.25}, {0.2, -1, 0.1});
  scene.lights.push_back(std::move(light));
  return scene;
}

std::vector<Shape> every_shape() {
  return {PointShape{},
          SpotShape{0.35, 0.78},
          SpotShape{0.5, 0.5},
          SpotShape{1.0, pi / 2},
          FrustumShape{0.8, 0.5},
          FrustumShape{0.4, 1.2},
          DistantShape{0},
          DistantShape{0.0093},
          SphereShape{0.2},
          DiskShape{0.3},
          RectShape{0.6, 0.3},
          PolygonShape{{{-0.4, -0.4}, {0.4, -0.4}, {0.4, 0.4}, {0, 0}, {-0.4, 0.4}}},
          TubeShape{1, 0.05, Caps::round},
          TubeShape{1, 0.05, Caps::flat},
          TubeShape{1, 0.05, Caps::none},
          LineShape{1},
          EnvironmentShape{}};
}

TEST(Load, EveryLightLitAndMuted) {
  ETENDUE_NEEDS_MITSUBA();
  std::vector<std::filesystem::path> files;
  ExportOptions options;
  options.width = options.height = 16;
  for (const Shape& shape : every_shape()) {
    for (const bool two_sided : {false, true}) {
      Light light = light_of(shape);
      light.two_sided = two_sided;
      if (two_sided && !emits_both_sides(light)) continue;
      Scene scene = room_with(light);
      const std::string name = light.name + std::to_string(files.size());
      options.lit = {};
      exported(scene, name, options);
      files.push_back(scratch() / (name + ".xml"));
      // A second light that emits, so that there is one in Mitsuba's file.
      scene.lights.push_back(light_of(PointShape{}));
      scene.lights[1].transform.translation = {1, 3, 1};
      options.lit = {1};
      exported(scene, name + "_muted", options);
      files.push_back(scratch() / (name + "_muted.xml"));
    }
  }
  const std::vector<Picture> pictures = rendered(files, 16, 5);
  ASSERT_EQ(pictures.size(), files.size());
  for (std::size_t i = 0; i < pictures.size(); ++i) EXPECT_GT(mean_luminance(pictures[i]).value, 0) << files[i];
}

}  // namespace
}  // namespace etendue::testing
