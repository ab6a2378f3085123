// Pictures for others than our own tools: mip levels for renderers, PNG for people.
#pragma once

#include "etendue/picture.h"

#include <filesystem>
#include <span>

namespace etendue {

// A chain of mip levels as one tiled OpenEXR file: each half as large as the one before, rounded down, down to one pixel, all with the
// layers of the first, whose attributes the file has. Errors: PICTURE_UNSUITABLE, and those of writing.
Status write_exr_levels(std::span<const Picture> levels, const std::filesystem::path& file);
// The layer "" from 0 to 1, linear, as sRGB of 8 bits. What is beyond is cut off, NaN is black. Errors: PICTURE_UNSUITABLE, and those of
// writing.
Status write_png(const Picture& picture, const std::filesystem::path& file);

}  // namespace etendue
