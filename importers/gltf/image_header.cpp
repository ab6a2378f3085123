#include "image_header.h"

#include <algorithm>
#include <cstring>
#include <string_view>

namespace etendue::gltf {
namespace {

using Bytes = std::span<const std::byte>;

std::uint32_t big_endian(Bytes bytes, std::size_t offset, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8 | std::to_integer<std::uint32_t>(bytes[offset + i]);
  return value;
}

bool has(Bytes bytes, std::size_t offset, std::string_view text) {
  return bytes.size() >= offset + text.size() && std::memcmp(bytes.data() + offset, text.data(), text.size()) == 0;
}

Error image_error(const char* code, const char* text) { return {code, text, {}, {}, {}}; }
Error unexpected_end() { return image_error("IMAGE_UNEXPECTED_EOS", "the picture ends before its size is known"); }

// ISO/IEC 15948, 5.3: length, type, data and CRC, one chunk after the other. Lengths of the chunks that the size or the colours come from.
Result<ImageHeader> read_png(Bytes bytes) {
  struct Fixed {
    const char* type;
    std::uint32_t length;
  };
  constexpr Fixed fixed[] = {{"IHDR", 13}, {"cHRM", 32}, {"sRGB", 1}, {"pHYs", 9}, {"gAMA", 4}};
  ImageHeader header{"image/png", 0, 0};
  for (std::size_t at = 8; at + 8 <= bytes.size();) {
    const std::uint32_t length = big_endian(bytes, at, 4);
    const auto is = [&](const char* type) { return has(bytes, at + 4, type); };
    if (std::any_of(std::begin(fixed), std::end(fixed), [&](const Fixed& f) { return is(f.type) && length != f.length; }))
      return image_error("IMAGE_DATA_INVALID", "a PNG chunk has a wrong length");
    if (is("IDAT")) {
      if (header.width == 0 || header.height == 0) return image_error("IMAGE_DATA_INVALID", "the PNG has no size");
      return header;
    }
    if (bytes.size() - at - 8 < std::size_t{length} + 4) break;
    if (is("IHDR")) {
      header.width = big_endian(bytes, at + 8, 4);
      header.height = big_endian(bytes, at + 12, 4);
    }
    at += 12 + std::size_t{length};
  }
  return unexpected_end();
}

// ISO/IEC 10918-1, B.1: markers, most with a length; the size stands in the start of frame (C0 to CF without C4, C8 and CC).
Result<ImageHeader> read_jpeg(Bytes bytes) {
  for (std::size_t at = 2; at + 4 <= bytes.size();) {
    if (bytes[at] != std::byte{0xFF}) return image_error("IMAGE_DATA_INVALID", "expected a JPEG marker");
    const auto marker = std::to_integer<unsigned>(bytes[at + 1]);
    if (marker == 0xFF || marker == 0x01 || (marker >= 0xD0 && marker <= 0xD9)) {
      at += marker == 0xFF ? 1 : 2;
      continue;
    }
    const std::uint32_t length = big_endian(bytes, at + 2, 2);
    if (length < 2) return image_error("IMAGE_DATA_INVALID", "a JPEG segment has a wrong length");
    if (bytes.size() - at - 2 < length) break;
    const bool is_frame = (marker & 0xF0) == 0xC0 && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (is_frame) {
      if (length < 8) return image_error("IMAGE_DATA_INVALID", "the JPEG frame is too short");
      const std::uint32_t channels = big_endian(bytes, at + 9, 1);
      if (channels != 1 && channels != 3) return image_error("IMAGE_DATA_INVALID", "expected a JPEG of 1 or 3 channels");
      return ImageHeader{"image/jpeg", big_endian(bytes, at + 7, 2), big_endian(bytes, at + 5, 2)};
    }
    at += 2 + length;
  }
  return unexpected_end();
}

}  // namespace

std::string mime_type_of_image(Bytes bytes) {
  using namespace std::string_view_literals;
  if (bytes.size() < signature_size) return "";
  if (has(bytes, 0, "\xFF\xD8\xFF"sv)) return "image/jpeg";
  if (has(bytes, 0, "\x89PNG\r\n\x1A\n"sv)) return "image/png";
  if (has(bytes, 0, "RIFF"sv) && has(bytes, 8, "WEBPVP"sv)) return "image/webp";
  if (has(bytes, 0, "\xABKTX 20\xBB\r\n\x1A\n"sv)) return "image/ktx2";
  if (has(bytes, 4, "ftypavif"sv)) return "image/avif";
  return "";
}

Result<ImageHeader> read_image_header(Bytes bytes) {
  const std::string type = mime_type_of_image(bytes);
  if (type.empty()) return image_error("IMAGE_UNRECOGNIZED_FORMAT", "the bytes are no known picture");
  if (type == "image/png") return read_png(bytes);
  if (type == "image/jpeg") return read_jpeg(bytes);
  return ImageHeader{type, 0, 0};
}

}  // namespace etendue::gltf
