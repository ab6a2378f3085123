// Broken and hostile glTF: an error that names the place, and nothing read that should not be.
#include <functional>
#include <ostream>
#include <random>

#include "gltf_builder.h"
#include "source_dir.h"

namespace etendue::test {
namespace {

// One defect in an otherwise valid asset, and the error that must name it.
struct Defect {
  const char* name;
  std::function<void(GltfBuilder&)> make;
  const char* code;
  const char* pointer;
};
void PrintTo(const Defect& defect, std::ostream* out) { *out << defect.name; }

class GltfDefect : public testing::TestWithParam<Defect> {};

TEST_P(GltfDefect, IsAnErrorAtItsPlace) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / (std::string("etendue_defect_") + GetParam().name);
  std::filesystem::create_directories(folder);
  GltfBuilder gltf;
  gltf.triangle();
  gltf.primitive()["indices"] = gltf.indices<std::uint16_t>({0, 1, 2});
  std::ofstream(folder / "good.gltf") << gltf.text();
  GetParam().make(gltf);
  std::ofstream(folder / "bad.gltf") << gltf.text();

  const auto good = read_gltf(folder / "good.gltf");
  ASSERT_TRUE(good.ok());
  EXPECT_TRUE(good->diagnostics.all().empty()) << all_text(good->diagnostics);
  const auto bad = read_gltf(folder / "bad.gltf");
  ASSERT_TRUE(bad.ok()) << bad.error().text;
  EXPECT_TRUE(says(bad->diagnostics, Severity::error, GetParam().code, GetParam().pointer));
  for (const Diagnostic& d : bad->diagnostics.all()) EXPECT_GT(d.where.line, 0) << to_string(d);
  std::filesystem::remove_all(folder);
}

const Defect defects[] = {
    {"IndexAccessor", [](GltfBuilder& g) { g.primitive()["attributes"]["POSITION"] = 99; }, "UNRESOLVED_REFERENCE",
     "/meshes/0/primitives/0/attributes/POSITION"},
    {"IndexNegative", [](GltfBuilder& g) { g.json["nodes"][0]["mesh"] = -1; }, "INVALID_INDEX", "/nodes/0/mesh"},
    {"IndexHuge", [](GltfBuilder& g) { g.json["nodes"][0]["mesh"] = 18446744073709551615u; }, "UNRESOLVED_REFERENCE", "/nodes/0/mesh"},
    {"IndexFraction", [](GltfBuilder& g) { g.json["nodes"][0]["mesh"] = 0.5; }, "TYPE_MISMATCH", "/nodes/0/mesh"},
    {"IndexText", [](GltfBuilder& g) { g.json["nodes"][0]["mesh"] = "0"; }, "TYPE_MISMATCH", "/nodes/0/mesh"},
    {"SceneIndex", [](GltfBuilder& g) { g.json["scene"] = 7; }, "UNRESOLVED_REFERENCE", "/scene"},
    {"SceneNode", [](GltfBuilder& g) { g.json["scenes"][0]["nodes"] = {7}; }, "UNRESOLVED_REFERENCE", "/scenes/0/nodes/0"},
    {"Cycle", [](GltfBuilder& g) { g.json["nodes"][0]["children"] = {0}; }, "NODE_LOOP", "/nodes/0"},
    {"CycleOfTwo",
     [](GltfBuilder& g) {
       g.json["nodes"][0]["children"] = {1};
       g.json["nodes"].push_back({{"children", {0}}});
     },
     "NODE_LOOP", "/nodes/0"},
    {"TwoParents",
     [](GltfBuilder& g) {
       g.json["nodes"][0]["children"] = {1};
       g.json["nodes"].push_back(Json::object());
       g.json["nodes"].push_back({{"children", {1}}});
     },
     "NODE_PARENT_OVERRIDE", "/nodes/2/children/0"},
    {"VertexIndex",
     [](GltfBuilder& g) {
       g.primitive()["indices"] = g.indices<std::uint16_t>({0, 1, 3});
     },
     "ACCESSOR_INDEX_OOB", "/meshes/0/primitives/0/indices"},
    {"AccessorBeyondView", [](GltfBuilder& g) { g.json["accessors"][0]["count"] = 4; }, "ACCESSOR_TOO_LONG", "/accessors/0"},
    {"AccessorOffsetBeyondView", [](GltfBuilder& g) { g.json["accessors"][0]["byteOffset"] = 9007199254740988; }, "ACCESSOR_TOO_LONG",
     "/accessors/0"},
    {"HugeCount", [](GltfBuilder& g) { g.json["accessors"][0]["count"] = 4000000000u; }, "LIMIT_EXCEEDED", "/accessors/0"},
    {"HugeCountWithoutBytes",
     [](GltfBuilder& g) {
       g.json["accessors"][0]["count"] = 9007199254740991;
       g.json["accessors"][0].erase("bufferView");
     },
     "LIMIT_EXCEEDED", "/accessors/0"},
    {"ViewBeyondBuffer", [](GltfBuilder& g) { g.json["bufferViews"][0]["byteLength"] = 4000; }, "BUFFER_VIEW_TOO_LONG", "/bufferViews/0"},
    {"ViewOffsetOverflow", [](GltfBuilder& g) { g.json["bufferViews"][0]["byteOffset"] = 9007199254740991; }, "BUFFER_VIEW_TOO_LONG",
     "/bufferViews/0"},
    {"BufferTooShort",
     [](GltfBuilder& g) {
       g.json["buffers"] = Json::array({{{"byteLength", 64}, {"uri", "data:;base64,AAAA"}}});
     },
     "BUFFER_BYTE_LENGTH_MISMATCH", "/buffers/0"},
    {"BadBase64",
     [](GltfBuilder& g) {
       g.json["buffers"] = Json::array({{{"byteLength", 3}, {"uri", "data:;base64,A*AA"}}});
     },
     "INVALID_URI", "/buffers/0/uri"},
    {"Misaligned",
     [](GltfBuilder& g) {
       g.bytes.resize(g.bytes.size() + 4);
       g.json["bufferViews"][0]["byteLength"] = 40;
       g.json["accessors"][0]["byteOffset"] = 2;
     },
     "ACCESSOR_TOTAL_OFFSET_ALIGNMENT", "/accessors/0"},
    {"NotANumber",
     [](GltfBuilder& g) {
       const std::uint32_t nan = 0x7FC00000;
       std::memcpy(g.bytes.data(), &nan, 4);
     },
     "ACCESSOR_INVALID_FLOAT", "/accessors/0"},
    {"NormalsMissing",
     [](GltfBuilder& g) {
       g.primitive()["attributes"]["NORMAL"] = g.floats({0, 0, 1, 0, 0, 1}, "VEC3");
     },
     "MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT", "/meshes/0/primitives/0/attributes/NORMAL"},
    {"UvsMissing",
     [](GltfBuilder& g) {
       g.primitive()["attributes"]["TEXCOORD_0"] = g.floats({0, 0, 1, 0}, "VEC2");
     },
     "MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT", "/meshes/0/primitives/0/attributes/TEXCOORD_0"},
    {"FloatIndices", [](GltfBuilder& g) { g.primitive()["indices"] = 0; }, "MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT",
     "/accessors/0"},
    {"SparseIndex",
     [](GltfBuilder& g) {
       g.json["accessors"][0]["sparse"] = {{"count", 1},
                                           {"indices", {{"bufferView", g.view<std::uint8_t>({3})}, {"componentType", 5121}}},
                                           {"values", {{"bufferView", g.view<float>({0, 0, 0})}}}};
     },
     "ACCESSOR_SPARSE_INDEX_OOB", "/accessors/0/sparse/indices"},
    {"SparseOrder",
     [](GltfBuilder& g) {
       g.json["accessors"][0]["sparse"] = {{"count", 2},
                                           {"indices", {{"bufferView", g.view<std::uint8_t>({1, 1})}, {"componentType", 5121}}},
                                           {"values", {{"bufferView", g.view<float>({0, 0, 0, 0, 0, 0})}}}};
     },
     "ACCESSOR_SPARSE_INDICES_NON_INCREASING", "/accessors/0/sparse/indices"},
    {"FlatMatrix", [](GltfBuilder& g) { g.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; },
     "NODE_MATRIX_NON_TRS", "/nodes/0/matrix"},
    {"ProjectiveMatrix", [](GltfBuilder& g) { g.json["nodes"][0]["matrix"] = {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; },
     "NODE_MATRIX_NON_TRS", "/nodes/0/matrix"},
    {"MatrixLength",
     [](GltfBuilder& g) {
       g.json["nodes"][0]["matrix"] = {1, 0, 0, 0};
     },
     "ARRAY_LENGTH_NOT_IN_LIST", "/nodes/0/matrix"},
    {"Rotation",
     [](GltfBuilder& g) {
       g.json["nodes"][0]["rotation"] = {0, 0, 0, 0};
     },
     "ROTATION_NON_UNIT", "/nodes/0/rotation"},
    {"InfiniteProduct",
     [](GltfBuilder& g) {
       g.json["nodes"][0]["scale"] = {1e200, 1e200, 1e200};
       g.json["nodes"][0]["children"] = {1};
       g.json["nodes"].push_back({{"scale", {1e200, 1e200, 1e200}}});
     },
     "NODE_TRANSFORM_INVALID", "/nodes/1"},
    {"BufferPathUp",
     [](GltfBuilder& g) {
       g.json["buffers"] = Json::array({{{"byteLength", 64}, {"uri", "../secret.bin"}}});
     },
     "PATH_OUTSIDE_FOLDER", "/buffers/0/uri"},
    {"BufferPathUpEncoded",
     [](GltfBuilder& g) {
       g.json["buffers"] = Json::array({{{"byteLength", 64}, {"uri", "a/%2e%2e/%2E./secret.bin"}}});
     },
     "PATH_OUTSIDE_FOLDER", "/buffers/0/uri"},
    {"BufferPathAbsolute",
     [](GltfBuilder& g) {
       g.json["buffers"] = Json::array({{{"byteLength", 64}, {"uri", "/etc/hostname"}}});
     },
     "PATH_OUTSIDE_FOLDER", "/buffers/0/uri"},
    {"BufferScheme",
     [](GltfBuilder& g) {
       g.json["buffers"] = Json::array({{{"byteLength", 64}, {"uri", "file:///etc/hostname"}}});
     },
     "PATH_OUTSIDE_FOLDER", "/buffers/0/uri"},
    {"BufferDrive",
     [](GltfBuilder& g) {
       g.json["buffers"] = Json::array({{{"byteLength", 64}, {"uri", "C:%5csecret.bin"}}});
     },
     "PATH_OUTSIDE_FOLDER", "/buffers/0/uri"},
    {"BufferShell",
     [](GltfBuilder& g) {
       g.json["buffers"] = Json::array({{{"byteLength", 64}, {"uri", "$(touch here).bin"}}});
     },
     "IO_ERROR", "/buffers/0/uri"},
    {"BufferNul",
     [](GltfBuilder& g) {
       g.json["buffers"] = Json::array({{{"byteLength", 64}, {"uri", "a%00.bin"}}});
     },
     "INVALID_URI", "/buffers/0/uri"},
    {"BufferOfNoGlb",
     [](GltfBuilder& g) {
       g.json["buffers"] = Json::array({{{"byteLength", 64}}});
     },
     "BUFFER_MISSING_GLB_DATA", "/buffers/0"},
    {"HugeBuffer",
     [](GltfBuilder& g) {
       g.json["buffers"] = Json::array({{{"byteLength", 9007199254740991}, {"uri", "data:;base64,AAAA"}}});
     },
     "LIMIT_EXCEEDED", "/buffers/0"},
    {"RequiredExtension", [](GltfBuilder& g) { g.json["extensionsRequired"] = g.json["extensionsUsed"] = {"ACME_magic"}; },
     "UNSUPPORTED_REQUIRED_EXTENSION", "/extensionsRequired/0"},
    {"Roughness", [](GltfBuilder& g) { g.json["materials"] = Json::parse(R"([{"pbrMetallicRoughness": {"roughnessFactor": 1.5}}])"); },
     "VALUE_NOT_IN_RANGE", "/materials/0/pbrMetallicRoughness/roughnessFactor"},
    {"AttributesMissing", [](GltfBuilder& g) { g.primitive().erase("attributes"); }, "UNDEFINED_PROPERTY", "/meshes/0/primitives/0"},
    {"SpotAngles",
     [](GltfBuilder& g) {
       g.json["extensions"]["KHR_lights_punctual"]["lights"] =
           Json::parse(R"([{"type": "spot", "spot": {"innerConeAngle": 0.5, "outerConeAngle": 0.25}}])");
       g.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
     },
     "KHR_LIGHTS_PUNCTUAL_LIGHT_SPOT_ANGLES", "/extensions/KHR_lights_punctual/lights/0/spot"},
    {"NegativeIntensity",
     [](GltfBuilder& g) {
       g.json["extensionsUsed"] = {"KHR_lights_punctual"};
       g.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(R"([{"type": "point", "intensity": -1}])");
     },
     "VALUE_NOT_IN_RANGE", "/extensions/KHR_lights_punctual/lights/0/intensity"},
    {"LightIndex",
     [](GltfBuilder& g) {
       g.json["extensionsUsed"] = {"KHR_lights_punctual"};
       g.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(R"([{"type": "point"}])");
       g.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 1;
     },
     "UNRESOLVED_REFERENCE", "/nodes/0/extensions/KHR_lights_punctual/light"},
};
INSTANTIATE_TEST_SUITE_P(All, GltfDefect, testing::ValuesIn(defects), [](const auto& info) { return std::string(info.param.name); });

TEST(GltfMalformed, SymbolicLinksOutOfTheFolderAreNotFollowed) {
  const Folder folder;
  const auto secret = folder.write("secret.bin", std::string(64, 'x'));
  std::filesystem::create_directories(folder.path() / "asset");
  std::error_code failure;
  std::filesystem::create_symlink(secret, folder.path() / "asset" / "link.bin", failure);
  if (failure) GTEST_SKIP() << "no symbolic links here: " << failure.message();
  GltfBuilder gltf;
  gltf.triangle();
  gltf.json["buffers"] = Json::array({{{"byteLength", 36}, {"uri", "link.bin"}}});
  const auto imported = read_gltf(folder.write("asset/asset.gltf", gltf.text()));
  ASSERT_TRUE(imported.ok());
  EXPECT_TRUE(says(imported->diagnostics, Severity::error, "PATH_OUTSIDE_FOLDER", "/buffers/0/uri"));
  EXPECT_TRUE(imported->scene.meshes.empty());
}

TEST(GltfMalformed, DeepNestingIsRefused) {
  const Folder folder;
  std::string text = R"({"asset": {"version": "2.0"}, "extras": )";
  text += std::string(100000, '[') + std::string(100000, ']') + "}";
  const auto deep = read_gltf(folder.write("deep.gltf", text));
  ASSERT_FALSE(deep.ok());

  // A chain of 300 nodes is over the default depth of 256.
  GltfBuilder gltf;
  for (int i = 0; i < 300; ++i) gltf.json["nodes"].push_back(i < 299 ? Json{{"children", {i + 1}}} : Json::object());
  const auto chain = read_gltf(gltf, folder);
  ASSERT_TRUE(chain.ok());
  EXPECT_TRUE(says(chain->diagnostics, Severity::error, "LIMIT_EXCEEDED", "/nodes/256"));
}

// Wherever the documents have a number, one that no integer holds and one that wraps to 0 in 32 bits. Under the sanitizers this finds every
// conversion that is not asked for its range first.
TEST(GltfMalformed, NumbersBeyondEveryInteger) {
  const Folder folder;
  for (const char* name : {"everything.gltf", "draco.gltf"}) {
    std::ifstream stream(source_dir() / "tests/fuzz/corpus/gltf" / name);
    const Json document = Json::parse(stream), flat = document.flatten();
    for (const auto& [pointer, value] : flat.items()) {
      if (!value.is_number()) continue;
      for (const double number : {1e300, -1e300, 4294967296.0}) {
        Json changed = document;
        changed[Json::json_pointer(pointer)] = number;
        const auto imported = read_gltf(folder.write(name, changed.dump()));
        if (!imported.ok() || imported->diagnostics.has_errors()) continue;
        EXPECT_FALSE(validate(imported->scene).has_errors()) << pointer << " " << number;
      }
    }
  }
}

// A byte order mark is an error of a glTF, not a reason to take it for something else; a letter is no reason to take a text for a GLB.
TEST(GltfMalformed, WhatItIsByItsFirstBytes) {
  const auto importer = make_gltf_importer();
  const auto sniff = [&](std::string_view head) { return importer->sniff(std::as_bytes(std::span(head))); };
  EXPECT_EQ(sniff(std::string_view("glTF\2\0\0\0", 8)), 100);
  EXPECT_GE(sniff(R"({"asset": {"generator": "etendue", "version": "2.0"}})"), 80);  // a rig has it as a key
  EXPECT_EQ(sniff("generic lamp\nTILT=NONE"), 0);
  EXPECT_GE(sniff("\xEF\xBB\xBF{\"asset\": {\"version\": \"2.0\"}}"), 80);
  const Folder folder;
  GltfBuilder gltf;
  gltf.triangle();
  const auto marked = read_gltf(folder.write("marked.gltf", "\xEF\xBB\xBF" + gltf.text()));
  ASSERT_TRUE(marked.ok());
  ASSERT_TRUE(says(marked->diagnostics, Severity::error, "INVALID_JSON", ""));
}

TEST(GltfMalformed, ManyMeshesOfOneAccessorStayWithinTheLimit) {
  const Folder folder;
  GltfBuilder gltf;
  gltf.triangle();
  const Json primitive = gltf.primitive();
  for (int i = 0; i < 100; ++i) gltf.json["meshes"][0]["primitives"].push_back(primitive);
  ImportOptions options;
  options.max_items = 110;  // one array; all meshes together may hold eight times that
  const auto imported = read_gltf(gltf, folder, options);
  ASSERT_TRUE(imported.ok());
  EXPECT_LT(imported->scene.meshes.size(), 100u);
  // Said once: the meshes after it are not read at all.
  const auto& all = imported->diagnostics.all();
  EXPECT_EQ(std::count_if(all.begin(), all.end(), [](const Diagnostic& d) { return d.code == "LIMIT_EXCEEDED"; }), 1);
}

TEST(GltfMalformed, BrokenContainers) {
  const Folder folder;
  GltfBuilder gltf;
  gltf.triangle();
  const std::string whole = gltf.glb();
  ASSERT_TRUE(read_gltf(folder.write("whole.glb", whole)).ok());
  // Cut anywhere, a GLB is refused.
  for (std::size_t size = 0; size < whole.size(); size += 7)
    EXPECT_FALSE(read_gltf(folder.write("cut.glb", whole.substr(0, size))).ok()) << size;
  const auto missing = read_gltf(folder.path() / "missing.gltf");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().code, "FILE_UNREADABLE");
  const auto text = read_gltf(folder.write("text.gltf", "{\"asset\": {\"version\": \"2.0\"},\n ]"));
  ASSERT_FALSE(text.ok());
  EXPECT_EQ(text.error().where.line, 2);
  const auto old = read_gltf(folder.write("old.gltf", R"({"asset": {"version": "1.0"}})"));
  ASSERT_FALSE(old.ok());
  EXPECT_EQ(old.error().code, "UNKNOWN_ASSET_MAJOR_VERSION");
  EXPECT_EQ(old.error().where.pointer, "/asset/version");
}

// Bytes changed, removed and repeated at random (the same ones every time): whatever comes out, it comes back, and what passes for a
// scene without errors is one.
TEST(GltfMalformed, RandomDamageIsSurvived) {
  const Folder folder;
  GltfBuilder gltf;
  gltf.triangle();
  gltf.primitive()["indices"] = gltf.indices<std::uint16_t>({0, 1, 2});
  gltf.primitive()["attributes"]["TEXCOORD_0"] = gltf.floats({0, 0, 1, 0, 0, 1}, "VEC2");
  gltf.primitive()["material"] = 0;
  gltf.json["materials"] = Json::parse(R"([{"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}}])");
  gltf.json["textures"] = Json::parse(R"([{"source": 0}])");
  gltf.json["images"] = Json::array({{{"bufferView", gltf.view(png())}, {"mimeType", "image/png"}}});
  gltf.json["cameras"] = Json::parse(R"([{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}])");
  gltf.json["extensionsUsed"] = {"KHR_lights_punctual"};
  gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(R"([{"type": "spot", "spot": {"outerConeAngle": 0.5}}])");
  gltf.json["nodes"][0]["children"] = {1};
  gltf.json["nodes"].push_back({{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  std::mt19937 random(20240607);
  const auto below = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  int without_errors = 0;
  for (int round = 0; round < 600; ++round) {
    std::string bytes = round % 2 == 0 ? gltf.text() : gltf.glb();
    for (std::size_t change = 0; change <= below(3); ++change) {
      const std::size_t at = below(bytes.size());
      const char digits[] = "0123456789-.e\"[]{},: ";
      switch (below(4)) {
        case 0:
          bytes[at] = static_cast<char>(below(256));
          break;
        case 1:
          bytes[at] = digits[below(sizeof digits - 1)];
          break;
        case 2:
          bytes.erase(at, 1 + below(8));
          break;
        default:
          bytes.insert(at, bytes.substr(below(bytes.size()), below(32)));
      }
    }
    const auto imported = read_gltf(folder.write("damaged.gltf", bytes));
    if (!imported.ok() || imported->diagnostics.has_errors()) continue;
    ++without_errors;
    const Diagnostics faults = validate(imported->scene);
    EXPECT_FALSE(faults.has_errors()) << all_text(faults) << bytes;
  }
  EXPECT_GT(without_errors, 0);  // changes of names and white space hurt nothing
  EXPECT_LT(without_errors, 600);
}

}  // namespace
}  // namespace etendue::test
