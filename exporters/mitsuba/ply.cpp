#include "ply.h"

#include <bit>
#include <cstdint>
#include <string>

namespace etendue::mitsuba {
namespace {

// Little-endian on every machine.
void put(std::vector<std::byte>& bytes, std::uint32_t bits) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::byte>(bits >> shift & 0xffu));
}
void put(std::vector<std::byte>& bytes, float value) { put(bytes, std::bit_cast<std::uint32_t>(value)); }
void put(std::vector<std::byte>& bytes, const Vec3f& v) { put(bytes, v.x), put(bytes, v.y), put(bytes, v.z); }

std::string header_of(const Mesh& mesh) {
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.positions.size()) + "\n";
  text += "property float x\nproperty float y\nproperty float z\n";
  if (!mesh.normals.empty()) text += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!mesh.uvs.empty()) text += "property float u\nproperty float v\n";
  text += "element face " + std::to_string(mesh.indices.size() / 3) + "\nproperty list uchar int vertex_index\nend_header\n";
  return text;
}

}  // namespace

std::vector<std::byte> to_ply(const Mesh& mesh) {
  const std::string header = header_of(mesh);
  std::vector<std::byte> bytes;
  bytes.reserve(header.size() + mesh.positions.size() * 32 + mesh.indices.size() / 3 * 13);
  for (const char c : header) bytes.push_back(static_cast<std::byte>(c));
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    put(bytes, mesh.positions[i]);
    if (!mesh.normals.empty()) put(bytes, mesh.normals[i]);
    if (!mesh.uvs.empty()) put(bytes, mesh.uvs[i].x), put(bytes, mesh.uvs[i].y);
  }
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    bytes.push_back(std::byte{3});
    for (std::size_t corner = 0; corner < 3; ++corner) put(bytes, mesh.indices[i + corner]);
  }
  return bytes;
}

}  // namespace etendue::mitsuba
