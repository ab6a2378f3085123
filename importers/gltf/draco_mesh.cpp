#include "draco_mesh.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "accessors.h"

#ifdef ETENDUE_DRACO
#include <draco/compression/decode.h>
#endif

namespace etendue::gltf {

#ifdef ETENDUE_DRACO

namespace {

// LEB128, as Draco writes its counts.
std::optional<std::uint64_t> varint(const SharedBytes& bytes, std::size_t& at) {
  std::uint64_t value = 0;
  for (int shift = 0; shift < 63 && at < bytes.size(); shift += 7) {
    const std::uint8_t byte = bytes.data()[at++];
    value |= std::uint64_t{byte & 0x7Fu} << shift;
    if ((byte & 0x80) == 0) return value;
  }
  return std::nullopt;
}

// The larger of the two counts that a mesh begins with (bitstream 2.2: "DRACO", version, type, method, flags; sequential: faces, points;
// edgebreaker: a byte, then vertices, faces), before Draco makes room for as many. None for streams with metadata or of older versions,
// whose counts stand elsewhere.
std::optional<std::uint64_t> announced(const SharedBytes& bytes) {
  constexpr std::size_t header = 11;
  if (bytes.size() < header) return std::nullopt;
  const std::uint8_t* b = bytes.data();
  const bool old = b[5] < 2 || (b[5] == 2 && b[6] < 2), metadata = (b[10] & 0x80) != 0;
  if (old || metadata) return std::nullopt;
  std::size_t at = header + (b[8] == 1 ? 1 : 0);
  const auto first = varint(bytes, at), second = varint(bytes, at);
  return first && second ? std::optional(std::max(*first, *second)) : std::nullopt;
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
  const auto bytes = asset.view(static_cast<int>(number_or(extension, "bufferView", -1)));
  if (!bytes) return bytes.error();
  const std::size_t limit = asset.options().max_items;
  if (const auto count = announced(*bytes); count && *count > limit)
    return asset.failure("LIMIT_EXCEEDED", fmt::format("a compressed mesh of {} elements is over max_items, {}", *count, limit), pointer);

  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    return asset.failure("DRACO_INVALID", fmt::format("the compressed mesh cannot be decoded: {}", decoded.status().error_msg_string()),
                         pointer);
  const draco::Mesh& mesh = *decoded.value();
  if (mesh.num_points() > limit || mesh.num_faces() > limit)
    return asset.failure("LIMIT_EXCEEDED", fmt::format("a compressed mesh of {} vertices is over max_items, {}", mesh.num_points(), limit),
                         pointer);

  DracoMesh out;
  out.indices.reserve(std::size_t{mesh.num_faces()} * 3);
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f)
    for (const draco::PointIndex& corner : mesh.face(f)) out.indices.push_back(corner.value());
  const auto names = extension.find("attributes");
  if (names == extension.end() || !names->is_object()) return out;
  for (const auto& [name, id] : names->items()) {
    const draco::PointAttribute* attribute = id.is_number_unsigned() ? mesh.GetAttributeByUniqueId(id.get<std::uint32_t>()) : nullptr;
    const std::size_t width = attribute != nullptr ? static_cast<std::size_t>(attribute->num_components()) : 0;
    if (width < 1 || width > 4)
      return asset.failure("DRACO_INVALID", fmt::format("the compressed mesh has no attribute {} of 1 to 4 components", id.dump()),
                           pointer_to(pointer + "/attributes", name));
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
