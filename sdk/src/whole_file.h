// A file of several pieces.
#pragma once

#include "etendue/result.h"

#include <cstddef>
#include <filesystem>
#include <span>

namespace etendue {

// write_file() (io.h) of pieces that stand one behind the other.
Status write_file(const std::filesystem::path& file, std::span<const std::span<const std::byte>> pieces);

}  // namespace etendue
