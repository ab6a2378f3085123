#include "buffer_writer.h"

#include <algorithm>
#include <limits>

namespace etendue::gltf {
namespace {

constexpr int unsigned_short = 5123, unsigned_int = 5125, single = 5126;

}  // namespace

std::size_t BufferWriter::view(std::span<const std::byte> bytes, int target) {
  bytes_.resize((bytes_.size() + 3) / 4 * 4);
  document_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}, {"target", target}});
  for (const std::byte byte : bytes) bytes_.push_back(static_cast<std::uint8_t>(byte));
  return document_["bufferViews"].size() - 1;
}

template <class Element>
std::size_t BufferWriter::floats(const std::vector<Element>& elements, const char* type) {
  const std::size_t at = view(std::as_bytes(std::span(elements)), array_buffer);
  document_["accessors"].push_back({{"bufferView", at}, {"componentType", single}, {"count", elements.size()}, {"type", type}});
  return document_["accessors"].size() - 1;
}

Json BufferWriter::primitive(const Mesh& mesh) {
  Json attributes = Json::object();
  attributes["POSITION"] = floats(mesh.positions, "VEC3");
  Vec3f low = mesh.positions[0], high = low;
  for (const Vec3f& p : mesh.positions)
    for (int c = 0; c < 3; ++c) low[c] = std::min(low[c], p[c]), high[c] = std::max(high[c], p[c]);
  Json& positions = document_["accessors"].back();
  positions["min"] = {low.x, low.y, low.z};
  positions["max"] = {high.x, high.y, high.z};
  if (!mesh.normals.empty()) attributes["NORMAL"] = floats(mesh.normals, "VEC3");
  if (!mesh.normals.empty() && !mesh.tangents.empty()) attributes["TANGENT"] = floats(mesh.tangents, "VEC4");
  if (!mesh.uvs.empty()) attributes["TEXCOORD_0"] = floats(mesh.uvs, "VEC2");
  if (!mesh.colours.empty()) attributes["COLOR_0"] = floats(mesh.colours, "VEC4");

  // The largest index of each type restarts a strip.
  Json indices = {{"componentType", unsigned_int}, {"count", mesh.indices.size()}, {"type", "SCALAR"}};
  if (mesh.positions.size() < std::numeric_limits<std::uint16_t>::max()) {
    const std::vector<std::uint16_t> narrow(mesh.indices.begin(), mesh.indices.end());
    indices["bufferView"] = view(std::as_bytes(std::span(narrow)), element_array_buffer);
    indices["componentType"] = unsigned_short;
  } else {
    indices["bufferView"] = view(std::as_bytes(std::span(mesh.indices)), element_array_buffer);
  }
  document_["accessors"].push_back(std::move(indices));
  return {{"attributes", std::move(attributes)}, {"indices", document_["accessors"].size() - 1}};
}

std::vector<std::uint8_t> BufferWriter::finish() {
  if (!bytes_.empty()) document_["buffers"] = Json::array({{{"byteLength", bytes_.size()}}});
  return std::move(bytes_);
}

}  // namespace etendue::gltf
