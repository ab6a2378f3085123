// The glTF importer on assets made here: geometry, transforms, lights, cameras, materials.
#include <cmath>

#include "gltf_builder.h"

namespace etendue::test {
namespace {

// glTF's numbers of the examples below are exact in double; products of a few of them round to 1e-15.
constexpr double rounding = 1e-14;

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance = rounding) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(GltfImport, TriangleInJson) {
  const Folder folder;
  GltfBuilder gltf;
  gltf.triangle();
  gltf.json["nodes"][0]["translation"] = {1, 2, 3};
  const auto imported = read_gltf(gltf, folder);
  ASSERT_TRUE(imported.ok());
  EXPECT_FALSE(imported->diagnostics.has_errors()) << all_text(imported->diagnostics);
  const Scene& scene = imported->scene;
  EXPECT_EQ(scene.format, "gltf");
  ASSERT_EQ(scene.objects.size(), 1u);
  ASSERT_EQ(scene.meshes.size(), 1u);
  const std::vector<Vec3f> expected = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(scene.meshes[0].positions, expected);
  EXPECT_EQ(scene.meshes[0].indices, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_TRUE(scene.meshes[0].normals.empty());
  EXPECT_EQ(scene.objects[0].name, "thing");
  EXPECT_EQ(scene.objects[0].source, "/nodes/0");
  expect_near(scene.objects[0].transform.point({0, 0, 0}), {1, 2, 3});
  EXPECT_FALSE(validate(scene).has_errors());
}

TEST(GltfImport, GlbAndFileAndDataUriGiveTheSameMesh) {
  const Folder folder;
  GltfBuilder gltf;
  gltf.triangle();
  const auto embedded = read_gltf(gltf, folder);
  const auto binary = read_gltf(folder.write("asset.glb", gltf.glb()));
  // A name that needs percent-encoding, in a folder below.
  folder.write("parts/a b.bin", std::string(gltf.bytes.begin(), gltf.bytes.end()));
  gltf.json["buffers"] = Json::array({{{"byteLength", gltf.bytes.size()}, {"uri", "parts/a%20b.bin"}}});
  const auto beside = read_gltf(gltf, folder);
  ASSERT_TRUE(embedded.ok() && binary.ok() && beside.ok());
  for (const auto* other : {&binary, &beside}) {
    EXPECT_FALSE((*other)->diagnostics.has_errors()) << all_text((*other)->diagnostics);
    ASSERT_EQ((*other)->scene.meshes.size(), 1u);
    EXPECT_EQ((*other)->scene.meshes[0].positions, embedded->scene.meshes[0].positions);
  }
  EXPECT_EQ(beside->stats.bytes_read, std::filesystem::file_size(folder.path() / "asset.gltf") + gltf.bytes.size());
}

TEST(GltfImport, IndicesOfEveryType) {
  for (const int size : {1, 2, 4}) {
    const Folder folder;
    GltfBuilder gltf;
    gltf.triangle();
    gltf.primitive()["indices"] = size == 1   ? gltf.indices<std::uint8_t>({2, 0, 1})
                                  : size == 2 ? gltf.indices<std::uint16_t>({2, 0, 1})
                                              : gltf.indices<std::uint32_t>({2, 0, 1});
    const auto imported = read_gltf(gltf, folder);
    ASSERT_TRUE(imported.ok());
    ASSERT_EQ(imported->scene.meshes.size(), 1u) << all_text(imported->diagnostics);
    EXPECT_EQ(imported->scene.meshes[0].indices, (std::vector<std::uint32_t>{2, 0, 1}));
  }
}

// A unit square as strip and as fan: both must face +Z everywhere and have area 1.
TEST(GltfImport, StripsAndFansKeepTheirFront) {
  for (const int mode : {5, 6}) {
    const Folder folder;
    GltfBuilder gltf;
    gltf.triangle();
    const std::vector<float> strip = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, fan = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    gltf.primitive()["attributes"]["POSITION"] = gltf.floats(mode == 5 ? strip : fan, "VEC3");
    gltf.primitive()["mode"] = mode;
    const auto imported = read_gltf(gltf, folder);
    ASSERT_TRUE(imported.ok());
    ASSERT_EQ(imported->scene.meshes.size(), 1u);
    const Mesh& mesh = imported->scene.meshes[0];
    ASSERT_EQ(mesh.indices.size(), 6u);
    EXPECT_NEAR(area_of(mesh, {}), 1, 1e-7);
    for (std::size_t t = 0; t < 6; t += 3) {
      const Vec3f a = mesh.positions[mesh.indices[t]], b = mesh.positions[mesh.indices[t + 1]], c = mesh.positions[mesh.indices[t + 2]];
      EXPECT_GT(cross(b - a, c - a).z, 0);
    }
  }
}

TEST(GltfImport, InterleavedNormalisedAndSparseAccessors) {
  const Folder folder;
  GltfBuilder gltf;
  gltf.triangle();
  // Position (12 bytes) and normal (12 bytes) interleaved at 24; the normals are longer than 1.
  const std::vector<float> vertices = {0, 0, 0, 0, 0, 2, 1, 0, 0, 0, 0, 2, 0, 1, 0, 0, 0, 2};
  const int view = gltf.view(vertices);
  gltf.json["bufferViews"][static_cast<std::size_t>(view)]["byteStride"] = 24;
  auto& attributes = gltf.primitive()["attributes"];
  const Json vec3 = {{"bufferView", view}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}};
  Json normal = vec3;
  normal["byteOffset"] = 12;
  attributes["NORMAL"] = gltf.accessor(normal);
  // The third vertex moves to (0, 4, 0) by a sparse substitution.
  Json sparse = vec3;
  sparse["sparse"] = {{"count", 1},
                      {"indices", {{"bufferView", gltf.view<std::uint8_t>({2})}, {"componentType", 5121}}},
                      {"values", {{"bufferView", gltf.view<float>({0, 4, 0})}}}};
  attributes["POSITION"] = gltf.accessor(sparse);
  attributes["TEXCOORD_0"] = gltf.accessor({{"bufferView", gltf.view<std::uint16_t>({0, 65535, 65535, 0, 32768, 13107})},
                                            {"componentType", 5123},
                                            {"normalized", true},
                                            {"count", 3},
                                            {"type", "VEC2"}});
  const auto imported = read_gltf(gltf, folder);
  ASSERT_TRUE(imported.ok());
  ASSERT_EQ(imported->scene.meshes.size(), 1u) << all_text(imported->diagnostics);
  const Mesh& mesh = imported->scene.meshes[0];
  EXPECT_EQ(mesh.positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 4, 0}}));
  EXPECT_EQ(mesh.normals, (std::vector<Vec3f>(3, {0, 0, 1})));
  ASSERT_EQ(mesh.uvs.size(), 3u);
  EXPECT_EQ(mesh.uvs[0], (Vec2f{0, 1}));
  EXPECT_FLOAT_EQ(mesh.uvs[2].x, 32768.0F / 65535.0F);
  EXPECT_FLOAT_EQ(mesh.uvs[2].y, 0.2F);
}

TEST(GltfImport, NodesMultiplyDownTheTree) {
  const Folder folder;
  GltfBuilder gltf;
  gltf.triangle();
  const double h = std::sqrt(0.5);
  // A quarter turn about +Y takes +X to -Z; the child's matrix is a translation.
  gltf.json["nodes"] = Json::array({{{"children", {1}}, {"rotation", {0, h, 0, h}}, {"scale", {2, 2, 2}}, {"translation", {0, 5, 0}}},
                                    {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 0, 0, 1}}}});
  const auto imported = read_gltf(gltf, folder);
  ASSERT_TRUE(imported.ok());
  ASSERT_EQ(imported->scene.objects.size(), 1u) << all_text(imported->diagnostics);
  expect_near(imported->scene.objects[0].transform.point({1, 0, 0}), {0, 5, -8});
}

GltfBuilder with_punctual(const Json& light) {
  GltfBuilder gltf;
  gltf.json["extensionsUsed"] = {"KHR_lights_punctual"};
  gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({light});
  gltf.json["nodes"] = Json::array(
      {{{"name", "lamp"}, {"translation", {0, 3, 0}}, {"scale", {2, 3, 4}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}});
  return gltf;
}

// KHR_lights_punctual: the light sends out intensity x colour, channel by channel, in candela.
TEST(GltfImport, PointLightIsIntensityTimesColour) {
  const Folder folder;
  const auto imported =
      read_gltf(with_punctual({{"type", "point"}, {"intensity", 100}, {"color", {1, 0.5, 0.25}}, {"range", 8}, {"name", "bulb"}}), folder);
  ASSERT_TRUE(imported.ok());
  ASSERT_EQ(imported->scene.lights.size(), 1u) << all_text(imported->diagnostics);
  const Light& light = imported->scene.lights[0];
  EXPECT_EQ(light.name, "bulb");
  EXPECT_EQ(light.range_m, 8);
  EXPECT_EQ(light.falloff, Falloff::gltf);
  const auto resolved = resolve(light);
  ASSERT_TRUE(resolved.ok());
  EXPECT_EQ(resolved->kind, Resolved::Kind::intensity);
  expect_near(resolved->rgb, {100, 50, 25}, 1e-12);
  EXPECT_FALSE(validate(imported->scene).has_errors()) << all_text(validate(imported->scene));
}

// 54 from Blender's unitless mode is a lamp of 680 W without the 683 lm/W: read as written, with a warning.
TEST(GltfImport, UnitlessLightsOfBlenderWarn) {
  const Folder folder;
  GltfBuilder gltf = with_punctual({{"type", "point"}, {"intensity", 54}});
  const auto warned = [&] {
    const auto imported = read_gltf(gltf, folder);
    EXPECT_EQ(imported->scene.lights.at(0).emission.value, gltf.json["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"]);
    return all_text(imported->diagnostics).find("LIGHTS_LOOK_UNITLESS") != std::string::npos;
  };
  EXPECT_FALSE(warned());
  gltf.json["asset"]["generator"] = "Khronos glTF Blender I/O v4.0.44";
  EXPECT_TRUE(warned());
  gltf.json["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = 54351.4;
  EXPECT_FALSE(warned());
}

TEST(GltfImport, SpotPointsAlongMinusZWithoutScale) {
  const Folder folder;
  GltfBuilder gltf = with_punctual({{"type", "spot"}, {"intensity", 10}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}});
  const double h = std::sqrt(0.5);
  gltf.json["nodes"][0]["rotation"] = {-h, 0, 0, h};  // -Z turns to -Y
  const auto imported = read_gltf(gltf, folder);
  ASSERT_TRUE(imported.ok());
  ASSERT_EQ(imported->scene.lights.size(), 1u) << all_text(imported->diagnostics);
  const Light& light = imported->scene.lights[0];
  EXPECT_EQ(light.name, "lamp");
  expect_near(light.transform.vector({0, 0, -1}), {0, -1, 0});
  EXPECT_NEAR(light.transform.determinant(), 1, rounding);
  EXPECT_EQ(light.falloff, Falloff::inverse_square);
  const auto* spot = std::get_if<SpotShape>(&light.shape);
  ASSERT_NE(spot, nullptr);
  EXPECT_EQ(spot->inner_rad, 0.25);
  EXPECT_EQ(spot->outer_rad, 0.5);
}

// 5e9 needs more than 32 bits, in which tinygltf keeps integers of extensions.
TEST(GltfImport, DirectionalLightIsInLux) {
  const Folder folder;
  const auto imported = read_gltf(with_punctual({{"type", "directional"}, {"intensity", 5000000000}}), folder);
  ASSERT_TRUE(imported.ok());
  ASSERT_EQ(imported->scene.lights.size(), 1u);
  const auto resolved = resolve(imported->scene.lights[0]);
  ASSERT_TRUE(resolved.ok());
  EXPECT_EQ(resolved->kind, Resolved::Kind::illuminance);
  expect_near(resolved->rgb, {5e9, 5e9, 5e9}, 1e-3);
}

// EXT_lights_area: size is the height or the diameter, times the largest scale of the node; flux = luminance x area x pi.
TEST(GltfImport, AreaLights) {
  const Folder folder;
  GltfBuilder gltf;
  gltf.json["extensionsUsed"] = {"EXT_lights_area"};
  gltf.json["extensions"]["EXT_lights_area"]["lights"] = Json::array(
      {{{"type", "rect"}, {"intensity", 1500}, {"size", 0.5}, {"rect", {{"aspect", 4}}}, {"name", "panel"}}, {{"type", "disk"}}});
  gltf.json["nodes"] = Json::array({{{"scale", {1, -2, 1}}, {"extensions", {{"EXT_lights_area", {{"light", 0}}}}}},
                                    {{"extensions", {{"EXT_lights_area", {{"light", 1}}}}}}});
  gltf.json["scenes"][0]["nodes"] = {0, 1};
  const auto imported = read_gltf(gltf, folder);
  ASSERT_TRUE(imported.ok());
  ASSERT_EQ(imported->scene.lights.size(), 2u) << all_text(imported->diagnostics);
  const auto* rect = std::get_if<RectShape>(&imported->scene.lights[0].shape);
  ASSERT_NE(rect, nullptr);
  EXPECT_DOUBLE_EQ(rect->width, 4);
  EXPECT_DOUBLE_EQ(rect->height, 1);
  const auto resolved = resolve(imported->scene.lights[0]);
  ASSERT_TRUE(resolved.ok());
  EXPECT_NEAR(resolved->flux_lm, 1500 * 4 * pi, 1e-8);
  const auto* disk = std::get_if<DiskShape>(&imported->scene.lights[1].shape);
  ASSERT_NE(disk, nullptr);
  EXPECT_DOUBLE_EQ(disk->radius, 0.5);
  EXPECT_EQ(imported->scene.lights[1].emission.value, 1000);
}

TEST(GltfImport, CameraUnderAScaledNode) {
  const Folder folder;
  GltfBuilder gltf;
  gltf.json["cameras"] = Json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}, {"aspectRatio", 1.5}}}},
                                      {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 9}, {"znear", 1}}}}});
  gltf.json["nodes"] = Json::array({{{"camera", 0}, {"scale", {-2, 2, 2}}, {"children", {1}}}, {{"camera", 1}}});
  const auto imported = read_gltf(gltf, folder);
  ASSERT_TRUE(imported.ok());
  ASSERT_EQ(imported->scene.cameras.size(), 1u);
  const Camera& camera = imported->scene.cameras[0];
  EXPECT_EQ(camera.vfov_rad, 0.7);
  EXPECT_EQ(camera.aspect, 1.5);
  EXPECT_NEAR(camera.transform.determinant(), 1, rounding);
  expect_near(camera.transform.vector({0, 0, -1}), {0, 0, -1});
  EXPECT_TRUE(says(imported->diagnostics, Severity::warning, "NOT_REPRESENTED", "/cameras/1"));
}

TEST(GltfImport, MaterialsWithTexturesThatAreNotOpened) {
  const Folder folder;
  folder.write("pictures/not a picture.png", "nothing that decodes");
  GltfBuilder gltf;
  gltf.triangle();
  for (const char* set : {"TEXCOORD_0", "TEXCOORD_1"}) gltf.primitive()["attributes"][set] = gltf.floats({0, 0, 1, 0, 0, 1}, "VEC2");
  gltf.primitive()["material"] = 0;
  const int inside = gltf.view(png());
  gltf.json["images"] = Json::array({{{"uri", "pictures/not%20a%20picture.png"}},
                                     {{"bufferView", inside}, {"mimeType", "image/png"}},
                                     {{"uri", png_uri()}},
                                     {{"uri", "../unused.png"}}});
  gltf.json["samplers"] = Json::array({{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}});
  gltf.json["textures"] = Json::array({{{"source", 0}, {"sampler", 0}}, {{"source", 1}}, {{"source", 2}}});
  gltf.json["materials"] = Json::parse(R"([{
    "name": "painted", "doubleSided": true, "alphaMode": "MASK", "alphaCutoff": 0.25,
    "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.125, 0.75], "metallicFactor": 0.2, "roughnessFactor": 0.4,
      "baseColorTexture": {"index": 0, "texCoord": 0, "extensions": {"KHR_texture_transform":
        {"offset": [0, 1], "rotation": 1.5707963267948966, "scale": [0.5, 0.5], "texCoord": 1}}},
      "metallicRoughnessTexture": {"index": 1, "texCoord": 1}},
    "normalTexture": {"index": 2, "texCoord": 1, "scale": 0.5},
    "extensions": {"KHR_materials_ior": {"ior": 1.33}, "KHR_materials_clearcoat": {"clearcoatFactor": 1}}}])");
  gltf.json["extensionsUsed"] = {"KHR_texture_transform", "KHR_materials_ior", "KHR_materials_clearcoat"};
  const auto imported = read_gltf(gltf, folder);
  ASSERT_TRUE(imported.ok());
  EXPECT_FALSE(imported->diagnostics.has_errors()) << all_text(imported->diagnostics);
  const Scene& scene = imported->scene;
  ASSERT_EQ(scene.materials.size(), 1u);
  const Material& material = scene.materials[0];
  const auto* model = std::get_if<MetalRough>(&material.model);
  ASSERT_NE(model, nullptr);
  EXPECT_EQ(model->base_colour, (Rgb{0.5, 0.25, 0.125}));
  EXPECT_EQ(model->metallic, 0.2);
  EXPECT_EQ(model->roughness, 0.4);
  EXPECT_EQ(model->ior, 1.33);
  EXPECT_EQ(material.base_alpha, 0.75);
  EXPECT_EQ(material.alpha_cutoff, 0.25);
  EXPECT_TRUE(material.double_sided);

  ASSERT_TRUE(material.base_colour_texture && material.metal_rough_texture && material.normal_map);
  const Texture& base = *material.base_colour_texture;
  EXPECT_EQ(base.encoding, Encoding::srgb);
  EXPECT_EQ(base.wrap_u, Wrap::clamp);
  EXPECT_EQ(base.wrap_v, Wrap::mirror);
  EXPECT_TRUE(base.nearest);
  EXPECT_EQ(base.uv_set, 1);
  // The extension's own example: the lower left quadrant (u from 0 to .5, v from .5 to 1), turned by a quarter.
  const auto at = [&](double u, double v, int row) {
    return base.uv_transform[row][0] * u + base.uv_transform[row][1] * v + base.uv_transform[row][2];
  };
  EXPECT_NEAR(at(0, 0, 0), 0, rounding);
  EXPECT_NEAR(at(0, 0, 1), 1, rounding);
  EXPECT_NEAR(at(1, 1, 0), 0.5, rounding);
  EXPECT_NEAR(at(1, 1, 1), 0.5, rounding);
  EXPECT_EQ(material.metal_rough_texture->encoding, Encoding::linear);
  EXPECT_EQ(material.normal_map->scale, 0.5);
  EXPECT_EQ(material.normal_map->texture.encoding, Encoding::linear);

  ASSERT_EQ(scene.images.size(), 3u);
  EXPECT_EQ(scene.images[base.image].file, (folder.path() / "pictures/not a picture.png").string());
  EXPECT_FALSE(scene.images[base.image].embedded);
  ASSERT_TRUE(scene.images[1].embedded && scene.images[2].embedded);
  EXPECT_EQ(std::vector<std::uint8_t>(scene.images[1].embedded.begin(), scene.images[1].embedded.end()), png());
  EXPECT_EQ(std::vector<std::uint8_t>(scene.images[2].embedded.begin(), scene.images[2].embedded.end()), png());
  EXPECT_EQ(scene.images[2].mime_type, "image/png");
  EXPECT_EQ(imported->stats.images_decoded, 0u);
  EXPECT_EQ(scene.meshes[0].uvs.size(), 3u);  // TEXCOORD_1
  ASSERT_TRUE(material.lobes.clearcoat.has_value());
  EXPECT_EQ(material.lobes.clearcoat->factor, 1);
}

GltfBuilder glowing_triangle() {
  GltfBuilder gltf;
  gltf.triangle();
  gltf.primitive()["material"] = 0;
  gltf.json["extensionsUsed"] = {"KHR_materials_emissive_strength"};
  gltf.json["materials"] = Json::parse(R"([{"emissiveFactor": [1, 0.5, 0.25], "doubleSided": true,
    "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 2000}}}])");
  return gltf;
}

// KHR_materials_emissive_strength: factor x strength is in cd/m2. One light, which is the surface too: no object beside it.
TEST(GltfImport, EmissiveSurfaceIsALight) {
  const Folder folder;
  GltfBuilder gltf = glowing_triangle();
  gltf.json["nodes"][0]["scale"] = {2, 3, 1};
  const double h = std::sqrt(0.5);
  gltf.json["nodes"][0]["rotation"] = {0, h, 0, h};
  const auto imported = read_gltf(gltf, folder);
  ASSERT_TRUE(imported.ok());
  const Scene& scene = imported->scene;
  EXPECT_TRUE(scene.objects.empty());
  ASSERT_EQ(scene.lights.size(), 1u) << all_text(imported->diagnostics);
  const Light& light = scene.lights[0];
  const auto* shape = std::get_if<MeshShape>(&light.shape);
  ASSERT_NE(shape, nullptr);
  EXPECT_EQ(light.surface_material, 0u);
  EXPECT_TRUE(light.two_sided);
  expect_near(shape->scale, {2, 3, 1});
  EXPECT_NEAR(light.transform.determinant(), 1, rounding);
  // The mesh's corner (0, 1, 0) after scale and rotation; (1, 0, 0) goes to -Z.
  expect_near(light.transform.point(shape->scale * Vec3d{0, 1, 0}), {0, 3, 0});
  expect_near(light.transform.point(shape->scale * Vec3d{1, 0, 0}), {0, 0, -2});
  EXPECT_NEAR(mesh_area_of(scene, light), 3, 1e-12);
  const auto resolved = resolve(light, mesh_area_of(scene, light));
  ASSERT_TRUE(resolved.ok());
  expect_near(resolved->rgb, {2000, 1000, 500}, 1e-9);
  // Two sides of 3 m2 each: flux = pi L A.
  EXPECT_NEAR(resolved->flux_lm, pi * luminance_of({2000, 1000, 500}) * 6, 1e-6);
  EXPECT_FALSE(validate(scene).has_errors()) << all_text(validate(scene));
}

// A mirrored surface keeps its front: the triangle that faced +Z still does.
TEST(GltfImport, MirroredEmissiveSurfaceKeepsItsFront) {
  const Folder folder;
  GltfBuilder gltf = glowing_triangle();
  gltf.json["nodes"][0]["scale"] = {-1, 1, 1};
  const auto imported = read_gltf(gltf, folder);
  ASSERT_TRUE(imported.ok());
  ASSERT_EQ(imported->scene.lights.size(), 1u);
  const Light& light = imported->scene.lights[0];
  const auto* shape = std::get_if<MeshShape>(&light.shape);
  ASSERT_NE(shape, nullptr);
  EXPECT_EQ(light.transform, Transform{});
  const Mesh& mesh = imported->scene.meshes[shape->mesh];
  const Vec3f a = mesh.positions[mesh.indices[0]], b = mesh.positions[mesh.indices[1]], c = mesh.positions[mesh.indices[2]];
  EXPECT_GT(cross(b - a, c - a).z, 0);
  EXPECT_EQ(mesh.positions[1], (Vec3f{-1, 0, 0}));
}

// The sheared unit triangle has the base 1 and the height 1 still: area 1/2.
TEST(GltfImport, ShearedEmissiveSurfaceIsBaked) {
  const Folder folder;
  GltfBuilder gltf = glowing_triangle();
  gltf.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0.75, 1, 0, 0, 0, 0, 1, 0, 0, 0, 7, 1};
  const auto imported = read_gltf(gltf, folder);
  ASSERT_TRUE(imported.ok());
  ASSERT_EQ(imported->scene.lights.size(), 1u) << all_text(imported->diagnostics);
  const Light& light = imported->scene.lights[0];
  EXPECT_NEAR(mesh_area_of(imported->scene, light), 0.5, 1e-7);
  EXPECT_EQ(imported->scene.meshes[std::get<MeshShape>(light.shape).mesh].positions[2], (Vec3f{0.75F, 1, 7}));
}

TEST(GltfImport, LightsAloneTouchNoBuffer) {
  const Folder folder;
  GltfBuilder gltf = glowing_triangle();
  gltf.json["buffers"] = Json::array({{{"byteLength", 36}, {"uri", "missing.bin"}}});
  ImportOptions options;
  options.need = Need::lights;
  const auto imported = read_gltf(gltf, folder, options);
  ASSERT_TRUE(imported.ok());
  EXPECT_FALSE(imported->diagnostics.has_errors()) << all_text(imported->diagnostics);
  ASSERT_EQ(imported->scene.lights.size(), 1u);
  EXPECT_TRUE(imported->scene.meshes[0].positions.empty());
  EXPECT_TRUE(imported->scene.materials.empty());
  EXPECT_EQ(imported->stats.bytes_read, std::filesystem::file_size(folder.path() / "asset.gltf"));
  EXPECT_EQ(imported->stats.skipped_meshes, 1u);
  // All of it: now the buffer is asked for, and missed.
  const auto whole = read_gltf(gltf, folder);
  ASSERT_TRUE(whole.ok());
  EXPECT_TRUE(says(whole->diagnostics, Severity::error, "IO_ERROR", "/buffers/0/uri"));
}

TEST(GltfImport, WhatIsNotRepresentedIsNamed) {
  const Folder folder;
  GltfBuilder gltf;
  gltf.triangle();
  gltf.primitive()["mode"] = 1;
  gltf.json["scenes"].push_back({{"name", "other"}});
  gltf.json["extensionsUsed"] = {"ACME_magic"};
  gltf.json["nodes"][0]["extensions"]["ACME_magic"] = Json::object();
  gltf.json["nodes"][0]["colour"] = "red";
  const auto imported = read_gltf(gltf, folder);
  ASSERT_TRUE(imported.ok());
  EXPECT_TRUE(says(imported->diagnostics, Severity::warning, "NOT_REPRESENTED", "/meshes/0/primitives/0/mode"));
  EXPECT_TRUE(says(imported->diagnostics, Severity::warning, "NOT_REPRESENTED", "/scenes/1"));
  EXPECT_TRUE(says(imported->diagnostics, Severity::warning, "NOT_REPRESENTED", "/nodes/0/extensions/ACME_magic"));
  EXPECT_TRUE(says(imported->diagnostics, Severity::warning, "UNEXPECTED_PROPERTY", "/nodes/0/colour"));
  EXPECT_FALSE(imported->diagnostics.has_errors());
}

}  // namespace
}  // namespace etendue::test
