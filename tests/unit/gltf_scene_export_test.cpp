// Scenes that no document carries, as glTF and back.
#include "exporters/gltf/gltf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "gltf_builder.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;
using gltf::LightShapes;
using test::Folder;

struct Back {
  Scene scene;
  Diagnostics diagnostics;
  LossReport losses;
};

Back there_and_back(const Scene& scene, const fs::path& file, LightShapes shapes = LightShapes::none) {
  const auto exported = make_gltf_exporter(shapes)->write(scene, file, {});
  EXPECT_TRUE(exported) << exported.error().text;
  auto imported = make_gltf_importer(GltfMaterials::all)->read(file, {});
  EXPECT_TRUE(imported) << imported.error().text;
  for (const Diagnostic& d : imported->diagnostics.all()) EXPECT_NE(d.severity, Severity::error) << to_string(d);
  return {std::move(imported->scene), std::move(imported->diagnostics), exported->losses};
}

bool says(const LossReport& losses, const std::string& what) {
  return std::any_of(losses.losses.begin(), losses.losses.end(), [&](const Loss& l) { return l.what.find(what) != std::string::npos; });
}
bool counted_once(const Diagnostics& diagnostics) {
  const auto& all = diagnostics.all();
  return std::any_of(all.begin(), all.end(), [](const Diagnostic& d) { return d.code == "EMISSIVE_MESH_AND_LIGHT"; });
}

Light lamp(std::string name, Shape shape, Emission::Given given, double value) {
  Light light;
  light.name = std::move(name);
  light.shape = std::move(shape);
  light.emission.given = given;
  light.emission.value = value;
  light.transform = Transform::from_trs({0.3, 2, -1}, {0.5, -0.5, 0.5, 0.5});
  return light;
}

double nearly(double a, double b) { return std::abs(a / b - 1); }

void expect_the_same(const Transform& a, const Transform& b) {
  for (std::size_t c = 0; c < 3; ++c) EXPECT_LT(length(a.columns[c] - b.columns[c]), 1e-12);
  EXPECT_LT(length(a.translation - b.translation), 1e-12);
}

// What glTF has itself comes back as it was: in candela and lux, with its colour as a filter.
TEST(GltfScene, PunctualLightsComeBackAsTheyWere) {
  const Folder folder;
  Scene scene;
  scene.lights.push_back(lamp("bulb", PointShape{}, Emission::Given::flux, 800));
  scene.lights.back().colour = TemperatureColour{2700};
  scene.lights.back().range_m = 7;
  scene.lights.back().falloff = Falloff::gltf;
  scene.lights.push_back(lamp("spot", SpotShape{0.3, 0.7}, Emission::Given::intensity, 1200));
  scene.lights.back().filter = {0.5, 0.25, 1};
  scene.lights.push_back(lamp("sun", DistantShape{}, Emission::Given::illuminance, 1e5));
  for (const char* name : {"out.glb", "out.gltf"}) {
    const Back back = there_and_back(scene, folder.path() / name);
    EXPECT_TRUE(back.losses.losses.empty());
    ASSERT_EQ(back.scene.lights.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      const Light &a = scene.lights[i], &b = back.scene.lights[i];
      EXPECT_EQ(b.name, a.name);
      EXPECT_EQ(b.shape.index(), a.shape.index());
      const auto before = resolve(a), after = resolve(b);
      ASSERT_TRUE(before && after);
      EXPECT_EQ(before->kind, after->kind);
      for (int c = 0; c < 3; ++c) EXPECT_LT(nearly(after->rgb[c], before->rgb[c]), 1e-12) << a.name;
      expect_the_same(b.transform, a.transform);
    }
    EXPECT_EQ(back.scene.lights[0].range_m, 7);
    EXPECT_EQ(back.scene.lights[0].falloff, Falloff::gltf);
    EXPECT_NEAR(std::get<SpotShape>(back.scene.lights[1].shape).inner_rad, 0.3, 1e-15);
    EXPECT_NEAR(std::get<SpotShape>(back.scene.lights[1].shape).outer_rad, 0.7, 1e-15);
  }
}

TEST(GltfScene, CamerasObjectsAndMaterialsComeBack) {
  const Folder folder;
  Scene scene;
  Camera camera = look_at({0, 1.6, 4}, {0, 1, 0}, 0.7);
  camera.name = "eye";
  camera.ev100 = 8;
  scene.cameras.push_back(camera);
  Material plaster, gold, ruby;
  plaster.name = "plaster";
  plaster.model = Lambert{{0.7, 0.6, 0.5}};
  gold.name = "gold";
  gold.model = MetalRough{{1, 0.77, 0.34}, 1, 0.3, 1.5};
  gold.double_sided = false;
  ruby.name = "ruby";
  ruby.model = Standard{{0.4, 0.02, 0.05}, 0, 0.2, 0.8};
  scene.materials = {plaster, gold, ruby};
  Object box{"box", BoxGeometry{{1, 2, 3}}, 1, Transform::from_trs({1, 2, 3}, {0.5, 0.5, 0.5, 0.5}, {1, -2, 0.5}), ""};
  Object ball{"ball", SphereGeometry{0.4}, 2, Transform::from_trs({0, 1, 0}, {}), ""};
  Object floor{"floor", PlaneGeometry{10}, 0, {}, ""};
  Object sheared = box;
  sheared.name = "sheared";
  sheared.transform.columns[0] = {1, 0.5, 0};
  scene.objects = {box, ball, floor, sheared};
  const Back back = there_and_back(scene, folder.path() / "out.glb");
  ASSERT_EQ(back.scene.cameras.size(), 1u);
  EXPECT_EQ(back.scene.cameras[0].vfov_rad, 0.7);
  expect_the_same(back.scene.cameras[0].transform, camera.transform);
  EXPECT_TRUE(says(back.losses, "camera 'eye': its exposure"));
  ASSERT_EQ(back.scene.objects.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const Object &a = scene.objects[i], &b = back.scene.objects[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(scene.materials[a.material].name, back.scene.materials[b.material].name);
    const Mesh before = tessellated(a.geometry, scene.meshes), after = tessellated(b.geometry, back.scene.meshes);
    ASSERT_EQ(before.positions.size(), after.positions.size());
    if (a.name != "sheared") {
      EXPECT_EQ(before.indices, after.indices);
      EXPECT_EQ(before.uvs, after.uvs);
    }
    // Where the corners stand in the world, to single precision of coordinates below 10.
    for (std::size_t v = 0; v < before.positions.size(); ++v)
      EXPECT_LT(length(a.transform.point(vec_cast<double>(before.positions[v])) - b.transform.point(vec_cast<double>(after.positions[v]))),
                4e-6);
  }
  const auto found = [&](const char* name) -> const Material& {
    return *std::find_if(back.scene.materials.begin(), back.scene.materials.end(), [&](const Material& m) { return m.name == name; });
  };
  const auto& metal = std::get<MetalRough>(found("gold").model);
  EXPECT_EQ(metal.base_colour, (Rgb{1, 0.77, 0.34}));
  EXPECT_EQ(metal.metallic, 1);
  EXPECT_EQ(metal.roughness, 0.3);
  EXPECT_FALSE(found("gold").double_sided);
  // f0 = .16 x .8^2, as .04 times the specular colour.
  ASSERT_TRUE(found("ruby").lobes.specular);
  EXPECT_NEAR(0.04 * found("ruby").lobes.specular->colour.y, 0.16 * 0.64, 1e-15);
  ASSERT_TRUE(found("plaster").lobes.specular);
  EXPECT_EQ(found("plaster").lobes.specular->factor, 0);
}

TEST(GltfScene, TexturesComeBackWithTheirMaterials) {
  const Folder folder;
  const auto png = test::png();
  Scene scene;
  scene.images.push_back({folder.write("wood.png", std::string(png.begin(), png.end())).string(), {}, "", "wood"});
  for (const char* name : {"plain", "board"}) {
    Material material;
    material.name = name;
    material.model = MetalRough{{0.5, 0.4, 0.3}, 0, 0.7, 1.5};
    scene.materials.push_back(material);
    scene.objects.push_back({name, PlaneGeometry{1}, static_cast<std::uint32_t>(scene.objects.size()), {}, ""});
  }
  Texture texture{0, Encoding::srgb, Wrap::clamp, Wrap::mirror, true};
  texture.uv_transform[0][0] = 0;
  texture.uv_transform[0][1] = -2;
  texture.uv_transform[0][2] = 0.25;
  texture.uv_transform[1][0] = 3;
  texture.uv_transform[1][1] = 0;
  scene.materials[1].base_colour_texture = texture;
  for (const char* name : {"out.glb", "out.gltf"}) {
    const Back back = there_and_back(scene, folder.path() / "there" / name);
    EXPECT_TRUE(back.losses.losses.empty());
    ASSERT_EQ(back.scene.materials.size(), 2u);
    EXPECT_FALSE(back.scene.materials[0].base_colour_texture);
    ASSERT_TRUE(back.scene.materials[1].base_colour_texture);
    const Texture& found = *back.scene.materials[1].base_colour_texture;
    EXPECT_EQ(found.wrap_u, Wrap::clamp);
    EXPECT_EQ(found.wrap_v, Wrap::mirror);
    EXPECT_TRUE(found.nearest);
    for (int row = 0; row < 2; ++row)
      for (int column = 0; column < 3; ++column) EXPECT_NEAR(found.uv_transform[row][column], texture.uv_transform[row][column], 1e-12);
  }
}

// The nearest spot of a flat light has its flux and its intensity along the axis; the nearest point of a sphere its intensity.
TEST(GltfScene, AreaLightsKeepTheirFluxAndTheirAxis) {
  const Folder folder;
  for (const bool two_sided : {false, true}) {
    Scene scene;
    scene.lights.push_back(lamp("panel", RectShape{1.2, 0.6}, Emission::Given::flux, 1500));
    scene.lights.back().two_sided = two_sided;
    const Back back = there_and_back(scene, folder.path() / "out.glb");
    ASSERT_EQ(back.scene.lights.size(), two_sided ? 2u : 1u);
    double flux = 0;
    for (const Light& light : back.scene.lights) {
      const auto resolved = resolve(light);
      ASSERT_TRUE(resolved);
      flux += resolved->flux_lm;
      EXPECT_LT(nearly(resolved->rgb.x, 1500 / (two_sided ? 2 : 1) / pi), 1e-12);
    }
    EXPECT_LT(nearly(flux, 1500), 1e-12);
    EXPECT_TRUE(says(back.losses, "light 'panel': a rectangle"));
  }
  Scene scene;
  scene.lights.push_back(lamp("globe", SphereShape{0.03}, Emission::Given::flux, 1500));
  scene.lights.push_back(lamp("window", FrustumShape{1.2, 0.7}, Emission::Given::flux, 1500));
  scene.lights.push_back(lamp("tube", TubeShape{1.2, 0.02, Caps::flat}, Emission::Given::flux, 1500));
  scene.lights.push_back(lamp("line", LineShape{1.2}, Emission::Given::flux, 1500));
  const Back back = there_and_back(scene, folder.path() / "out.glb");
  ASSERT_EQ(back.scene.lights.size(), 4u);
  // The frustum's cone has a ramp of a millionth of its angle.
  for (const Light& light : back.scene.lights) EXPECT_LT(nearly(resolve(light)->flux_lm, 1500), 4e-6) << light.name;
}

// With its shape beside it, a lamp comes back as one light, of the luminance and flux that it had.
TEST(GltfScene, ALampWithItsShapeCountsOnce) {
  const Folder folder;
  const PolygonShape polygon{{{-0.5, -0.4}, {0.6, -0.3}, {0.2, 0.5}}};
  const std::pair<const char*, Shape> shapes[] = {{"rect", RectShape{1.2, 0.6}},
                                                  {"disk", DiskShape{0.3}},
                                                  {"sphere", SphereShape{0.1}},
                                                  {"polygon", polygon},
                                                  {"tube", TubeShape{1, 0.05, Caps::round}}};
  for (const auto& [name, shape] : shapes) {
    for (const bool two_sided : {false, true}) {
      Scene scene;
      scene.lights.push_back(lamp(name, shape, Emission::Given::luminance, 5000));
      scene.lights.back().colour = RgbColour{{1, 0.8, 0.5}};
      scene.lights.back().two_sided = two_sided;
      const Back back = there_and_back(scene, folder.path() / "out.glb", LightShapes::emissive);
      ASSERT_EQ(back.scene.lights.size(), 1u) << name;
      EXPECT_TRUE(counted_once(back.diagnostics));
      const Light& light = back.scene.lights[0];
      EXPECT_EQ(light.name, name);
      ASSERT_TRUE(std::holds_alternative<MeshShape>(light.shape));
      const auto before = resolve(scene.lights[0]), after = resolve(light, mesh_area_of(back.scene, light));
      ASSERT_TRUE(before && after);
      for (int c = 0; c < 3; ++c) EXPECT_LT(nearly(after->rgb[c], before->rgb[c]), 1e-12) << name;
      // A sphere of 128 x 64 quads has .1 % less surface than the true one.
      EXPECT_LT(nearly(after->flux_lm, before->flux_lm), 1.5e-3) << name;
    }
  }
}

// The same with a mesh that sends a hundredth of what its light does, or a hundred times as much.
TEST(GltfScene, AMeshThatOnlyLooksLikeItsLightIsNoLight) {
  const Folder folder;
  Scene scene;
  scene.lights.push_back(lamp("globe", SphereShape{0.1}, Emission::Given::luminance, 5000));
  const fs::path file = folder.path() / "out.gltf";
  ASSERT_TRUE(make_gltf_exporter(LightShapes::emissive)->write(scene, file, {}));
  for (const double times : {0.01, 100.0}) {
    std::ifstream stream(file);
    nlohmann::ordered_json document = nlohmann::ordered_json::parse(stream);
    document["materials"][0]["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 5000 * times;
    const fs::path other = folder.write("other.gltf", document.dump());
    const auto imported = make_gltf_importer(GltfMaterials::all)->read(other, {});
    ASSERT_TRUE(imported);
    EXPECT_TRUE(counted_once(imported->diagnostics));
    EXPECT_EQ(imported->scene.lights.size(), times < 1 ? 1u : 2u);
    EXPECT_EQ(imported->scene.objects.size(), times < 1 ? 1u : 0u);
    if (times < 1) {
      EXPECT_TRUE(std::holds_alternative<PointShape>(imported->scene.lights[0].shape));
    }
  }
}

// A lamp above an emissive floor is not in its middle.
TEST(GltfScene, ALightElsewhereIsAnotherLamp) {
  const Folder folder;
  Scene scene;
  scene.lights.push_back(lamp("panel", RectShape{1.2, 0.6}, Emission::Given::flux, 1500));
  scene.lights.push_back(lamp("bulb", PointShape{}, Emission::Given::flux, 1500));
  scene.lights[1].transform.translation += Vec3d{0, 0.8, 0};
  const Back back = there_and_back(scene, folder.path() / "out.glb", LightShapes::emissive);
  ASSERT_EQ(back.scene.lights.size(), 2u);
  double flux = 0;
  for (const Light& light : back.scene.lights) flux += resolve(light, mesh_area_of(back.scene, light))->flux_lm;
  EXPECT_LT(nearly(flux, 3000), 1e-6);
}

TEST(GltfScene, WhatHasNoPlaceInTheFormatIsNamed) {
  const Folder folder;
  Scene scene;
  scene.lights.push_back(lamp("sky", EnvironmentShape{}, Emission::Given::luminance, 1000));
  scene.lights.push_back(lamp("window", PointShape{}, Emission::Given::flux, 800));
  scene.lights.back().range_m = 4;
  scene.lights.back().falloff = Falloff::frostbite;
  scene.lights.push_back(lamp("laser", PointShape{}, Emission::Given::flux, 800));
  scene.lights.back().colour = RgbColour{{-0.1, 1, 0.2}};
  const Back back = there_and_back(scene, folder.path() / "out.glb");
  EXPECT_EQ(back.scene.lights.size(), 2u);
  EXPECT_TRUE(says(back.losses, "light 'sky': an environment"));
  // Frostbite's window at half the range is (1 - 1/16)^2, glTF's 1 - 1/16.
  EXPECT_TRUE(says(back.losses, "light 'window': the falloff 'frostbite'"));
  EXPECT_TRUE(says(back.losses, "light 'laser': a colour outside Rec.709"));
  EXPECT_LT(nearly(resolve(back.scene.lights[1])->flux_lm, 800), 1e-12);
}

TEST(GltfScene, ABadSceneIsRefused) {
  const Folder folder;
  Scene scene;
  scene.objects.push_back({"thing", PlaneGeometry{1}, 7, {}, ""});
  const auto exported = make_gltf_exporter()->write(scene, folder.path() / "out.glb", {});
  ASSERT_FALSE(exported);
  EXPECT_EQ(exported.error().code, "SCENE_INVALID");
  EXPECT_FALSE(fs::exists(folder.path() / "out.glb"));
}

}  // namespace
}  // namespace etendue
