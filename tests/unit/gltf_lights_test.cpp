// Lights that are references: photometric files (EXT_lights_ies) and environments (EXT_lights_image_based).
#include <cmath>

#include "gltf_builder.h"

namespace etendue::test {
namespace {

const std::string profile = "IES:LM-63-2019\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 10\n0 90\n0\n100 50\n";

GltfBuilder with_profile(const Json& light) {
  GltfBuilder gltf;
  gltf.json["extensionsUsed"] = {"EXT_lights_ies"};
  gltf.json["extensions"]["EXT_lights_ies"]["lights"] = Json::array({light});
  const double h = std::sqrt(0.5);
  // Turned by -90 degrees about X, -Z becomes -Y: the lamp looks down.
  gltf.json["nodes"] = Json::array({{{"name", "lamp"},
                                     {"translation", {0, 3, 0}},
                                     {"rotation", {-h, 0, 0, h}},
                                     {"scale", {2, 2, 2}},
                                     {"extensions", {{"EXT_lights_ies", {{"light", 0}, {"multiplier", 2}, {"color", {1, 0.5, 0.25}}}}}}}});
  return gltf;
}

void expect_profile(const Result<Imported>& imported) {
  ASSERT_TRUE(imported.ok());
  EXPECT_FALSE(imported->diagnostics.has_errors()) << all_text(imported->diagnostics);
  ASSERT_EQ(imported->scene.lights.size(), 1u);
  const Light& light = imported->scene.lights[0];
  EXPECT_EQ(light.name, "lamp");
  EXPECT_EQ(light.source, "/extensions/EXT_lights_ies/lights/0");
  EXPECT_EQ(light.emission.given, Emission::Given::as_file);
  EXPECT_EQ(light.filter, (Rgb{2, 1, 0.5}));
  const Vec3d direction = -light.transform.columns[2];
  EXPECT_NEAR(direction.y, -1, 1e-14);
  EXPECT_NEAR(light.transform.determinant(), 1, 1e-14);  // the node's scale does not count
  EXPECT_EQ(light.transform.translation, (Vec3d{0, 3, 0}));
}

TEST(GltfLights, PhotometricFileBesideTheAsset) {
  const Folder folder;
  folder.write("profiles/lamp.ies", profile);
  const auto imported = read_gltf(with_profile({{"uri", "profiles/lamp.ies"}}), folder);
  expect_profile(imported);
  const auto* shape = std::get_if<PhotometricShape>(&imported->scene.lights[0].shape);
  ASSERT_NE(shape, nullptr);
  EXPECT_EQ(shape->file, (folder.path() / "profiles/lamp.ies").string());
  EXPECT_FALSE(shape->embedded);
}

TEST(GltfLights, PhotometricTextInsideTheAsset) {
  const std::vector<std::uint8_t> bytes(profile.begin(), profile.end());
  for (const bool in_view : {true, false}) {
    const Folder folder;
    GltfBuilder gltf = with_profile({{"uri", "data:application/x-ies-lm-63;base64," + base64(bytes)}});
    if (in_view)
      gltf.json["extensions"]["EXT_lights_ies"]["lights"][0] = {{"bufferView", gltf.view(bytes)}, {"mimeType", "application/x-ies-lm-63"}};
    const auto imported = read_gltf(gltf, folder);
    expect_profile(imported);
    const auto* shape = std::get_if<PhotometricShape>(&imported->scene.lights[0].shape);
    ASSERT_NE(shape, nullptr);
    EXPECT_EQ(std::string(shape->embedded.begin(), shape->embedded.end()), profile);
  }
}

TEST(GltfLights, PhotometricFileOutsideTheFolderIsRefused) {
  const Folder folder;
  const auto imported = read_gltf(with_profile({{"uri", "../lamp.ies"}}), folder);
  ASSERT_TRUE(imported.ok());
  EXPECT_TRUE(imported->diagnostics.has_errors());
  EXPECT_TRUE(imported->scene.lights.empty());
}

TEST(GltfLights, ImageBasedEnvironmentIsAReference) {
  const Folder folder;
  GltfBuilder gltf;
  gltf.triangle();
  gltf.json["extensionsUsed"] = {"EXT_lights_image_based"};
  Json faces = Json::array();
  for (int i = 0; i < 6; ++i) {
    const std::string name = "face" + std::to_string(i) + ".png";
    folder.write(name, "\x89PNG\r\n\x1A\n");
    gltf.json["images"].push_back({{"uri", name}});
    faces.push_back(i);
  }
  gltf.json["extensions"]["EXT_lights_image_based"]["lights"] = Json::array({{{"intensity", 3},
                                                                              {"specularImageSize", 256},
                                                                              {"irradianceCoefficients", Json(9, Json{0, 0, 0})},
                                                                              {"specularImages", Json::array({faces})}}});
  gltf.json["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
  ImportOptions options;
  options.need = Need::lights | Need::carried;  // the faces are no pictures: nobody looks at them
  const auto imported = read_gltf(gltf, folder, options);
  ASSERT_TRUE(imported.ok());
  ASSERT_EQ(imported->scene.lights.size(), 1u) << all_text(imported->diagnostics);
  const auto* sky = std::get_if<EnvironmentShape>(&imported->scene.lights[0].shape);
  ASSERT_NE(sky, nullptr);
  EXPECT_EQ(sky->cube.size(), 6u);
  EXPECT_EQ(imported->scene.images.size(), 6u);
  EXPECT_EQ(imported->scene.images[sky->cube[5]].name, "face5.png");
  EXPECT_EQ(imported->scene.lights[0].filter.x, 3);
  EXPECT_TRUE(says(imported->diagnostics, Severity::warning, "NOT_SHOWN", "/extensions/EXT_lights_image_based/lights/0"));
}

// Khronos' validator warns of the value; what is lost is said as well.
TEST(GltfLights, UnknownTypesAreNamed) {
  GltfBuilder gltf;
  gltf.json["extensionsUsed"] = {"KHR_lights_punctual"};
  gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(R"([{"type": "sun"}])");
  gltf.json["nodes"] = Json::parse(R"([{"extensions": {"KHR_lights_punctual": {"light": 0}}}])");
  const Folder folder;
  const auto imported = read_gltf(gltf, folder);
  ASSERT_TRUE(imported.ok());
  EXPECT_TRUE(imported->scene.lights.empty());
  EXPECT_TRUE(says(imported->diagnostics, Severity::warning, "VALUE_NOT_IN_LIST", "/extensions/KHR_lights_punctual/lights/0/type"));
  EXPECT_TRUE(says(imported->diagnostics, Severity::warning, "NOT_REPRESENTED", "/extensions/KHR_lights_punctual/lights/0"));
}

}  // namespace
}  // namespace etendue::test
