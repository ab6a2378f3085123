// A picture that is being made: its rows, its file, and whether any channel differs between texels.
#pragma once

#include "png_rows.h"
#include "texture_rows.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace etendue {

class TextureOutput {
 public:
  // 3 channels or 4.
  TextureOutput(std::filesystem::path file, int channels) : file_(std::move(file)), channels_(static_cast<std::size_t>(channels)) {}

  Status open(std::uint32_t width, std::uint32_t height, int bits);
  // Codes of a texel of the bands that are being made and written.
  std::uint16_t* texel(std::uint32_t x, std::uint32_t y) {
    return codes_.data() + (std::size_t{y % (TextureRows::written_bands * TextureRows::band_rows)} * width_ + x) * channels_;
  }
  Status write(std::uint32_t begin, std::uint32_t rows);
  Status close() { return png_->close(); }

  // The code of a channel that is the same in all texels.
  std::optional<std::uint16_t> constant(std::size_t channel) const {
    return varies_[channel] ? std::nullopt : std::optional(first_[channel]);
  }
  bool is_constant() const;
  void remove() const;
  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
  std::size_t channels_;
  std::optional<PngRows> png_;
  std::uint32_t width_ = 0;
  std::vector<std::uint16_t> codes_;
  std::array<std::uint16_t, 4> first_{};  // the first texel's codes
  std::array<bool, 4> varies_{};
};

// A material's name as a part of a file's name.
std::string plain(std::string name);

}  // namespace etendue
