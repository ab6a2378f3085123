// Meshes in the pose of the file: morph targets by their weights, skins by where their joints stand; both carried.
#include <algorithm>
#include <cmath>

#include "gltf_builder.h"

namespace etendue::test {
namespace {

// Sums and products of a few small numbers, stored in single precision.
constexpr float rounding = 1e-6F;

void expect_near(const Vec3f& a, const Vec3f& b) {
  EXPECT_NEAR(a.x, b.x, rounding);
  EXPECT_NEAR(a.y, b.y, rounding);
  EXPECT_NEAR(a.z, b.z, rounding);
}

bool carries(const Scene& scene, const std::string& pointer) {
  return std::find(scene.carried.parts.begin(), scene.carried.parts.end(), pointer) != scene.carried.parts.end();
}

GltfBuilder with_targets() {
  GltfBuilder gltf;
  gltf.triangle();
  gltf.primitive()["targets"] = Json::array(
      {{{"POSITION", gltf.floats({0, 0, 1, 0, 0, 2, 0, 0, 3}, "VEC3")}}, {{"POSITION", gltf.floats({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3")}}});
  return gltf;
}

// 3.7.2.2: base + sum of weight x displacement.
TEST(GltfPose, MorphTargetsByTheirWeights) {
  const Folder folder;
  GltfBuilder gltf = with_targets();
  gltf.json["meshes"][0]["weights"] = {0.5, -1};
  const auto imported = read_gltf(gltf, folder);
  ASSERT_TRUE(imported.ok());
  ASSERT_EQ(imported->scene.meshes.size(), 1u) << all_text(imported->diagnostics);
  const auto& p = imported->scene.meshes[0].positions;
  expect_near(p[0], {-1, 0, 0.5F});
  expect_near(p[1], {0, 0, 1});
  expect_near(p[2], {-1, 1, 1.5F});
  EXPECT_TRUE(carries(imported->scene, "/meshes/0/primitives/0/targets"));
}

// The node's weights come before the mesh's, so that two nodes may show the same mesh in two shapes.
TEST(GltfPose, EveryNodeHasItsOwnWeights) {
  const Folder folder;
  GltfBuilder gltf = with_targets();
  gltf.json["meshes"][0]["weights"] = {1, 0};
  gltf.json["nodes"] = Json::array({{{"mesh", 0}, {"weights", {0, 1}}}, {{"mesh", 0}}, {{"mesh", 0}, {"weights", {0, 0}}}});
  gltf.json["scenes"][0]["nodes"] = {0, 1, 2};
  const auto imported = read_gltf(gltf, folder);
  ASSERT_TRUE(imported.ok());
  const Scene& scene = imported->scene;
  ASSERT_EQ(scene.objects.size(), 3u) << all_text(imported->diagnostics);
  const auto first_corner = [&](std::size_t object) {
    return scene.meshes[std::get<MeshGeometry>(scene.objects[object].geometry).mesh].positions[0];
  };
  expect_near(first_corner(0), {1, 0, 0});
  expect_near(first_corner(1), {0, 0, 1});
  expect_near(first_corner(2), {0, 0, 0});
}

// Two joints. The first stands at (0, 0, 5) and was bound at the origin; the second is its child, turned by a quarter about +Z, bound 1 m
// up the X axis. The mesh's own node is far away, which must not matter (3.7.3.3).
GltfBuilder skinned() {
  GltfBuilder gltf;
  gltf.triangle();
  const double h = std::sqrt(0.5);
  gltf.json["nodes"] = Json::array({{{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}},
                                    {{"children", {2}}, {"translation", {0, 0, 5}}},
                                    {{"translation", {1, 0, 0}}, {"rotation", {0, 0, h, h}}}});
  gltf.json["scenes"][0]["nodes"] = {0, 1};
  std::vector<float> inverse(32, 0);
  for (const std::size_t i : {0u, 5u, 10u, 15u, 16u, 21u, 26u, 31u}) inverse[i] = 1;
  inverse[16 + 12] = -1;
  const int matrices = gltf.accessor({{"bufferView", gltf.view(inverse)}, {"componentType", 5126}, {"count", 2}, {"type", "MAT4"}});
  gltf.json["skins"] = Json::array({{{"joints", {1, 2}}, {"inverseBindMatrices", matrices}}});
  auto& attributes = gltf.primitive()["attributes"];
  attributes["JOINTS_0"] = gltf.accessor({{"bufferView", gltf.view<std::uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0})},
                                          {"componentType", 5121},
                                          {"count", 3},
                                          {"type", "VEC4"}});
  attributes["WEIGHTS_0"] = gltf.accessor({{"bufferView", gltf.view<float>({1, 0, 0, 0, 1, 0, 0, 0, 0.5F, 0.5F, 0, 0})},
                                           {"componentType", 5126},
                                           {"count", 3},
                                           {"type", "VEC4"}});
  attributes["NORMAL"] = gltf.floats({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3");
  return gltf;
}

TEST(GltfPose, JointsMoveTheirVertices) {
  const Folder folder;
  const auto imported = read_gltf(skinned(), folder);
  ASSERT_TRUE(imported.ok());
  EXPECT_FALSE(imported->diagnostics.has_errors()) << all_text(imported->diagnostics);
  const Scene& scene = imported->scene;
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(scene.objects[0].transform, Transform{});
  const Mesh& mesh = scene.meshes[std::get<MeshGeometry>(scene.objects[0].geometry).mesh];
  expect_near(mesh.positions[0], {0, 0, 5});  // joint 0 alone
  expect_near(mesh.positions[1], {1, 0, 5});  // bound at joint 1's place: it stays there
  // Half of joint 0, (0, 1, 5), and half of joint 1: (0, 1, 0) is (-1, 1, 0) from its place, turned (-1, -1, 0), so at (0, -1, 5).
  expect_near(mesh.positions[2], {0, 0, 5});
  expect_near(mesh.normals[0], {1, 0, 0});
  expect_near(mesh.normals[1], {0, 1, 0});
  for (const char* part :
       {"/skins/0", "/nodes/0/skin", "/meshes/0/primitives/0/attributes/JOINTS_0", "/meshes/0/primitives/0/attributes/WEIGHTS_0"})
    EXPECT_TRUE(carries(scene, part)) << part;
}

TEST(GltfPose, WhatIsWrongWithASkinIsAnError) {
  {
    const Folder folder;
    GltfBuilder gltf = skinned();
    gltf.json["skins"][0]["joints"] = {1};
    const auto imported = read_gltf(gltf, folder);
    ASSERT_TRUE(imported.ok());
    EXPECT_TRUE(says(imported->diagnostics, Severity::error, "ACCESSOR_JOINTS_INDEX_OOB", "/meshes/0/primitives/0/attributes/JOINTS_0"));
  }
  const Folder folder;
  GltfBuilder gltf = skinned();
  gltf.json["skins"][0]["joints"] = {1, 2, 0};
  const auto imported = read_gltf(gltf, folder);
  ASSERT_TRUE(imported.ok());
  EXPECT_TRUE(says(imported->diagnostics, Severity::error, "INVALID_IBM_ACCESSOR_COUNT", "/skins/0/inverseBindMatrices"));
}

// A weight or a joint may be any number; what it makes of the vertices is checked.
TEST(GltfPose, WhatLeavesSinglePrecisionIsAnError) {
  const Folder folder;
  GltfBuilder weighted = with_targets();
  weighted.json["meshes"][0]["weights"] = {1e39, 0};
  GltfBuilder far = skinned();
  far.json["nodes"][1]["translation"] = {1e300, 0, 0};
  for (const GltfBuilder& gltf : {weighted, far}) {
    const auto imported = read_gltf(gltf, folder);
    ASSERT_TRUE(imported.ok());
    EXPECT_TRUE(says(imported->diagnostics, Severity::error, "POSE_INVALID", "/meshes/0/primitives/0"));
    EXPECT_TRUE(imported->scene.meshes.empty());
  }
}

// What the fuzzer found: joints as signed bytes are wrong, and a negative one must not be taken for an index.
TEST(GltfPose, NegativeJointsAreAnError) {
  GltfBuilder gltf = skinned();
  gltf.primitive()["attributes"]["JOINTS_0"] =
      gltf.accessor({{"bufferView", gltf.view<std::int8_t>({-128, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0})},
                     {"componentType", 5120},
                     {"count", 3},
                     {"type", "VEC4"}});
  const Folder folder;
  const auto imported = read_gltf(gltf, folder);
  ASSERT_TRUE(imported.ok());
  EXPECT_TRUE(says(imported->diagnostics, Severity::error, "ACCESSOR_JOINTS_INDEX_OOB", "/meshes/0/primitives/0/attributes/JOINTS_0"));
}

// 200 nodes with one skin, whose matrices are many more than its joints: they are read once, or this limit would be met.
TEST(GltfPose, NodesShareWhatASkinIs) {
  GltfBuilder gltf = skinned();
  gltf.json["skins"][0]["inverseBindMatrices"] = gltf.accessor({{"componentType", 5126}, {"count", 100000}, {"type", "MAT4"}});
  const Json node = gltf.json["nodes"][0];
  for (int i = 0; i < 200; ++i) {
    gltf.json["scenes"][0]["nodes"].push_back(gltf.json["nodes"].size());
    gltf.json["nodes"].push_back(node);
  }
  ImportOptions options;
  options.max_memory = 16'000'000;  // 6.4 MB for the matrices
  const Folder folder;
  const auto imported = read_gltf(gltf, folder, options);
  ASSERT_TRUE(imported.ok());
  EXPECT_FALSE(says(imported->diagnostics, Severity::error, "LIMIT_EXCEEDED", "/accessors/4")) << all_text(imported->diagnostics);
  EXPECT_EQ(imported->scene.objects.size(), 201u) << all_text(imported->diagnostics);
}

}  // namespace
}  // namespace etendue::test
