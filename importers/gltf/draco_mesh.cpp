#include "draco_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "accessors.h"
#include "json_values.h"

#ifdef ETENDUE_DRACO
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#endif

namespace etendue::gltf {

#ifdef ETENDUE_DRACO

namespace {

// LEB128, as Draco writes its counts.
std::optional<std::uint64_t> varint(std::span<const char> bytes, std::size_t& at) {
  std::uint64_t value = 0;
  for (int shift = 0; shift < 63 && at < bytes.size(); shift += 7) {
    const auto byte = static_cast<std::uint8_t>(bytes[at++]);
    value |= std::uint64_t{byte & 0x7Fu} << shift;
    if ((byte & 0x80) == 0) return value;
  }
  return std::nullopt;
}

// The numbers that a vertex takes, as Draco holds them: integers of 32 bits on the way, then their own type.
std::uint64_t bytes_of_a_vertex(const draco::PointCloud& cloud) {
  std::uint64_t bytes = 0;
  for (std::int32_t i = 0; i < cloud.num_attributes(); ++i) {
    const draco::PointAttribute& attribute = *cloud.attribute(i);
    const int component = std::max(4, draco::DataTypeLength(attribute.data_type()));
    bytes += static_cast<std::uint64_t>(attribute.num_components()) * static_cast<std::uint64_t>(component);
  }
  return bytes;
}

// Draco's decoder, which asks before it makes room: for the triangles by the counts that they begin with, for the vertices by what their
// attributes say that they are. Either takes next to no bytes in the file.
template <class Decoder>
class Limited final : public Decoder {
 public:
  Limited(Asset& asset, const std::string& pointer) : asset_(asset), pointer_(pointer) {}

  Result<std::unique_ptr<draco::Mesh>> decode(draco::DecoderBuffer& buffer) {
    auto mesh = std::make_unique<draco::Mesh>();
    const draco::DecoderOptions options;
    const draco::Status status = this->Decode(options, &buffer, mesh.get());
    if (!room_) return room_.error();
    if (!status.ok())
      return asset_.failure("DRACO_INVALID", fmt::format("the compressed mesh cannot be decoded: {}", status.error_msg_string()), pointer_);
    return mesh;
  }

 protected:
  // Bitstream 2.2: the numbers of triangles and vertices, in one order or the other; edgebreaker says then for how many attributes there is
  // a second table of corners.
  bool DecodeConnectivity() override {
    const std::span<const char> rest(this->buffer()->data_head(), static_cast<std::size_t>(this->buffer()->remaining_size()));
    std::size_t at = 0;
    const auto first = varint(rest, at), second = varint(rest, at);
    if (!first || !second) return false;
    const std::uint64_t count = std::max(*first, *second), limit = asset_.options().max_items;
    const bool has_more = std::is_same_v<Decoder, draco::MeshEdgebreakerDecoder> && at < rest.size();
    const std::uint64_t tables = 1 + (has_more ? static_cast<std::uint8_t>(rest[at]) : 0);
    if (count > limit) {
      room_ = asset_.over_limit(fmt::format("a compressed mesh of {} triangles or vertices", count), "max_items", limit, pointer_);
    } else {
      room_ = asset_.claim_decoded(count * 3 * sizeof(std::uint32_t) * tables, pointer_);
    }
    return room_.ok() && Decoder::DecodeConnectivity();
  }

  bool DecodeAllAttributes() override {
    const std::uint64_t count = this->point_cloud()->num_points(), limit = asset_.options().max_items;
    if (count > limit) {  // where triangles share a vertex that has several normals, say, there are more than at first
      room_ = asset_.over_limit(fmt::format("a compressed mesh of {} vertices", count), "max_items", limit, pointer_);
    } else {
      room_ = asset_.claim_decoded(count * bytes_of_a_vertex(*this->point_cloud()), pointer_);
    }
    return room_.ok() && Decoder::DecodeAllAttributes();
  }

 private:
  Asset& asset_;
  const std::string& pointer_;
  Status room_ = Done{};
};

// The extension is about triangles in bitstream 2.2.
Result<std::unique_ptr<draco::Mesh>> decoded(Asset& asset, const SharedBytes& bytes, const std::string& pointer) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::DecoderBuffer head = buffer;
  draco::DracoHeader header;
  if (!draco::PointCloudDecoder::DecodeHeader(&head, &header).ok())
    return asset.failure("DRACO_INVALID", "the bytes do not begin as Draco's do", pointer);
  if (header.encoder_type != draco::TRIANGULAR_MESH || header.version_major != 2 || header.version_minor != 2)
    return asset.failure(
        "DRACO_INVALID",
        fmt::format("expected triangles in version 2.2, found {} in version {}.{}",
                    header.encoder_type == draco::TRIANGULAR_MESH ? "triangles" : "points", header.version_major, header.version_minor),
        pointer);
  if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING) return Limited<draco::MeshSequentialDecoder>(asset, pointer).decode(buffer);
  if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING)
    return Limited<draco::MeshEdgebreakerDecoder>(asset, pointer).decode(buffer);
  return asset.failure("DRACO_INVALID", fmt::format("Draco has no method {}", header.encoder_method), pointer);
}

std::vector<float> numbers_of(const draco::PointAttribute& attribute, std::size_t width, std::uint32_t points) {
  std::vector<float> numbers(width * points);
  for (std::uint32_t i = 0; i < points; ++i)
    attribute.ConvertValue<float>(attribute.mapped_index(draco::PointIndex(i)), static_cast<std::int8_t>(width),
                                  numbers.data() + i * width);
  // Signed bytes and shorts have one value more below zero (3.6.2.2).
  if (attribute.normalized())
    for (float& x : numbers) x = std::max(x, -1.0F);
  return numbers;
}

}  // namespace

bool draco_is_built() { return true; }

Result<DracoMesh> decode_draco(Asset& asset, const nlohmann::json& extension, const std::string& pointer) {
  const auto bytes = asset.view(int_index_of(extension, "bufferView"));
  if (!bytes) return bytes.error();
  const auto decoded_mesh = decoded(asset, *bytes, pointer);
  if (!decoded_mesh) return decoded_mesh.error();
  const draco::Mesh& mesh = **decoded_mesh;

  DracoMesh out;
  out.indices.reserve(std::size_t{mesh.num_faces()} * 3);
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
    for (const draco::PointIndex& corner : mesh.face(f)) out.indices.push_back(corner.value());
  const auto names = extension.find("attributes");
  if (names == extension.end() || !names->is_object()) return out;
  for (const auto& [name, id] : names->items()) {
    const bool is_id = id.is_number_integer() && id.get<double>() >= 0 && id.get<double>() <= std::numeric_limits<std::uint32_t>::max();
    const draco::PointAttribute* attribute = is_id ? mesh.GetAttributeByUniqueId(id.get<std::uint32_t>()) : nullptr;
    const std::size_t width = attribute != nullptr ? static_cast<std::size_t>(attribute->num_components()) : 0;
    if (width < 1 || width > 4)
      return asset.failure("DRACO_INVALID", fmt::format("the compressed mesh has no attribute {} of 1 to 4 components", id.dump()),
                           pointer_to(pointer + "/attributes", name));
    if (auto room = asset.claim_memory(std::uint64_t{mesh.num_points()} * width * sizeof(float), pointer); !room) return room.error();
    auto numbers = numbers_of(*attribute, width, mesh.num_points());
    if (!all_finite(numbers))
      return asset.failure("ACCESSOR_INVALID_FLOAT", "expected finite numbers, found infinite ones or NaN",
                           pointer_to(pointer + "/attributes", name));
    out.attributes.emplace(name, DracoMesh::Attribute{width, std::move(numbers)});
  }
  return out;
}

#else

bool draco_is_built() { return false; }

Result<DracoMesh> decode_draco(Asset& asset, const nlohmann::json&, const std::string& pointer) {
  return asset.failure("NOT_BUILT", "this build decodes no Draco meshes: Draco's library was not there", pointer);
}

#endif

}  // namespace etendue::gltf
