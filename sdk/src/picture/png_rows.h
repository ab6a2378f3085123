// A PNG written band by band.
#pragma once

#include "etendue/result.h"

#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

namespace etendue {

class PngRows {
 public:
  // 3 channels or 4, of 8 or 16 bits, alpha not multiplied in. Error: FILE_UNWRITABLE.
  static Result<PngRows> open(const std::filesystem::path& file, std::uint32_t width, std::uint32_t height, int channels, int bits);
  // The next rows; of 8 bits only the low byte of each code counts.
  Status write(std::uint32_t rows, std::span<const std::uint16_t> codes);
  Status close();

 private:
  std::filesystem::path file_;
  std::unique_ptr<OIIO::ImageOutput> output_;
  std::vector<std::uint8_t> bytes_;
  int next_ = 0, bits_ = 8;
};

}  // namespace etendue
