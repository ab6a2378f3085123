// Nothing silent: what a document says is represented, carried or named. The table that the importer follows is the one that is documented.
#include <algorithm>
#include <set>

#include "gltf_builder.h"
#include "importers/gltf/mapping.h"
#include "importers/gltf/schema.h"
#include "source_dir.h"

namespace etendue::test {
namespace {

namespace fs = std::filesystem;

// Every member of every "extensions" object, wherever it stands.
void collect_extensions(const Json& value, const std::string& pointer, std::vector<std::pair<std::string, std::string>>& found) {
  if (value.is_object()) {
    for (const auto& [key, member] : value.items()) {
      const std::string here = gltf::pointer_to(pointer, key);
      if (key == "extensions" && member.is_object())
        for (const auto& [name, content] : member.items()) found.emplace_back(name, gltf::pointer_to(here, name));
      collect_extensions(member, here, found);
    }
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) collect_extensions(value[i], pointer + "/" + std::to_string(i), found);
  }
}

bool is_carried(const Scene& scene, const std::string& pointer) {
  return std::any_of(scene.carried.parts.begin(), scene.carried.parts.end(),
                     [&](const std::string& part) { return pointer == part || pointer.starts_with(part + "/"); });
}
bool is_represented(const std::string& name) {
  const gltf::MappingRow* row = gltf::row_of_extension(name);
  return row != nullptr && row->actual_fate() == gltf::Fate::represented;
}

Json carried_document(const Scene& scene) {
  const SharedBytes& text = scene.carried.document;
  return Json::parse(text.begin(), text.end());
}

TEST(GltfCarried, EveryExtensionOfTheCorpusIsRepresentedCarriedOrNamed) {
  const fs::path corpus = source_dir() / ".." / "shared" / "corpus" / "gltf";
  if (!fs::exists(corpus)) GTEST_SKIP() << "../shared/corpus/gltf is not there";
  std::size_t occurrences = 0, carried = 0;
  for (const auto& entry : fs::recursive_directory_iterator(corpus)) {
    if (entry.path().extension() != ".gltf" && entry.path().extension() != ".glb") continue;
    const auto imported = read_gltf(entry.path());
    if (!imported.ok() || imported->diagnostics.has_errors()) continue;  // refused, which is not silent either
    SCOPED_TRACE(entry.path().string());
    const Json document = carried_document(imported->scene);
    std::vector<std::pair<std::string, std::string>> found;
    collect_extensions(document, "", found);
    for (const auto& [name, pointer] : found) {
      ++occurrences;
      carried += is_carried(imported->scene, pointer);
      EXPECT_TRUE(is_carried(imported->scene, pointer) || is_represented(name)) << pointer;
    }
    for (const std::string& part : imported->scene.carried.parts) EXPECT_TRUE(document.contains(Json::json_pointer(part))) << part;
  }
  EXPECT_GT(occurrences, 30u);
  std::printf("%zu extension objects in readable files, %zu of them carried\n", occurrences, carried);
}

TEST(GltfCarried, WhatTheSceneHasNoPlaceForIsInTheList) {
  const Folder folder;
  GltfBuilder gltf;
  gltf.triangle();
  gltf.json["extras"] = {{"author", "somebody"}};
  gltf.json["extensionsUsed"] = {"ACME_magic", "KHR_materials_variants"};
  gltf.json["extensions"]["KHR_materials_variants"] = {{"variants", Json::array({{{"name", "red"}}})}};
  gltf.json["nodes"][0]["extras"] = 5;
  gltf.json["nodes"][0]["extensions"]["ACME_magic"] = {{"buffer", 0}};
  gltf.json["nodes"].push_back({{"name", "in no scene"}, {"camera", 0}});
  gltf.json["scenes"].push_back({{"nodes", {1}}});
  gltf.json["cameras"] = Json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}});
  gltf.json["materials"] = Json::array({{{"name", "used"}}, {{"name", "unused"}}});
  gltf.primitive()["material"] = 0;
  gltf.primitive()["attributes"]["_HEAT"] = gltf.floats({1, 2, 3, 4, 5, 6}, "VEC2");
  gltf.primitive()["attributes"]["TEXCOORD_0"] = gltf.floats({1, 2, 3, 4, 5, 6}, "VEC2");
  gltf.primitive()["attributes"]["TEXCOORD_1"] = gltf.floats({1, 2, 3, 4, 5, 6}, "VEC2");
  const int times = gltf.accessor(
      {{"bufferView", gltf.view<float>({0, 1})}, {"componentType", 5126}, {"count", 2}, {"type", "SCALAR"}, {"min", {0}}, {"max", {1}}});
  gltf.json["animations"] =
      Json::array({{{"samplers", Json::array({{{"input", times}, {"output", gltf.floats({0, 0, 0, 1, 1, 1}, "VEC3")}}})},
                    {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}})}}});
  const auto imported = read_gltf(folder.write("asset.glb", gltf.glb()));
  ASSERT_TRUE(imported.ok());
  EXPECT_FALSE(imported->diagnostics.has_errors()) << all_text(imported->diagnostics);
  const Carried& carried = imported->scene.carried;
  const std::set<std::string> parts(carried.parts.begin(), carried.parts.end());
  const std::set<std::string> expected = {"/extras",
                                          "/extensions/KHR_materials_variants",
                                          "/nodes/0/extras",
                                          "/nodes/0/extensions/ACME_magic",
                                          "/nodes/1",
                                          "/scenes/1",
                                          "/cameras/0",
                                          "/materials/1",
                                          "/meshes/0/primitives/0/attributes/_HEAT",
                                          "/meshes/0/primitives/0/attributes/TEXCOORD_1",
                                          "/animations/0"};
  EXPECT_EQ(parts, expected);
  // Enough to write it back: the document as it was, and the bytes behind it.
  Json document = carried_document(imported->scene);
  EXPECT_EQ(document["animations"], gltf.json["animations"]);
  ASSERT_EQ(carried.buffers.size(), 1u);
  ASSERT_EQ(carried.buffers[0].size(), gltf.bytes.size());
  EXPECT_TRUE(std::equal(gltf.bytes.begin(), gltf.bytes.end(), carried.buffers[0].begin()));
}

TEST(GltfCarried, NothingIsKeptUnasked) {
  const Folder folder;
  GltfBuilder gltf;
  gltf.triangle();
  gltf.json["extras"] = 1;
  ImportOptions options;
  options.need = Need::lights | Need::materials | Need::cameras | Need::meshes | Need::images;
  const auto imported = read_gltf(gltf, folder, options);
  ASSERT_TRUE(imported.ok());
  EXPECT_TRUE(imported->scene.carried.parts.empty());
  EXPECT_FALSE(imported->scene.carried.document);
}

TEST(GltfCarried, ARequiredExtensionThatIsNotShownIsAnError) {
  for (const char* name : {"ACME_magic", "KHR_texture_basisu", "EXT_mesh_gpu_instancing"}) {
    const Folder folder;
    GltfBuilder gltf;
    gltf.triangle();
    gltf.json["extensionsUsed"] = gltf.json["extensionsRequired"] = {name};
    const auto imported = read_gltf(gltf, folder);
    ASSERT_TRUE(imported.ok());
    EXPECT_TRUE(says(imported->diagnostics, Severity::error, "UNSUPPORTED_REQUIRED_EXTENSION", "/extensionsRequired/0")) << name;
  }
}

// The mapping of sdk/docs/gltf.md is the table that the importer follows.
TEST(GltfCarried, TheTableIsTheDocumentedOne) {
  std::ifstream stream(source_dir() / "sdk/docs/gltf.md");
  const std::string page((std::istreambuf_iterator<char>(stream)), {});
  EXPECT_NE(page.find(gltf::mapping_table()), std::string::npos) << "sdk/docs/gltf.md should hold:\n" << gltf::mapping_table();
}

// Every property that the schema knows has a row, and what is said to be below it is known as well.
TEST(GltfCarried, TheTableKnowsEveryPropertyOfTheSchema) {
  for (const char* type : {"glTF", "asset", "accessor", "bufferView", "buffer", "camera", "camera.perspective", "image", "material",
                           "material.pbrMetallicRoughness", "textureInfo", "material.normalTexture", "material.occlusionTexture", "mesh",
                           "mesh.primitive", "node", "sampler", "scene", "texture"}) {
    const auto* properties = gltf::properties_of(type);
    ASSERT_NE(properties, nullptr) << type;
    for (const gltf::Property& property : *properties)
      EXPECT_NE(gltf::mapped(type, property.name).row, nullptr) << type << "." << property.name;
  }
}

}  // namespace
}  // namespace etendue::test
