// What an OpenEXR file declares, held against what it can hold, before OpenEXR allocates memory for it.
#pragma once

#include "etendue/result.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace etendue {

// Refuses a file of which a part declares more than `max_pixels`, more than 2^31 values, or more than any stream of the file's length can
// stand for with its compression; an attribute that is longer than the file or not as long as its type; tiles larger than the picture (and
// than 1024 x 1024). `file` is for messages. What else may be wrong with the file, OpenEXR finds. Error: PICTURE_UNSUITABLE.
Status check_exr_header(std::span<const std::byte> bytes, std::uint64_t max_pixels, const std::filesystem::path& file);

}  // namespace etendue
