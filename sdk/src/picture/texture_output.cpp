#include "texture_output.h"

#include <algorithm>
#include <cctype>
#include <span>

namespace etendue {

Status TextureOutput::open(std::uint32_t width, std::uint32_t height, int bits) {
  Result<PngRows> png = PngRows::open(file_, width, height, static_cast<int>(channels_), bits);
  if (!png) return png.error();
  png_ = std::move(*png);
  width_ = width;
  codes_.resize(std::size_t{width} * TextureRows::written_bands * TextureRows::band_rows * channels_);
  return Done{};
}

Status TextureOutput::write(std::uint32_t begin, std::uint32_t rows) {
  const std::span<const std::uint16_t> codes(texel(0, begin), std::size_t{rows} * width_ * channels_);
  if (begin == 0) std::copy_n(codes.begin(), channels_, first_.begin());
  for (std::size_t c = 0; c < channels_; ++c)
    for (std::size_t i = c; i < codes.size() && !varies_[c]; i += channels_) varies_[c] = codes[i] != first_[c];
  return png_->write(rows, codes);
}

bool TextureOutput::is_constant() const {
  for (std::size_t c = 0; c < channels_; ++c)
    if (!constant(c)) return false;
  return true;
}

void TextureOutput::remove() const {
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

std::string plain(std::string name) {
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-') c = '_';
  return name;
}

}  // namespace etendue
