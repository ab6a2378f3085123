// Meshes that Draco's and meshoptimizer's own encoders have compressed.
#include <algorithm>
#include <cmath>

#include "gltf_builder.h"
#include "importers/gltf/draco_mesh.h"
#include "importers/gltf/meshopt.h"

#ifdef ETENDUE_DRACO
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#endif
#ifdef ETENDUE_MESHOPT
#include <meshoptimizer.h>
#endif

namespace etendue::test {
namespace {

// A wavy sheet of n x n vertices over the unit square.
struct Sheet {
  std::vector<float> positions;
  std::vector<std::uint32_t> indices;
};
Sheet sheet(std::uint32_t n) {
  Sheet s;
  for (std::uint32_t y = 0; y < n; ++y)
    for (std::uint32_t x = 0; x < n; ++x) {
      const float u = static_cast<float>(x) / static_cast<float>(n - 1), v = static_cast<float>(y) / static_cast<float>(n - 1);
      s.positions.insert(s.positions.end(), {u, v, 0.1F * std::sin(7 * u + 3 * v)});
    }
  for (std::uint32_t y = 0; y + 1 < n; ++y)
    for (std::uint32_t x = 0; x + 1 < n; ++x) {
      const std::uint32_t a = y * n + x;
      s.indices.insert(s.indices.end(), {a, a + 1, a + n, a + 1, a + n + 1, a + n});
    }
  return s;
}

// An accessor of the sheet's positions, wherever their bytes are.
Json positions_of(const Sheet& s) {
  Json accessor = {{"componentType", 5126}, {"count", s.positions.size() / 3}, {"type", "VEC3"}};
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<float> column;
    for (std::size_t i = c; i < s.positions.size(); i += 3) column.push_back(s.positions[i]);
    accessor["min"].push_back(*std::min_element(column.begin(), column.end()));
    accessor["max"].push_back(*std::max_element(column.begin(), column.end()));
  }
  return accessor;
}

double area_of_triangles(const Sheet& s) {
  Mesh mesh;
  for (std::size_t i = 0; i + 2 < s.positions.size(); i += 3)
    mesh.positions.push_back({s.positions[i], s.positions[i + 1], s.positions[i + 2]});
  mesh.indices = s.indices;
  return area_of(mesh, {});
}

#ifdef ETENDUE_MESHOPT

// A bufferView of `count` elements that the file holds compressed, its uncompressed buffer a fallback without bytes.
int compressed_view(GltfBuilder& gltf, const std::vector<unsigned char>& encoded, std::size_t stride, std::size_t count, const char* mode,
                    const char* filter = "NONE") {
  const int stored = gltf.view(encoded);
  const Json source = gltf.json["bufferViews"][static_cast<std::size_t>(stored)];
  gltf.json["bufferViews"].push_back({{"buffer", 1},
                                      {"byteLength", stride * count},
                                      {"extensions",
                                       {{"EXT_meshopt_compression",
                                         {{"buffer", 0},
                                          {"byteOffset", source["byteOffset"]},
                                          {"byteLength", source["byteLength"]},
                                          {"byteStride", stride},
                                          {"count", count},
                                          {"mode", mode},
                                          {"filter", filter}}}}}});
  return static_cast<int>(gltf.json["bufferViews"].size()) - 1;
}

struct MeshoptFile {
  GltfBuilder gltf;
  int positions = 0, indices = 0;
};
MeshoptFile meshopt_file(const Sheet& s, const char* mode) {
  const std::size_t vertices = s.positions.size() / 3;
  std::vector<unsigned char> encoded(meshopt_encodeVertexBufferBound(vertices, 12));
  encoded.resize(meshopt_encodeVertexBuffer(encoded.data(), encoded.size(), s.positions.data(), vertices, 12));
  MeshoptFile file;
  file.positions = compressed_view(file.gltf, encoded, 12, vertices, "ATTRIBUTES");
  const bool triangles = std::string(mode) == "TRIANGLES";
  std::vector<unsigned char> order(triangles ? meshopt_encodeIndexBufferBound(s.indices.size(), vertices)
                                             : meshopt_encodeIndexSequenceBound(s.indices.size(), vertices));
  order.resize(triangles ? meshopt_encodeIndexBuffer(order.data(), order.size(), s.indices.data(), s.indices.size())
                         : meshopt_encodeIndexSequence(order.data(), order.size(), s.indices.data(), s.indices.size()));
  file.indices = compressed_view(file.gltf, order, 4, s.indices.size(), mode);
  Json& json = file.gltf.json;
  json["extensionsUsed"] = json["extensionsRequired"] = {"EXT_meshopt_compression"};
  json["accessors"] = Json::array(
      {positions_of(s), {{"bufferView", file.indices}, {"componentType", 5125}, {"count", s.indices.size()}, {"type", "SCALAR"}}});
  json["accessors"][0]["bufferView"] = file.positions;
  json["meshes"] = Json::array({{{"primitives", Json::array({{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}})}}});
  json["nodes"] = Json::array({{{"mesh", 0}}});
  json["buffers"] = Json::array(
      {{{"byteLength", file.gltf.bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(file.gltf.bytes)}},
       {{"byteLength", 12 * vertices + 4 * s.indices.size()}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}});
  return file;
}

// meshoptimizer's streams are lossless: bit for bit what went in; triangles may begin at another corner.
TEST(GltfCompressed, MeshoptComesBackAsItWas) {
  const Sheet s = sheet(40);
  for (const char* mode : {"TRIANGLES", "INDICES"}) {
    SCOPED_TRACE(mode);
    const Folder folder;
    const auto imported = read_gltf(meshopt_file(s, mode).gltf, folder);
    ASSERT_TRUE(imported.ok());
    EXPECT_FALSE(imported->diagnostics.has_errors()) << all_text(imported->diagnostics);
    ASSERT_EQ(imported->scene.meshes.size(), 1u);
    const Mesh& mesh = imported->scene.meshes[0];
    ASSERT_EQ(mesh.positions.size() * 3, s.positions.size());
    EXPECT_EQ(std::memcmp(mesh.positions.data(), s.positions.data(), s.positions.size() * sizeof(float)), 0);
    ASSERT_EQ(mesh.indices.size(), s.indices.size());
    for (std::size_t i = 0; i < s.indices.size(); i += 3) {
      const std::uint32_t a = s.indices[i], b = s.indices[i + 1], c = s.indices[i + 2];
      const std::array<std::uint32_t, 3> found = {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
      using Corners = std::array<std::uint32_t, 3>;
      ASSERT_TRUE(found == (Corners{a, b, c}) || found == (Corners{b, c, a}) || found == (Corners{c, a, b})) << i;
    }
  }
}

TEST(GltfCompressed, BrokenMeshoptIsAnError) {
  const Sheet s = sheet(8);
  const char* place = "/bufferViews/1/extensions/EXT_meshopt_compression";
  const auto broken = [&](const char* key, const Json& value, const char* code) {
    const Folder folder;
    MeshoptFile file = meshopt_file(s, "TRIANGLES");
    file.gltf.json["bufferViews"][1]["extensions"]["EXT_meshopt_compression"][key] = value;
    const auto imported = read_gltf(file.gltf, folder);
    ASSERT_TRUE(imported.ok());
    EXPECT_TRUE(says(imported->diagnostics, Severity::error, code, place)) << key;
  };
  broken("byteLength", 10, "MESHOPT_INVALID");
  broken("byteStride", 16, "MESHOPT_INVALID");
  broken("count", 2000000000, "LIMIT_EXCEEDED");
}

#endif

#ifdef ETENDUE_DRACO

GltfBuilder draco_file(const Sheet& s, int bits) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(s.indices.size() / 3));
  const int attribute = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (std::size_t f = 0; f < s.indices.size() / 3; ++f) {
    const auto corner = [&](std::size_t k) { return s.positions.data() + std::size_t{3} * s.indices[3 * f + k]; };
    builder.SetAttributeValuesForFace(attribute, draco::FaceIndex(static_cast<std::uint32_t>(f)), corner(0), corner(1), corner(2));
  }
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());

  GltfBuilder gltf;
  const int view = gltf.view(std::vector<char>(buffer.data(), buffer.data() + buffer.size()));
  gltf.json["extensionsUsed"] = gltf.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  gltf.json["accessors"] = Json::array({positions_of(s), {{"componentType", 5125}, {"count", s.indices.size()}, {"type", "SCALAR"}}});
  gltf.json["accessors"][0]["count"] = mesh->num_points();
  const int id = static_cast<int>(mesh->GetNamedAttribute(draco::GeometryAttribute::POSITION)->unique_id());
  gltf.json["meshes"] = Json::array(
      {{{"primitives",
         Json::array({{{"attributes", {{"POSITION", 0}}},
                       {"indices", 1},
                       {"extensions", {{"KHR_draco_mesh_compression", {{"bufferView", view}, {"attributes", {{"POSITION", id}}}}}}}}})}}});
  gltf.json["nodes"] = Json::array({{{"mesh", 0}}});
  return gltf;
}

// Quantised to q bits, a coordinate is off by at most half a step of the largest extent, here 1: 1/2 / (2^q - 1).
TEST(GltfCompressed, DracoComesBackWithinItsQuantisation) {
  const Sheet s = sheet(40);
  constexpr int bits = 16;
  const Folder folder;
  const auto imported = read_gltf(draco_file(s, bits), folder);
  ASSERT_TRUE(imported.ok());
  EXPECT_FALSE(imported->diagnostics.has_errors()) << all_text(imported->diagnostics);
  ASSERT_EQ(imported->scene.meshes.size(), 1u);
  const Mesh& mesh = imported->scene.meshes[0];
  ASSERT_EQ(mesh.indices.size(), s.indices.size());
  const double step = 1 / (std::pow(2.0, bits) - 1);
  for (const Vec3f& p : mesh.positions) {
    // u and v are multiples of 1/39, z follows from them: its slope is at most .7 and .3.
    const double u = std::round(p.x * 39) / 39, v = std::round(p.y * 39) / 39;
    ASSERT_NEAR(p.x, u, 0.51 * step);
    ASSERT_NEAR(p.y, v, 0.51 * step);
    ASSERT_NEAR(p.z, 0.1 * std::sin(7 * u + 3 * v), 0.51 * step + 1e-6);
  }
  // Every triangle there once and the right way round: the areas add up. Lengths are off by a step, edges are 1/39 long.
  EXPECT_NEAR(area_of(mesh, {}) / area_of_triangles(s), 1, 4 * 39 * step);
}

TEST(GltfCompressed, BrokenDracoIsAnError) {
  const Folder folder;
  GltfBuilder gltf = draco_file(sheet(8), 12);
  for (std::size_t i = 40; i < gltf.bytes.size(); ++i) gltf.bytes[i] = static_cast<std::uint8_t>(i * 37);
  const auto imported = read_gltf(gltf, folder);
  ASSERT_TRUE(imported.ok());
  EXPECT_TRUE(imported->diagnostics.has_errors());
}

using Stream = std::vector<std::uint8_t>;

// A primitive whose compressed mesh is these bytes.
GltfBuilder draco_stream(const Stream& stream) {
  GltfBuilder gltf = draco_file(sheet(8), 12);
  const int view = gltf.view(stream);
  gltf.primitive()["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = view;
  return gltf;
}
Stream operator+(Stream head, const Stream& tail) {
  head.insert(head.end(), tail.begin(), tail.end());
  return head;
}
// "DRACO", the bitstream's version, triangles, the method, flags.
Stream draco_header(std::uint8_t version, std::uint8_t method, std::uint8_t flags = 0) {
  return {'D', 'R', 'A', 'C', 'O', version, 2, 1, method, 0, flags};
}
constexpr std::uint8_t sequential = 0, edgebreaker = 1, with_metadata = 0x80;
const Stream nine_million = {0xC0, 0xA8, 0xA5, 0x04}, four_thousand_million = {0x80, 0xD0, 0xAC, 0xF3, 0x0E}, one = {1};

// Bombs: streams of some forty bytes that ask for gigabytes. Each is an error that names the limit and its option before room is made.
TEST(GltfCompressed, DracoBombsMeetALimit) {
  const std::string place = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
  const auto expect_limit = [&](const Stream& stream, const std::string& option, const ImportOptions& options = {}) {
    SCOPED_TRACE(option);
    const Folder folder;
    const auto imported = read_gltf(draco_stream(stream), folder, options);
    ASSERT_TRUE(imported.ok());
    ASSERT_TRUE(says(imported->diagnostics, Severity::error, "LIMIT_EXCEEDED", place));
    for (const Diagnostic& d : imported->diagnostics.all()) {
      if (d.code != "LIMIT_EXCEEDED") continue;
      EXPECT_NE(d.text.find(option), std::string::npos) << d.text;
      EXPECT_NE(d.hint.find("--limit " + option + "="), std::string::npos) << d.hint;
    }
  };
  expect_limit(draco_header(2, sequential) + four_thousand_million + one, "max_items");
  expect_limit(draco_header(2, edgebreaker) + Stream{0} + one + four_thousand_million, "max_items");
  // No metadata of attributes, no entries, nothing below: the counts come behind it.
  expect_limit(draco_header(2, sequential, with_metadata) + Stream{0, 0, 0} + one + four_thousand_million, "max_items");
  // One triangle, three vertices of 255 doubles: 6120 bytes, more than the data URI and the indices leave.
  constexpr std::uint8_t raw = 1, generic = 4, doubles = 10;
  ImportOptions little;
  little.max_decoded = 5000;
  expect_limit(draco_header(2, sequential) + one + Stream{3, raw, 0, 1, 2} + Stream{1, 1, generic, doubles, 255, 0, 0, 0}, "max_decoded",
               little);
  // 9 million triangles, and of 255 attributes a table of corners each: 27 GB.
  expect_limit(draco_header(2, edgebreaker) + Stream{0} + nine_million + nine_million + Stream{255}, "max_decoded");
}

TEST(GltfCompressed, DracoOfAnotherKindIsNamed) {
  const std::string place = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
  Stream points = draco_header(2, 0), unknown = draco_header(2, 7);
  points[7] = 0;
  for (const Stream& stream : {draco_header(1, sequential), points, unknown, Stream{'D', 'R', 'A'}}) {
    const Folder folder;
    const auto imported = read_gltf(draco_stream(stream), folder);
    ASSERT_TRUE(imported.ok());
    EXPECT_TRUE(says(imported->diagnostics, Severity::error, "DRACO_INVALID", place));
  }
}

// One stream that many primitives name is decoded for each of them: the limit counts all of them together.
TEST(GltfCompressed, DecodedBytesAddUp) {
  GltfBuilder gltf = draco_file(sheet(20), 12);
  ImportOptions options;
  options.max_decoded = 150'000;  // the sheet takes 722 x 12 bytes of indices and 400 x 12 of vertices, and its data URI some more
  const Folder folder;
  EXPECT_FALSE(read_gltf(gltf, folder, options)->diagnostics.has_errors());
  const Json primitive = gltf.primitive();
  for (int i = 0; i < 20; ++i) gltf.json["meshes"][0]["primitives"].push_back(primitive);
  const auto imported = read_gltf(gltf, folder, options);
  ASSERT_TRUE(imported.ok());
  EXPECT_NE(all_text(imported->diagnostics).find("max_decoded"), std::string::npos);
}

#endif

}  // namespace
}  // namespace etendue::test
