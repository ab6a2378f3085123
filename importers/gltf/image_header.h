// What the first bytes of a picture say, without decoding it.
#pragma once

#include "etendue/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace etendue::gltf {

constexpr std::size_t signature_size = 14;

// "image/png", "image/jpeg", "image/webp", "image/ktx2" or "image/avif" by the signature; "" for others.
std::string mime_type_of_image(std::span<const std::byte> bytes);

struct ImageHeader {
  std::string mime_type;
  std::uint32_t width = 0, height = 0;  // 0: not read for this kind
};
// PNG up to its first IDAT, JPEG up to its frame. Errors: IMAGE_UNRECOGNIZED_FORMAT, IMAGE_DATA_INVALID, IMAGE_UNEXPECTED_EOS.
Result<ImageHeader> read_image_header(std::span<const std::byte> bytes);

}  // namespace etendue::gltf
