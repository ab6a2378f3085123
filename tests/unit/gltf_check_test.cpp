// Every check of a document and its contents: one defect in an asset that has a bit of everything, made by a JSON patch (RFC 6902), and the
// message that must name it. Codes are Khronos' validator's, which finds no error in the asset itself.
#include <functional>
#include <ostream>

#include "gltf_builder.h"
#include "source_dir.h"

namespace etendue::test {
namespace {

const std::string asset_file = (source_dir() / "tests/fuzz/corpus/gltf/everything.gltf").string();
Json everything() {
  std::ifstream stream(asset_file);
  return Json::parse(stream);
}

struct Fault {
  const char* patch;
  const char* code;
  const char* pointer;
  Severity severity = Severity::error;
};
void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.code << " " << fault.patch; }

class GltfCheck : public testing::TestWithParam<Fault> {};

TEST_P(GltfCheck, FindsTheFault) {
  const Folder folder;
  const Json document = everything().patch(Json::parse(GetParam().patch));
  const auto imported = read_gltf(folder.write("bad.gltf", document.dump(1)));
  ASSERT_TRUE(imported.ok()) << imported.error().text;
  EXPECT_TRUE(says(imported->diagnostics, GetParam().severity, GetParam().code, GetParam().pointer));
  for (const Diagnostic& d : imported->diagnostics.all()) EXPECT_TRUE(d.severity != Severity::error || d.where.line > 0) << to_string(d);
}

TEST(GltfCheckBase, TheAssetItselfHasNoError) {
  const auto imported = read_gltf(asset_file);
  ASSERT_TRUE(imported.ok());
  EXPECT_FALSE(imported->diagnostics.has_errors()) << all_text(imported->diagnostics);
}

const Fault faults[] = {
    // Schema
    {R"([{"op": "add", "path": "/nodes/0/surprise", "value": 1}])", "UNEXPECTED_PROPERTY", "/nodes/0/surprise", Severity::warning},
    {R"([{"op": "replace", "path": "/accessors/0/count", "value": "3"}])", "TYPE_MISMATCH", "/accessors/0/count"},
    {R"([{"op": "replace", "path": "/accessors/0/count", "value": 3.5}])", "TYPE_MISMATCH", "/accessors/0/count"},
    {R"([{"op": "replace", "path": "/accessors/0/count", "value": null}])", "TYPE_MISMATCH", "/accessors/0/count"},
    {R"([{"op": "replace", "path": "/accessors/3/type", "value": "VEC5"}])", "VALUE_NOT_IN_LIST", "/accessors/3/type", Severity::warning},
    {R"([{"op": "remove", "path": "/skins/0/joints"}])", "UNDEFINED_PROPERTY", "/skins/0"},
    {R"([{"op": "replace", "path": "/nodes/1/children", "value": []}])", "EMPTY_ENTITY", "/nodes/1/children"},
    {R"([{"op": "replace", "path": "/nodes/1/translation", "value": [0, 1]}])", "ARRAY_LENGTH_NOT_IN_LIST", "/nodes/1/translation"},
    {R"([{"op": "replace", "path": "/nodes/1/translation/1", "value": "1"}])", "ARRAY_TYPE_MISMATCH", "/nodes/1/translation/1"},
    {R"([{"op": "replace", "path": "/meshes/0", "value": 7}])", "TYPE_MISMATCH", "/meshes/0"},
    {R"([{"op": "replace", "path": "/meshes/0/primitives/0", "value": 7}])", "ARRAY_TYPE_MISMATCH", "/meshes/0/primitives/0"},
    {R"([{"op": "add", "path": "/skins/0/joints/-", "value": 1}])", "DUPLICATE_ELEMENTS", "/skins/0/joints/2"},
    {R"([{"op": "add", "path": "/skins/0/joints/-", "value": "1"}])", "INVALID_INDEX", "/skins/0/joints/2"},
    {R"([{"op": "replace", "path": "/textures/0/source", "value": 1}])", "UNRESOLVED_REFERENCE", "/textures/0/source"},
    {R"([{"op": "replace", "path": "/textures/0/source", "value": 18446744073709551615}])", "UNRESOLVED_REFERENCE", "/textures/0/source"},
    {R"([{"op": "add", "path": "/nodes/0/extras", "value": 1}])", "NON_OBJECT_EXTRAS", "/nodes/0/extras", Severity::note},
    {R"([{"op": "replace", "path": "/bufferViews/0/byteOffset", "value": 9007199254740992}])", "VALUE_NOT_IN_RANGE",
     "/bufferViews/0/byteOffset"},
    // Extensions
    {R"([{"op": "remove", "path": "/extensionsUsed/5"}])", "UNDECLARED_EXTENSION", "/nodes/3/extensions/KHR_lights_punctual"},
    {R"([{"op": "add", "path": "/nodes/0/extensions", "value": {"KHR_texture_transform": {}}}])", "UNEXPECTED_EXTENSION_OBJECT",
     "/nodes/0/extensions/KHR_texture_transform"},
    {R"([{"op": "add", "path": "/extensionsRequired", "value": ["KHR_materials_ior"]}])", "UNUSED_EXTENSION_REQUIRED",
     "/extensionsRequired/0"},
    {R"([{"op": "add", "path": "/extensionsUsed/-", "value": "KHR_mesh_quantization"}])", "NON_REQUIRED_EXTENSION", "/extensionsUsed/7"},
    {R"([{"op": "add", "path": "/extensionsUsed/-", "value": "KHR_materials_ior"}])", "UNUSED_EXTENSION", "/extensionsUsed/7",
     Severity::note},
    {R"([{"op": "add", "path": "/extensionsUsed/-", "value": "khr_lights"}])", "INVALID_EXTENSION_NAME_FORMAT", "/extensionsUsed/7",
     Severity::warning},
    {R"([{"op": "remove", "path": "/extensions/KHR_lights_punctual"}])", "UNSATISFIED_DEPENDENCY",
     "/nodes/3/extensions/KHR_lights_punctual/light"},
    {R"([{"op": "remove", "path": "/extensions/KHR_lights_punctual/lights/0/spot"}])", "UNDEFINED_PROPERTY",
     "/extensions/KHR_lights_punctual/lights/0"},
    {R"([{"op": "add", "path": "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/-", "value": {"variants": [1], "material": 0}}])",
     "KHR_MATERIALS_VARIANTS_NON_UNIQUE_VARIANT", "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/1/variants/0"},
    {R"([{"op": "add", "path": "/animations/0/channels/3/target/node", "value": 0}])",
     "KHR_ANIMATION_POINTER_ANIMATION_CHANNEL_TARGET_NODE", "/animations/0/channels/3/target/extensions/KHR_animation_pointer"},
    // Buffers, views, accessors
    {R"([{"op": "replace", "path": "/bufferViews/3/byteOffset", "value": 100000}])", "BUFFER_VIEW_TOO_LONG", "/bufferViews/3/byteOffset"},
    {R"([{"op": "replace", "path": "/bufferViews/3/byteLength", "value": 100000}])", "BUFFER_VIEW_TOO_LONG", "/bufferViews/3/byteLength"},
    {R"([{"op": "add", "path": "/bufferViews/3/byteStride", "value": 10}])", "VALUE_MULTIPLE_OF", "/bufferViews/3/byteStride"},
    {R"([{"op": "add", "path": "/bufferViews/3/byteStride", "value": 252}])", "BUFFER_VIEW_TOO_BIG_BYTE_STRIDE",
     "/bufferViews/3/byteStride"},
    {R"([{"op": "add", "path": "/bufferViews/0/byteStride", "value": 8}])", "ACCESSOR_SMALL_BYTESTRIDE", "/accessors/0"},
    {R"([{"op": "add", "path": "/bufferViews/0/target", "value": 34963}])", "BUFFER_VIEW_TARGET_OVERRIDE",
     "/meshes/0/primitives/0/attributes/POSITION"},
    {R"([{"op": "replace", "path": "/buffers/0/byteLength", "value": 100000}])", "BUFFER_BYTE_LENGTH_MISMATCH", "/buffers/0"},
    {R"([{"op": "replace", "path": "/accessors/9/count", "value": 1000000000000}])", "ACCESSOR_TOO_LONG", "/accessors/9"},
    {R"([{"op": "add", "path": "/accessors/3/byteOffset", "value": 2}])", "ACCESSOR_OFFSET_ALIGNMENT", "/accessors/3/byteOffset"},
    {R"([{"op": "add", "path": "/accessors/9/byteOffset", "value": 2}])", "ACCESSOR_MATRIX_ALIGNMENT", "/accessors/9/byteOffset"},
    {R"([{"op": "add", "path": "/accessors/0/normalized", "value": true}])", "ACCESSOR_NORMALIZED_INVALID", "/accessors/0/normalized"},
    {R"([{"op": "add", "path": "/accessors/7/max", "value": [65536]}])", "INVALID_GL_VALUE", "/accessors/7/max/0"},
    {R"([{"op": "replace", "path": "/accessors/0/max/0", "value": 2}])", "ACCESSOR_MAX_MISMATCH", "/accessors/0/max/0"},
    {R"([{"op": "replace", "path": "/accessors/0/min/0", "value": 0.5}])", "ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND", "/accessors/0/min/0"},
    {R"([{"op": "remove", "path": "/accessors/0/min"}])", "MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS",
     "/meshes/0/primitives/0/attributes/POSITION"},
    {R"([{"op": "add", "path": "/accessors/0/sparse", "value": {"count": 4, "indices": {"bufferView": 7, "componentType": 5123},
         "values": {"bufferView": 1}}}])",
     "ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE", "/accessors/0/sparse/count"},
    {R"([{"op": "add", "path": "/accessors/0/sparse", "value": {"count": 3, "indices": {"bufferView": 7, "componentType": 5125},
         "values": {"bufferView": 1}}}])",
     "ACCESSOR_TOO_LONG", "/accessors/0/sparse/indices"},
    // Meshes
    {R"([{"op": "move", "from": "/meshes/0/primitives/0/attributes/COLOR_0", "path": "/meshes/0/primitives/0/attributes/COLOR_1"}])",
     "MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY", "/meshes/0/primitives/0/attributes"},
    {R"([{"op": "add", "path": "/meshes/0/primitives/0/attributes/COLOUR", "value": 0}])", "MESH_PRIMITIVE_INVALID_ATTRIBUTE",
     "/meshes/0/primitives/0/attributes/COLOUR"},
    {R"([{"op": "replace", "path": "/meshes/0/primitives/0/attributes/NORMAL", "value": 2}])",
     "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", "/meshes/0/primitives/0/attributes/NORMAL"},
    {R"([{"op": "remove", "path": "/meshes/0/primitives/0/attributes/WEIGHTS_0"}])", "MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH",
     "/meshes/0/primitives/0/attributes"},
    {R"([{"op": "remove", "path": "/meshes/0/primitives/0/attributes/TEXCOORD_0"}])", "MESH_PRIMITIVE_TOO_FEW_TEXCOORDS",
     "/meshes/0/primitives/0/material"},
    {R"([{"op": "replace", "path": "/meshes/0/primitives/0/indices", "value": 3}])", "MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT",
     "/meshes/0/primitives/0/indices"},
    {R"([{"op": "replace", "path": "/accessors/7/count", "value": 2}])", "MESH_PRIMITIVE_INCOMPATIBLE_MODE", "/meshes/0/primitives/0",
     Severity::warning},
    {R"([{"op": "replace", "path": "/meshes/1/weights", "value": [0, 1]}])", "MESH_INVALID_WEIGHTS_COUNT", "/meshes/1/weights"},
    {R"([{"op": "replace", "path": "/meshes/1/primitives/0/targets/0", "value": {"NORMAL": 1}}])",
     "MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR", "/meshes/1/primitives/0/targets/0/NORMAL"},
    {R"([{"op": "replace", "path": "/meshes/0/primitives/0/attributes/NORMAL", "value": 8}])", "ACCESSOR_VECTOR3_NON_UNIT",
     "/meshes/0/primitives/0/attributes/NORMAL"},
    // Nodes, skins, animations, cameras
    {R"([{"op": "add", "path": "/nodes/3/scale", "value": [1, 1, 1]}])", "NODE_MATRIX_TRS", "/nodes/3/matrix"},
    {R"([{"op": "replace", "path": "/nodes/3/matrix/3", "value": 1}])", "NODE_MATRIX_NON_TRS", "/nodes/3/matrix"},
    {R"([{"op": "add", "path": "/nodes/3/children", "value": [1]}])", "NODE_LOOP", "/nodes/1"},
    {R"([{"op": "add", "path": "/scenes/0/nodes/-", "value": 2}])", "SCENE_NON_ROOT_NODE", "/scenes/0/nodes/3"},
    {R"([{"op": "replace", "path": "/nodes/4/weights", "value": [1, 1]}])", "NODE_WEIGHTS_INVALID", "/nodes/4/weights"},
    {R"([{"op": "add", "path": "/nodes/4/skin", "value": 0}])", "NODE_SKIN_WITH_NON_SKINNED_MESH", "/nodes/4"},
    {R"([{"op": "remove", "path": "/nodes/0/mesh"}])", "UNSATISFIED_DEPENDENCY", "/nodes/0/skin"},
    {R"([{"op": "add", "path": "/skins/0/joints/-", "value": 4}])", "SKIN_NO_COMMON_ROOT", "/skins/0/joints"},
    {R"([{"op": "replace", "path": "/skins/0/skeleton", "value": 2}])", "SKIN_SKELETON_INVALID", "/skins/0/skeleton"},
    {R"([{"op": "add", "path": "/skins/0/joints/-", "value": 3}])", "INVALID_IBM_ACCESSOR_COUNT", "/skins/0/inverseBindMatrices"},
    {R"([{"op": "replace", "path": "/skins/0/inverseBindMatrices", "value": 4}])", "SKIN_IBM_INVALID_FORMAT",
     "/skins/0/inverseBindMatrices"},
    {R"([{"op": "replace", "path": "/skins/0/joints", "value": [1]}])", "ACCESSOR_JOINTS_INDEX_OOB",
     "/meshes/0/primitives/0/attributes/JOINTS_0"},
    {R"([{"op": "replace", "path": "/scenes/0/nodes", "value": [0, 4]}])", "NODE_SKIN_NO_SCENE", "/nodes/0"},
    {R"([{"op": "replace", "path": "/animations/0/samplers/1/input", "value": 13}])", "ACCESSOR_USAGE_OVERRIDE",
     "/animations/0/samplers/2/output"},
    {R"([{"op": "replace", "path": "/animations/0/channels/1/target/node", "value": 3}])", "ANIMATION_CHANNEL_TARGET_NODE_MATRIX",
     "/animations/0/channels/1/target"},
    {R"([{"op": "replace", "path": "/animations/0/channels/2/target/node", "value": 1}])",
     "ANIMATION_CHANNEL_TARGET_NODE_WEIGHTS_NO_MORPHS", "/animations/0/channels/2/target"},
    {R"([{"op": "replace", "path": "/animations/0/channels/0/sampler", "value": 3}])", "UNRESOLVED_REFERENCE",
     "/animations/0/channels/0/sampler"},
    {R"([{"op": "replace", "path": "/animations/0/channels/0/sampler", "value": 1}])", "ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_FORMAT",
     "/animations/0/channels/0/sampler"},
    {R"([{"op": "replace", "path": "/animations/0/channels/1/target", "value": {"node": 1, "path": "translation"}}])",
     "ANIMATION_DUPLICATE_TARGETS", "/animations/0/channels/1/target"},
    {R"([{"op": "add", "path": "/animations/0/samplers/0/interpolation", "value": "CUBICSPLINE"}])",
     "ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_COUNT", "/animations/0/channels/0/sampler"},
    {R"([{"op": "replace", "path": "/cameras/0/orthographic/zfar", "value": 0.05}])", "CAMERA_ZFAR_LEQUAL_ZNEAR",
     "/cameras/0/orthographic"},
    {R"([{"op": "replace", "path": "/cameras/0/orthographic/xmag", "value": 0}])", "CAMERA_XMAG_YMAG_ZERO", "/cameras/0/orthographic/xmag"},
    {R"([{"op": "add", "path": "/cameras/0/perspective", "value": {"yfov": 1, "znear": 1}}])", "ONE_OF_MISMATCH", "/cameras/0"},
    // Pictures
    {R"([{"op": "replace", "path": "/images/0/mimeType", "value": "image/jpeg"}])", "IMAGE_MIME_TYPE_INVALID", "/images/0/bufferView"},
    {R"([{"op": "remove", "path": "/images/0/mimeType"}])", "UNSATISFIED_DEPENDENCY", "/images/0/bufferView"},
    {R"([{"op": "replace", "path": "/images/0/mimeType", "value": "image/webp"}])", "TEXTURE_INVALID_IMAGE_MIME_TYPE",
     "/textures/0/source"},
    {R"([{"op": "add", "path": "/images/0/uri", "value": "a.png"}])", "ONE_OF_MISMATCH", "/images/0"},
    {R"([{"op": "replace", "path": "/bufferViews/14/byteLength", "value": 20}])", "IMAGE_UNEXPECTED_EOS", "/images/0"},
    {R"([{"op": "replace", "path": "/images/0", "value": {"uri": "data:image/png;base64,AAAA"}}])", "INVALID_URI", "/images/0/uri"},
    {R"([{"op": "replace", "path": "/images/0", "value": {"uri": "a/../../secret.png"}}])", "PATH_OUTSIDE_FOLDER", "/images/0/uri"},
    {R"([{"op": "replace", "path": "/images/0", "value": {"uri": "%2e%2e%2fsecret.png"}}])", "PATH_OUTSIDE_FOLDER", "/images/0/uri"},
    {R"([{"op": "replace", "path": "/images/0", "value": {"uri": "http://example.com/a.png"}}])", "PATH_OUTSIDE_FOLDER", "/images/0/uri"},
    {R"([{"op": "replace", "path": "/images/0", "value": {"uri": "missing.png"}}])", "IO_ERROR", "/images/0/uri"},
};
INSTANTIATE_TEST_SUITE_P(All, GltfCheck, testing::ValuesIn(faults));

// A limit is an error that names itself, and the option that sets it.
TEST(GltfLimits, NameTheirOptions) {
  const Folder folder;
  const auto expect_limit = [&](const std::string& option, const std::function<void(ImportOptions&)>& set) {
    ImportOptions options;
    set(options);
    const auto imported = read_gltf(folder.write("asset.gltf", everything().dump()), options);
    Diagnostics diagnostics;
    if (imported.ok()) {
      diagnostics = imported->diagnostics;
    } else {
      diagnostics.add(to_diagnostic(imported.error()));
    }
    int found = 0;
    for (const Diagnostic& d : diagnostics.all()) {
      if (d.code != "LIMIT_EXCEEDED") continue;
      ++found;
      EXPECT_EQ(d.severity, Severity::error);
      EXPECT_NE(d.text.find(option + " = "), std::string::npos) << d.text;
      EXPECT_NE(d.hint.find("--limit " + option + "="), std::string::npos) << d.hint;
    }
    EXPECT_GT(found, 0) << option << "\n" << all_text(diagnostics);
  };
  expect_limit("max_bytes", [](ImportOptions& o) { o.max_bytes = 1000; });
  expect_limit("max_items", [](ImportOptions& o) { o.max_items = 4; });
  expect_limit("max_depth", [](ImportOptions& o) { o.max_depth = 4; });
  expect_limit("max_pixels", [](ImportOptions& o) { o.max_pixels = 0; });
  expect_limit("max_decoded", [](ImportOptions& o) { o.max_decoded = 10; });
  expect_limit("max_memory", [](ImportOptions& o) { o.max_memory = 10000; });
}

// What has a harmless repair is a warning that says what was done; the same file is an error otherwise, and other errors stay what they
// are.
TEST(GltfTolerant, RepairsWhatIsHarmless) {
  const Folder folder;
  Json document = everything();
  document["accessors"][0].erase("max");
  document["nodes"][2]["rotation"] = {0, 0, 0, 0.9};
  const auto file = folder.write("asset.gltf", document.dump());
  EXPECT_TRUE(read_gltf(file)->diagnostics.has_errors());
  ImportOptions tolerant;
  tolerant.tolerant = true;
  const auto repaired = read_gltf(file, tolerant);
  ASSERT_TRUE(repaired.ok());
  EXPECT_FALSE(repaired->diagnostics.has_errors()) << all_text(repaired->diagnostics);
  EXPECT_TRUE(says(repaired->diagnostics, Severity::warning, "ROTATION_NON_UNIT", "/nodes/2/rotation"));
  EXPECT_TRUE(says(repaired->diagnostics, Severity::warning, "MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS",
                   "/meshes/0/primitives/0/attributes/POSITION"));
  document["bufferViews"][0]["byteLength"] = 100000;
  EXPECT_TRUE(read_gltf(folder.write("asset.gltf", document.dump()), tolerant)->diagnostics.has_errors());
}

// An integer may be written as 3.0 (JSON Schema): what it counts is read all the same.
TEST(GltfNumbers, IntegersWithAPoint) {
  const Folder folder;
  std::string text = everything().dump();
  const std::size_t at = text.find("\"componentType\":5126,\"count\":3,");
  ASSERT_NE(at, std::string::npos);
  text.replace(at, 31, "\"componentType\":5126.0,\"count\":3e0,");
  const auto imported = read_gltf(folder.write("asset.gltf", text));
  ASSERT_TRUE(imported.ok());
  EXPECT_FALSE(imported->diagnostics.has_errors()) << all_text(imported->diagnostics);
  EXPECT_EQ(imported->scene.meshes.size(), read_gltf(asset_file)->scene.meshes.size());
}

}  // namespace
}  // namespace etendue::test
