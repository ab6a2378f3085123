#include "importers/rig/rig.h"

#include <gtest/gtest.h>

#include "importers/rig/rig_text.h"

namespace etendue {
namespace {

Imported read(std::string_view text) {
  Result<Imported> imported = rig::read_rig_text(text, "t.rig.json", "no_such_folder", nullptr, {});
  EXPECT_TRUE(imported.ok()) << to_string(to_diagnostic(imported.ok() ? Error{} : imported.error()));
  return imported ? std::move(*imported) : Imported{};
}

std::string told(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& d : diagnostics.all()) text += to_string(d) + "\n";
  return text;
}

constexpr std::string_view sample = R"({ "etendue": 1,
  "lights": [
    { "name": "key", "shape": {"type": "rect", "width": "1.2 m", "height": "60 cm"}, "emission": {"flux": "1500 lm"}, "colour": {"temperature": "3000 K"},
      "translation": [0, 2.4, 0], "rotation": [-0.7071068, 0, 0, 0.7071068] },
    { "name": "bulb", "shape": {"type": "sphere", "radius": "3 cm"}, "emission": {"luminance": "20 knit"}, "colour": {"rgb": [1, 0.9, 0.8]}, "translation": [1, 1.5, 0] } ],
  "camera": { "position": [0, 1.6, 4], "target": [0, 1, 0], "vfov": "40 deg", "exposure": {"ev100": 8} },
  "materials": [ { "name": "floor", "model": "lambert", "base_colour": [0.5, 0.5, 0.5] } ],
  "objects": [ { "shape": {"type": "plane", "size": 10}, "material": "floor" } ]
})";

TEST(RigImport, ReadsTheSample) {
  const Imported imported = read(sample);
  EXPECT_TRUE(imported.diagnostics.all().empty()) << told(imported.diagnostics);
  const Scene& scene = imported.scene;
  ASSERT_EQ(scene.lights.size(), 2u);
  const Light& key = scene.lights[0];
  EXPECT_EQ(key.name, "key");
  EXPECT_EQ(std::get<RectShape>(key.shape).width, 1.2);
  EXPECT_EQ(std::get<RectShape>(key.shape).height, 0.6);
  EXPECT_EQ(key.emission.given, Emission::Given::flux);
  EXPECT_EQ(key.emission.value, 1500);
  EXPECT_EQ(std::get<TemperatureColour>(key.colour).kelvin, 3000);
  EXPECT_EQ(key.source, "/lights/0");
  // Turned by -90 degrees about X the light's -Z, where it emits, looks down.
  const Vec3d down = key.transform.vector({0, 0, -1});
  EXPECT_NEAR(down.y, -1, 1e-12);
  EXPECT_EQ(scene.lights[1].emission.value, 20000);
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_NEAR(scene.cameras[0].vfov_rad, 40 * pi / 180, 1e-15);
  EXPECT_EQ(scene.cameras[0].ev100, 8);
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(std::get<PlaneGeometry>(scene.objects[0].geometry).size, 10);
  EXPECT_EQ(scene.objects[0].material, 0u);
  EXPECT_TRUE(validate(scene).all().empty()) << told(validate(scene));
}

}  // namespace
}  // namespace etendue
