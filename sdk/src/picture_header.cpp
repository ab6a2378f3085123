#include "picture_header.h"

#include <algorithm>
#include <cstring>
#include <iterator>
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

// ISO/IEC 15948, 5.3: length, type, data and CRC, one chunk after the other. Lengths of the chunks that the size or the colours come from.
PictureHeader png(const Bytes& b) {
  struct Fixed {
    const char* type;
    std::uint32_t length;
  };
  constexpr Fixed fixed[] = {{"IHDR", 13}, {"cHRM", 32}, {"sRGB", 1}, {"pHYs", 9}, {"gAMA", 4}};
  PictureHeader header{"png", "image/png"};
  header.fault = PictureFault::cut_off;
  for (std::size_t at = 8; b.has_room(at, 8);) {
    const std::uint32_t length = b.big(at, 4);
    const auto is = [&](const char* type) { return b.has(at + 4, type); };
    const bool is_wrong = std::any_of(std::begin(fixed), std::end(fixed), [&](const Fixed& f) { return is(f.type) && length != f.length; });
    if (is_wrong || is("IDAT")) {
      header.fault = is_wrong || header.width == 0 || header.height == 0 ? PictureFault::malformed : PictureFault::none;
      break;
    }
    if (is("IHDR") && b.has_room(at, 16)) {
      header.width = b.big(at + 8, 4);
      header.height = b.big(at + 12, 4);
    }
    if (!b.has_room(at + 8, std::size_t{length} + 4)) break;
    at += 12 + std::size_t{length};
  }
  return header;
}

// ITU-T T.81 (ISO/IEC 10918-1), B.1 and B.2.2: markers, most of them with a length, up to a frame header (SOF0 to SOF15 but DHT, JPG, DAC).
PictureHeader jpeg(const Bytes& b) {
  PictureHeader header{"jpeg", "image/jpeg"};
  const auto end_as = [&](PictureFault fault) {
    header.fault = fault;
    return header;
  };
  for (std::size_t at = 2; b.has_room(at, 4);) {
    const std::uint32_t code = b.big(at + 1, 1), length = b.big(at + 2, 2);
    if (b.big(at, 1) != 0xFF) return end_as(PictureFault::malformed);
    if (code == 0xFF || code == 0x01 || (code >= 0xD0 && code <= 0xD9)) {  // a fill byte, or a marker that stands alone
      at += code == 0xFF ? 1 : 2;
      continue;
    }
    const bool is_frame = code >= 0xC0 && code <= 0xCF && code != 0xC4 && code != 0xC8 && code != 0xCC;
    if (length < (is_frame ? 8U : 2U)) return end_as(PictureFault::malformed);
    if (is_frame && b.has_room(at, 10)) {
      header.height = b.big(at + 5, 2);
      header.width = b.big(at + 7, 2);
      header.channels = b.big(at + 9, 1);
      return end_as(b.has_room(at + 2, length) ? PictureFault::none : PictureFault::cut_off);
    }
    if (!b.has_room(at + 2, length)) break;
    at += 2 + std::size_t{length};
  }
  return end_as(PictureFault::cut_off);
}

// RFC 9649: lossy (RFC 6386, 9.1), lossless, or extended.
PictureHeader webp(const Bytes& b) {
  PictureHeader header{"webp", "image/webp"};
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
  if (b.has(0, "\x89PNG\r\n\x1A\n")) return png(b);
  if (b.has(0, "\xFF\xD8\xFF")) return jpeg(b);
  if (b.has(0, "RIFF") && b.has(8, "WEBPVP")) return webp(b);
  if (b.has(0, "\xABKTX 20\xBB\r\n\x1A\n")) return PictureHeader{"ktx2", "image/ktx2", b.little(20, 4), b.little(24, 4)};
  if (b.has(4, "ftypavif")) return PictureHeader{"avif", "image/avif"};
  if (b.has(0, "\x76\x2F\x31\x01")) return PictureHeader{"exr", ""};
  if (b.has(0, "#?R")) return PictureHeader{"hdr", ""};
  if (b.has(0, "GIF8")) return PictureHeader{"gif", "", b.little(6, 2), b.little(8, 2)};
  if (b.has(0, "BM") && b.has_room(0, 26)) return PictureHeader{"bmp", "", b.little(18, 4), b.little(22, 4)};
  return std::nullopt;
}

}  // namespace etendue
