#include "container.h"

#include <algorithm>

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

// Walks the chunks. It goes on after faults that leave the chunks in their places.
class GlbReader {
 public:
  GlbReader(std::span<const std::byte> bytes, std::vector<Diagnostic>& diagnostics) : bytes_(bytes), diagnostics_(diagnostics) {}

  std::optional<Container> read() {
    if (!read_header()) return std::nullopt;
    std::size_t offset = header_size;
    for (std::size_t number = 0; offset < end_; ++number) {
      if (end_ - offset < chunk_header_size) {
        error("GLB_UNEXPECTED_END_OF_CHUNK_HEADER", "a chunk header of 8 bytes does not fit", end_);
        return std::nullopt;
      }
      const std::size_t length = u32_at(bytes_, offset);
      read_chunk(number, offset, length, u32_at(bytes_, offset + 4));
      if (length > bytes_.size() - offset - chunk_header_size) {
        error("GLB_UNEXPECTED_END_OF_CHUNK_DATA", "the file ends inside a chunk", bytes_.size());
        return std::nullopt;
      }
      offset += chunk_header_size + length;
    }
    if (declared_ > bytes_.size() || offset > declared_)
      error("GLB_LENGTH_MISMATCH", fmt::format("the header says {} bytes, found {}", declared_, bytes_.size()), offset);
    if (declared_ < bytes_.size() && declared_ >= header_size)
      add(Severity::warning, "GLB_EXTRA_DATA", fmt::format("{} bytes after the end", bytes_.size() - declared_), declared_);
    if (!has_json_) {
      if (diagnostics_.empty()) error("GLB_UNEXPECTED_FIRST_CHUNK", "expected a chunk of JSON, found none", header_size);
      return std::nullopt;
    }
    return container_;
  }

 private:
  void add(Severity severity, const char* code, std::string text, std::size_t offset) {
    diagnostics_.push_back({severity, code, std::move(text), {"", 0, 0, "", static_cast<std::int64_t>(offset)}, {}});
  }
  void error(const char* code, std::string text, std::size_t offset) { add(Severity::error, code, std::move(text), offset); }

  bool read_header() {
    container_.is_glb = true;
    if (bytes_.size() < header_size) {
      error("GLB_UNEXPECTED_END_OF_HEADER", fmt::format("expected a header of 12 bytes, found {}", bytes_.size()), bytes_.size());
      return false;
    }
    if (u32_at(bytes_, 0) != glb_magic) {
      error("GLB_INVALID_MAGIC", fmt::format("expected \"glTF\", found {:#010x}", u32_at(bytes_, 0)), 0);
      return false;
    }
    if (const std::uint32_t version = u32_at(bytes_, 4); version != 2) {
      error("GLB_INVALID_VERSION", fmt::format("expected GLB version 2, found {}", version), 4);
      return false;
    }
    declared_ = u32_at(bytes_, 8);
    if (declared_ <= header_size) error("GLB_LENGTH_TOO_SMALL", fmt::format("the header says {} bytes in all", declared_), 8);
    // What comes after the declared end is no part of it; where the declared length makes no sense, the file's own is looked at.
    end_ = declared_ > header_size ? std::min(declared_, bytes_.size()) : bytes_.size();
    return true;
  }

  void read_chunk(std::size_t number, std::size_t offset, std::size_t length, std::uint32_t type) {
    if (length % 4 != 0) error("GLB_CHUNK_LENGTH_UNALIGNED", fmt::format("expected a multiple of 4 bytes, found {}", length), offset);
    if (length > declared_ || offset + chunk_header_size > declared_ - length)
      error("GLB_CHUNK_TOO_BIG", fmt::format("a chunk of {} bytes goes beyond the end", length), offset);
    if (number == 0 && type != json_chunk)
      error("GLB_UNEXPECTED_FIRST_CHUNK", fmt::format("expected JSON first, found chunk type {:#010x}", type), offset);
    const std::size_t there = std::min(length, bytes_.size() - offset - chunk_header_size);
    const auto chunk = bytes_.subspan(offset + chunk_header_size, there);
    if (type == json_chunk) {
      if (length == 0) error("GLB_EMPTY_CHUNK", "expected JSON, found nothing", offset);
      if (has_json_) return error("GLB_DUPLICATE_CHUNK", "a second chunk of JSON", offset);
      has_json_ = length != 0;
      container_.json = {reinterpret_cast<const char*>(chunk.data()), chunk.size()};
      container_.json_offset = offset + chunk_header_size;
    } else if (type == binary_chunk) {
      if (number > 1 && !container_.binary) error("GLB_UNEXPECTED_BIN_CHUNK", "the binary chunk has to be the second one", offset);
      if (length == 0) add(Severity::note, "GLB_EMPTY_BIN_CHUNK", "an empty chunk should be left out", offset);
      if (container_.binary) return error("GLB_DUPLICATE_CHUNK", "a second binary chunk", offset);
      container_.binary = chunk;
    } else {
      add(Severity::warning, "GLB_UNKNOWN_CHUNK_TYPE", fmt::format("a chunk of type {:#010x} is passed over", type), offset);
    }
  }

  std::span<const std::byte> bytes_;
  std::vector<Diagnostic>& diagnostics_;
  std::size_t declared_ = 0, end_ = 0;
  bool has_json_ = false;
  Container container_;
};

}  // namespace

std::optional<Container> open_container(std::span<const std::byte> bytes, bool named_glb, std::vector<Diagnostic>& diagnostics) {
  const auto first = std::find_if(bytes.begin(), bytes.end(), [](std::byte b) {
    const auto c = static_cast<char>(b);
    return c != ' ' && c != '\t' && c != '\r' && c != '\n';
  });
  const bool looks_like_json = first != bytes.end() && *first == std::byte{'{'};
  // By the first byte, with which no JSON begins: so that a GLB whose magic is broken is told so.
  const bool begins_as_glb = !bytes.empty() && bytes[0] == std::byte{'g'};
  if (begins_as_glb || (named_glb && !looks_like_json)) return GlbReader(bytes, diagnostics).read();
  return Container{{reinterpret_cast<const char*>(bytes.data()), bytes.size()}, 0, std::nullopt, false};
}

}  // namespace etendue::gltf
