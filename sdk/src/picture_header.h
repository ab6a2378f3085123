// What the first bytes of an encoded picture say: its format and its size, without decoding it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace etendue {

struct PictureHeader {
  const char* format = "";              // "png", "jpeg", "webp", "ktx2", "avif", "exr", "hdr", "gif", "bmp"
  const char* mime_type = "";           // "" where glTF has none for it
  std::uint32_t width = 0, height = 0;  // 0 where the header does not say (or is cut off)
};

// None for bytes of no known format. JPEG's size may stand far behind its beginning: give all bytes, a few are looked at.
std::optional<PictureHeader> picture_header(std::span<const std::byte> bytes);

}  // namespace etendue
