#include "picture_header.h"

#include <algorithm>
#include <cstring>
#include <string_view>

namespace etendue {
namespace {

class Bytes {
 public:
  explicit Bytes(std::span<const std::byte> bytes) : bytes_(bytes) {}
  bool has(std::size_t offset, std::string_view text) const {
    return has_room(offset, text.size()) && std::memcmp(bytes_.data() + offset, text.data(), text.size()) == 0;
  }
  bool has_room(std::size_t offset, std::size_t count) const { return offset <= bytes_.size() && count <= bytes_.size() - offset; }
  // 0 beyond the end.
  std::uint32_t big(std::size_t offset, int count) const {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i) value = value << 8 | at(offset + static_cast<std::size_t>(i));
    return value;
  }
  std::uint32_t little(std::size_t offset, int count) const {
    std::uint32_t value = 0;
    for (int i = count - 1; i >= 0; --i) value = value << 8 | at(offset + static_cast<std::size_t>(i));
    return value;
  }

 private:
  std::uint32_t at(std::size_t offset) const { return offset < bytes_.size() ? std::to_integer<std::uint32_t>(bytes_[offset]) : 0; }
  std::span<const std::byte> bytes_;
};

// ITU-T T.81, B.1 and B.2.2: segments of a marker and a length, up to a frame header (SOF0 to SOF15 but DHT, JPG, DAC).
PictureHeader jpeg(const Bytes& b) {
  PictureHeader header{"jpeg", "image/jpeg", 0, 0};
  for (std::size_t at = 2; b.has_room(at, 9);) {
    const std::uint32_t marker = b.big(at, 2), code = marker & 0xFF;
    if (marker >> 8 != 0xFF) break;
    if (code >= 0xC0 && code <= 0xCF && code != 0xC4 && code != 0xC8 && code != 0xCC) {
      header.height = b.big(at + 5, 2);
      header.width = b.big(at + 7, 2);
      break;
    }
    at += code == 0xFF ? 1 : 2 + std::max<std::size_t>(2, b.big(at + 2, 2));  // 0xFF: a fill byte
  }
  return header;
}

// RFC 9649: lossy (RFC 6386, 9.1), lossless, or extended.
PictureHeader webp(const Bytes& b) {
  PictureHeader header{"webp", "image/webp", 0, 0};
  if (b.has(12, "VP8 ") && b.has_room(20, 10)) {
    header.width = b.little(26, 2) & 0x3FFF;
    header.height = b.little(28, 2) & 0x3FFF;
  } else if (b.has(12, "VP8L") && b.has_room(20, 5)) {
    const std::uint32_t bits = b.little(21, 4);
    header.width = (bits & 0x3FFF) + 1;
    header.height = (bits >> 14 & 0x3FFF) + 1;
  } else if (b.has(12, "VP8X") && b.has_room(20, 10)) {
    header.width = b.little(24, 3) + 1;
    header.height = b.little(27, 3) + 1;
  }
  return header;
}

}  // namespace

std::optional<PictureHeader> picture_header(std::span<const std::byte> bytes) {
  const Bytes b(bytes);
  if (b.has(0, "\x89PNG\r\n\x1A\n")) return PictureHeader{"png", "image/png", b.big(16, 4), b.big(20, 4)};
  if (b.has(0, "\xFF\xD8\xFF")) return jpeg(b);
  if (b.has(0, "RIFF") && b.has(8, "WEBP")) return webp(b);
  if (b.has(0, "\xABKTX 20\xBB\r\n\x1A\n")) return PictureHeader{"ktx2", "image/ktx2", b.little(20, 4), b.little(24, 4)};
  if (b.has(4, "ftypavif")) return PictureHeader{"avif", "image/avif", 0, 0};
  if (b.has(0, "\x76\x2F\x31\x01")) return PictureHeader{"exr", "", 0, 0};
  if (b.has(0, "#?R")) return PictureHeader{"hdr", "", 0, 0};
  if (b.has(0, "GIF8")) return PictureHeader{"gif", "", b.little(6, 2), b.little(8, 2)};
  if (b.has(0, "BM") && b.has_room(0, 26)) return PictureHeader{"bmp", "", b.little(18, 4), b.little(22, 4)};
  return std::nullopt;
}

}  // namespace etendue
