// An image's linear values band by band from the top, in the order in which somebody asks for them.
#pragma once

#include "image_file.h"

#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

class ImageRows {
 public:
  static Result<ImageRows> open(const ImageRef& image, Encoding encoding, std::uint64_t max_pixels);

  std::uint32_t width() const { return static_cast<std::uint32_t>(file_.spec.width); }
  std::uint32_t height() const { return static_cast<std::uint32_t>(file_.spec.height); }
  bool has_alpha() const { return file_.spec.nchannels == 2 || file_.spec.nchannels >= 4; }
  std::uint32_t next() const { return next_; }

  // Keeps what is read from now on, as the file has it, so that it is decoded once.
  void keep() { keeps_ = true; }
  std::size_t bytes() const { return std::size_t{height()} * row_bytes(); }
  // From the top again, where it keeps; else false.
  bool rewind();

  // The next rows: 4 channels each, alpha 1 where the file has none. A number that is not finite is the error PICTURE_UNSUITABLE, with its
  // place.
  Status read(std::uint32_t rows, std::span<float> rgba);

  // The same in two steps: the next rows as the file has them, of code_type(); and linear values of such texels.
  Status read_codes(std::uint32_t rows, std::vector<std::uint8_t>& codes);
  void to_linear(std::span<const std::uint8_t> codes, std::span<float> rgba) const;
  OIIO::TypeDesc code_type() const;
  std::size_t channels() const { return static_cast<std::size_t>(file_.spec.nchannels); }

 private:
  bool coded() const { return !colour_of_code_.empty(); }
  std::size_t row_bytes() const { return width() * channels() * code_type().size(); }
  Status check_finite(std::span<const std::uint8_t> numbers, std::uint32_t first_row) const;

  ImageRef image_;
  ImageFile file_;
  std::uint32_t next_ = 0;
  std::vector<float> colour_of_code_, alpha_of_code_;  // of integers of 8 and 16 bits; empty for others
  std::vector<std::uint8_t> codes_, tile_row_, kept_;
  bool keeps_ = false;
};

}  // namespace etendue
