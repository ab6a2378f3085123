#include "container.h"

#include <cstdint>

#include <fmt/format.h>

namespace etendue::gltf {
namespace {

constexpr std::uint32_t glb_magic = 0x46546C67;     // "glTF"
constexpr std::uint32_t json_chunk = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t binary_chunk = 0x004E4942;  // "BIN\0"
constexpr std::size_t header_size = 12, chunk_header_size = 8;

// Little-endian, whatever the machine; the caller has checked that 4 bytes are there.
std::uint32_t u32_at(std::span<const std::byte> bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | std::to_integer<std::uint32_t>(bytes[offset + static_cast<std::size_t>(i)]);
  return value;
}

Error glb_error(const char* code, std::string text) { return {code, std::move(text), {}, {}, {}}; }

}  // namespace

bool is_glb(std::span<const std::byte> head) { return head.size() >= 4 && u32_at(head, 0) == glb_magic; }

Result<Container> open_container(std::span<const std::byte> bytes) {
  if (!is_glb(bytes)) return Container{{reinterpret_cast<const char*>(bytes.data()), bytes.size()}, std::nullopt};

  if (bytes.size() < header_size + chunk_header_size)
    return glb_error("GLB_UNEXPECTED_END_OF_HEADER", fmt::format("expected a GLB of at least 20 bytes, found {}", bytes.size()));
  if (const std::uint32_t version = u32_at(bytes, 4); version != 2)
    return glb_error("GLB_INVALID_VERSION", fmt::format("expected GLB version 2, found {}", version));
  if (const std::uint32_t length = u32_at(bytes, 8); length != bytes.size())
    return glb_error("GLB_LENGTH_MISMATCH", fmt::format("the header says {} bytes, the file has {}", length, bytes.size()));

  Container container;
  bool json_found = false;
  for (std::size_t offset = header_size; offset < bytes.size();) {
    if (bytes.size() - offset < chunk_header_size)
      return glb_error("GLB_UNEXPECTED_END_OF_CHUNK_HEADER", fmt::format("a chunk header of 8 bytes does not fit at offset {}", offset));
    const std::size_t length = u32_at(bytes, offset);
    const std::uint32_t type = u32_at(bytes, offset + 4);
    if (length > bytes.size() - offset - chunk_header_size)
      return glb_error("GLB_CHUNK_TOO_BIG",
                       fmt::format("the chunk at offset {} of {} bytes goes beyond the end of the file", offset, length));
    if (length % 4 != 0)
      return glb_error("GLB_CHUNK_LENGTH_UNALIGNED",
                       fmt::format("the chunk at offset {} has {} bytes, not a multiple of 4", offset, length));
    const auto chunk = bytes.subspan(offset + chunk_header_size, length);
    if (!json_found) {
      if (type != json_chunk)
        return glb_error("GLB_UNEXPECTED_FIRST_CHUNK", fmt::format("expected JSON first, found chunk type {:#010x}", type));
      container.json = {reinterpret_cast<const char*>(chunk.data()), chunk.size()};
      json_found = true;
    } else if (type == json_chunk || (type == binary_chunk && container.binary)) {
      return glb_error("GLB_DUPLICATE_CHUNK", fmt::format("a second chunk of type {:#010x} at offset {}", type, offset));
    } else if (type == binary_chunk) {
      container.binary = chunk;
    }  // Chunks of other types are to be ignored (4.4.3).
    offset += chunk_header_size + length;
  }
  return container;
}

}  // namespace etendue::gltf
