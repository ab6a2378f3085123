// glTF documents written again: as they stood, in the other container, with other materials.
#include "exporters/gltf/gltf.h"

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <iterator>

#include "etendue/material_conversion.h"
#include "exporters/gltf/json_edit.h"
#include "gltf_builder.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;
using test::Folder;
using test::GltfBuilder;
using Json = nlohmann::ordered_json;

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

Scene read(const fs::path& file) {
  auto imported = make_gltf_importer(GltfMaterials::all)->read(file, {});
  EXPECT_TRUE(imported) << imported.error().text;
  for (const Diagnostic& d : imported->diagnostics.all()) EXPECT_NE(d.severity, Severity::error) << to_string(d);
  return std::move(imported->scene);
}

std::vector<fs::path> write(const Scene& scene, const fs::path& file) {
  auto exported = make_gltf_exporter()->write(scene, file, {});
  EXPECT_TRUE(exported) << exported.error().text;
  return exported ? exported->files : std::vector<fs::path>{};
}

std::string u32(std::size_t value) {
  std::string out;
  for (int i = 0; i < 4; ++i) out += static_cast<char>(value >> 8 * i & 0xFF);
  return out;
}

// Of a GLB's JSON text and binary chunk.
std::pair<std::string, std::string> chunks(const std::string& glb) {
  const auto number = [&](std::size_t at) {
    std::size_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(glb[at + i]);
    return value;
  };
  EXPECT_EQ(number(8), glb.size());
  const std::size_t json = number(12), binary = 20 + json;
  return {glb.substr(20, json), binary < glb.size() ? glb.substr(binary + 8, number(binary)) : std::string()};
}

// A triangle with a specular-glossiness material that has two pictures of its own, a variant that no surface shows, extras and an
// animation, as a GLB whose last view belongs to the geometry.
std::string glb(bool with_unknown_extension = false) {
  GltfBuilder gltf;
  gltf.triangle();
  const int diffuse = gltf.view(test::png()), gloss = gltf.view(test::png());
  const int times = gltf.floats({0, 0, 0, 1, 0, 0}, "VEC3");
  gltf.primitive()["attributes"]["NORMAL"] = gltf.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  gltf.primitive()["attributes"]["TEXCOORD_0"] = gltf.floats({0, 0, 1, 0, 0, 1}, "VEC2");
  gltf.primitive()["material"] = 0;
  static_cast<void>(times);
  gltf.json["images"] =
      test::Json::array({{{"bufferView", diffuse}, {"mimeType", "image/png"}}, {{"bufferView", gloss}, {"mimeType", "image/png"}}});
  gltf.json["samplers"] = test::Json::array({{{"wrapS", 33071}}});
  gltf.json["textures"] = test::Json::array({{{"source", 0}, {"sampler", 0}}, {{"source", 1}, {"sampler", 0}}});
  const Json model = {{"diffuseTexture", {{"index", 0}}}, {"specularGlossinessTexture", {{"index", 1}}}};
  gltf.json["materials"] = test::Json::array(
      {{{"name", "shown"}, {"extras", {{"mine", 0.10}}}, {"extensions", {{"KHR_materials_pbrSpecularGlossiness", model}}}},
       {{"name", "variant"}, {"extensions", {{"KHR_materials_pbrSpecularGlossiness", {{"specularFactor", {0.2, 0.1, 0.1}}}}}}}});
  gltf.json["extensionsUsed"] = test::Json::array({"KHR_materials_pbrSpecularGlossiness"});
  gltf.json["extensionsRequired"] = test::Json::array({"KHR_materials_pbrSpecularGlossiness"});
  if (with_unknown_extension) gltf.json["extensionsUsed"].push_back("XYZ_of_somebody");
  gltf.json["extras"] = {{"kept", "as it is"}};
  while (gltf.bytes.size() % 4 != 0) gltf.bytes.push_back(0);
  gltf.json["buffers"] = test::Json::array({{{"byteLength", gltf.bytes.size()}}});
  std::string json = gltf.json.dump(2);
  while (json.size() % 4 != 0) json += ' ';
  return "glTF" + u32(2) + u32(28 + json.size() + gltf.bytes.size()) + u32(json.size()) + "JSON" + json + u32(gltf.bytes.size()) +
         std::string("BIN\0", 4) + std::string(gltf.bytes.begin(), gltf.bytes.end());
}

TEST(JsonEdit, WhatDidNotChangeKeepsItsBytes) {
  const std::string text = "{ \"a\" : 1.50,\n  \"list\": [1e0,2 , {\"x\":\t\"\\u00e9,}\"}],\n  \"gone\": null, \"b\": {}\n}";
  const Json before = Json::parse(text);
  Json now = before;
  now["list"].push_back(4);
  now.erase("gone");
  now["new"] = {{"y", 1}};
  const std::string out = gltf::edited(text, before, now);
  EXPECT_EQ(Json::parse(out), now);
  EXPECT_NE(out.find("\"a\" : 1.50"), std::string::npos);
  EXPECT_NE(out.find("[1e0,2, {\"x\":\t\"\\u00e9,}\"}, 4]"), std::string::npos) << out;
  EXPECT_EQ(gltf::edited(text, before, before), text);
}

TEST(GltfExport, WithoutAConversionAGlbKeepsItsBytes) {
  const Folder folder;
  const auto in = folder.write("in.glb", glb());
  write(read(in), folder.path() / "out.glb");
  EXPECT_EQ(content(folder.path() / "out.glb"), content(in));
}

TEST(GltfExport, ThroughAGltfAndBackItSaysTheSame) {
  const Folder folder;
  const auto in = folder.write("in.glb", glb());
  const auto files = write(read(in), folder.path() / "text" / "a b.gltf");
  EXPECT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0].filename(), "a b.gltf");
  write(read(files[0]), folder.path() / "out.glb");
  const auto [json, binary] = chunks(content(folder.path() / "out.glb"));
  const auto [old_json, old_binary] = chunks(content(in));
  EXPECT_EQ(Json::parse(json), Json::parse(old_json));
  EXPECT_EQ(binary, old_binary);
}

TEST(GltfExport, PicturesAndBuffersOfAGltfBecomeOneChunk) {
  const Folder folder;
  GltfBuilder gltf;
  gltf.triangle();
  gltf.json["images"] = test::Json::array({{{"uri", "my%20picture.png"}}});
  gltf.json["textures"] = test::Json::array({{{"source", 0}}});
  gltf.json["materials"] = test::Json::array({{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
  gltf.primitive()["attributes"]["TEXCOORD_0"] = gltf.floats({0, 0, 1, 0, 0, 1}, "VEC2");
  gltf.primitive()["material"] = 0;
  const auto png = test::png();
  folder.write("my picture.png", std::string(png.begin(), png.end()));
  const auto in = folder.write("in.gltf", gltf.text());
  write(read(in), folder.path() / "out" / "all.glb");
  const Scene scene = read(folder.path() / "out" / "all.glb");
  ASSERT_EQ(scene.images.size(), 1u);
  ASSERT_TRUE(scene.images[0].embedded);
  EXPECT_TRUE(std::equal(png.begin(), png.end(), scene.images[0].embedded.begin(), scene.images[0].embedded.end()));
  EXPECT_EQ(scene.meshes[0].positions.size(), 3u);
}

TEST(GltfExport, ConvertedMaterialsAreReadBackAsTheSceneHasThem) {
  for (const char* name : {"out.glb", "out.gltf"}) {
    const Folder folder;
    const auto in = folder.write("in.glb", glb());
    Scene scene = read(in);
    ASSERT_EQ(scene.materials.size(), 2u);
    ASSERT_TRUE(convert_materials(scene, {MaterialModel::metal_rough, 8, folder.path() / "new", 1, nullptr}));
    write(scene, folder.path() / "there" / name);
    const Scene back = read(folder.path() / "there" / name);
    ASSERT_EQ(back.materials.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      const auto &a = std::get<MetalRough>(scene.materials[i].model), &b = std::get<MetalRough>(back.materials[i].model);
      EXPECT_EQ(a.base_colour, b.base_colour);
      EXPECT_EQ(a.metallic, b.metallic);
      EXPECT_EQ(a.roughness, b.roughness);
      ASSERT_EQ(scene.materials[i].lobes.specular.has_value(), back.materials[i].lobes.specular.has_value());
      if (back.materials[i].lobes.specular) {
        EXPECT_EQ(scene.materials[i].lobes.specular->colour, back.materials[i].lobes.specular->colour);
      }
    }
    // Positions lay before the pictures that are gone, normals behind them.
    EXPECT_EQ(back.meshes[0].positions.size(), 3u);
    EXPECT_EQ(back.meshes[0].normals[2], (Vec3f{0, 0, 1}));
    const Json document = Json::parse(std::string(back.carried.document.begin(), back.carried.document.end()));
    EXPECT_EQ(document["extras"]["kept"], "as it is");
    EXPECT_EQ(document["materials"][0]["extras"]["mine"], 0.10);
    EXPECT_FALSE(document.contains("extensionsRequired"));
    EXPECT_EQ(document["extensionsUsed"], Json::array({"KHR_materials_specular"}));
  }
}

TEST(GltfExport, PicturesThatNobodyUsesGoUnlessUnknownExtensionsMayReferToThem) {
  for (const bool unknown : {false, true}) {
    const Folder folder;
    const auto in = folder.write("in.glb", glb(unknown));
    Scene scene = read(in);
    // Its pictures are all one colour: no new ones are needed.
    ASSERT_TRUE(convert_materials(scene, {MaterialModel::metal_rough, 8, folder.path() / "new", 1, nullptr}));
    auto exported = make_gltf_exporter()->write(scene, folder.path() / "out.glb", {});
    ASSERT_TRUE(exported);
    const auto [json, binary] = chunks(content(folder.path() / "out.glb"));
    const Json document = Json::parse(json);
    EXPECT_EQ(unknown, !exported->losses.losses.empty());
    EXPECT_EQ(document.value("images", Json::array()).size() >= 2, unknown);
  }
}

TEST(GltfExport, AnotherFileOfTheSameNameIsNotReplaced) {
  const Folder folder;
  GltfBuilder gltf;
  gltf.triangle();
  folder.write("data.bin", std::string(gltf.bytes.begin(), gltf.bytes.end()));
  gltf.json["buffers"] = test::Json::array({{{"byteLength", gltf.bytes.size()}, {"uri", "data.bin"}}});
  const auto in = folder.write("in.gltf", gltf.json.dump());
  folder.write("out/data.bin", "something else");
  const auto exported = make_gltf_exporter()->write(read(in), folder.path() / "out" / "in.gltf", {});
  ASSERT_FALSE(exported);
  EXPECT_EQ(exported.error().code, "FILE_UNWRITABLE");
  EXPECT_EQ(content(folder.path() / "out" / "data.bin"), "something else");
  EXPECT_FALSE(fs::exists(folder.path() / "out" / "in.gltf"));
}

// Of a picture that no texture refers to any more no byte stays, in the binary chunk or in a file beside it.
TEST(GltfExport, BytesOfPicturesThatAreGoneGoWithThem) {
  const auto png = test::png();
  const std::string picture(png.begin(), png.end());
  for (const bool from_text : {false, true}) {
    for (const char* name : {"out.glb", "out.gltf"}) {
      const Folder folder;
      fs::path in = folder.write("in/in.glb", glb());
      if (from_text) in = write(read(in), folder.path() / "in" / "in.gltf")[0];
      Scene scene = read(in);
      ASSERT_TRUE(convert_materials(scene, {MaterialModel::metal_rough, 8, folder.path() / "new", 1, nullptr}));
      std::size_t left = 0;
      const auto files = write(scene, folder.path() / "there" / name);
      for (const fs::path& file : files) left += content(file).find(picture) != std::string::npos;
      EXPECT_EQ(left, 0u) << in << ' ' << name;
      const Scene back = read(files[0]);
      EXPECT_EQ(back.meshes[0].positions, scene.meshes[0].positions);
      EXPECT_EQ(back.meshes[0].normals, scene.meshes[0].normals);
      EXPECT_EQ(back.meshes[0].uvs, scene.meshes[0].uvs);
    }
  }
}

// A file that cannot be written last: what was there before stays, and nothing new comes beside it.
TEST(GltfExport, AFailedExportLeavesWhatWasThere) {
  const Folder folder;
  const auto in = folder.write("in.glb", glb());
  folder.write("there/out.bin", "old");
  fs::create_directories(folder.path() / "there" / ".out.gltf.part");  // where the named file would be made
  folder.write("there/.out.gltf.part/x", "");
  const auto exported = make_gltf_exporter()->write(read(in), folder.path() / "there" / "out.gltf", {});
  ASSERT_FALSE(exported);
  EXPECT_EQ(content(folder.path() / "there" / "out.bin"), "old");
  EXPECT_FALSE(fs::exists(folder.path() / "there" / ".out.bin.part"));
}

}  // namespace
}  // namespace etendue
