// What the first bytes of an encoded picture say: its format and its size, without decoding it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace etendue {

enum class PictureFault : std::uint8_t { none, cut_off, malformed };

struct PictureHeader {
  const char* format = "";              // "png", "jpeg", "webp", "ktx2", "avif", "exr", "hdr", "gif", "bmp"
  const char* mime_type = "";           // "" where glTF has none for it
  std::uint32_t width = 0, height = 0;  // 0 where the header does not say
  std::uint32_t channels = 0;           // of a JPEG; else 0
  // Of PNG, looked at up to its first IDAT, and of JPEG, up to its frame: whether that much is there and makes sense. What is known stays.
  PictureFault fault = PictureFault::none;
};

// So many bytes tell every format.
constexpr std::size_t picture_signature_size = 14;

// None for bytes of no known format. JPEG's size may stand far behind its beginning: give all bytes, a few are looked at.
std::optional<PictureHeader> picture_header(std::span<const std::byte> bytes);

}  // namespace etendue
