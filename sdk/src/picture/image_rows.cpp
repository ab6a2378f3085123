#include "image_rows.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "etendue/srgb.h"

namespace etendue {
namespace {

template <class Number>
Number number_at(const std::uint8_t* bytes, std::size_t index) {
  Number number;
  std::memcpy(&number, bytes + index * sizeof(Number), sizeof(Number));
  return number;
}

// Red, green, blue and alpha of the texels' numbers: grey stands for all colours, a second or fourth channel is alpha.
template <class Number, class Colour, class Alpha>
void spread(const std::uint8_t* bytes, std::size_t channels, Colour colour, Alpha alpha, std::span<float> rgba) {
  const bool has_alpha = channels == 2 || channels >= 4;
  const std::size_t step = channels < 3 ? 0 : 1, alpha_at = channels == 2 ? 1 : 3;
  for (std::size_t i = 0; i < rgba.size() / 4; ++i) {
    for (std::size_t c = 0; c < 3; ++c) rgba[i * 4 + c] = colour(number_at<Number>(bytes, i * channels + c * step));
    rgba[i * 4 + 3] = has_alpha ? alpha(number_at<Number>(bytes, i * channels + alpha_at)) : 1.0f;
  }
}

}  // namespace

Result<ImageRows> ImageRows::open(const ImageRef& image, Encoding encoding, std::uint64_t max_pixels) {
  Result<ImageFile> file = open_image(image, encoding, max_pixels);
  if (!file) return file.error();
  ImageRows rows;
  rows.image_ = image;
  rows.file_ = std::move(*file);
  const OIIO::TypeDesc format = rows.file_.spec.format;
  if (format == OIIO::TypeDesc::UINT8 || format == OIIO::TypeDesc::UINT16) {
    const std::size_t codes = format == OIIO::TypeDesc::UINT8 ? 256 : 65536;
    for (std::size_t code = 0; code < codes; ++code) {
      const double value = static_cast<double>(code) / static_cast<double>(codes - 1);
      rows.colour_of_code_.push_back(static_cast<float>(rows.file_.srgb ? srgb_to_linear(value) : value));
      rows.alpha_of_code_.push_back(static_cast<float>(value));
    }
  }
  return rows;
}

OIIO::TypeDesc ImageRows::code_type() const { return coded() ? file_.spec.format : OIIO::TypeDesc(OIIO::TypeDesc::FLOAT); }

Status ImageRows::read_codes(std::uint32_t rows, std::vector<std::uint8_t>& codes) {
  OIIO::ImageInput& input = *file_.input;
  const OIIO::ImageSpec& spec = file_.spec;
  const std::size_t row_size = row_bytes();
  codes.resize(rows * row_size);
  const std::uint32_t first = next_;
  if (spec.tile_width == 0) {
    const int begin = spec.y + static_cast<int>(first), end = begin + static_cast<int>(rows);
    if (!input.read_scanlines(0, 0, begin, end, 0, 0, spec.nchannels, code_type(), codes.data()))
      return unreadable(image_, input.geterror());
    next_ += rows;
  }
  // Tiles come a whole row of them at a time.
  for (; next_ < first + rows; ++next_) {
    const auto high = static_cast<std::uint32_t>(spec.tile_height), in_tile = next_ % high;
    if (in_tile == 0 || tile_row_.empty()) {
      const std::uint32_t top = next_ - in_tile, bottom = std::min(top + high, height());
      tile_row_.resize((bottom - top) * row_size);
      if (!input.read_tiles(0, 0, spec.x, spec.x + spec.width, spec.y + static_cast<int>(top), spec.y + static_cast<int>(bottom), 0, 1, 0,
                            spec.nchannels, code_type(), tile_row_.data()))
        return unreadable(image_, input.geterror());
    }
    std::copy_n(tile_row_.begin() + static_cast<std::ptrdiff_t>(in_tile * row_size), row_size,
                codes.begin() + static_cast<std::ptrdiff_t>((next_ - first) * row_size));
  }
  return coded() ? Status(Done{}) : check_finite(codes, first);
}

Status ImageRows::check_finite(std::span<const std::uint8_t> numbers, std::uint32_t first_row) const {
  for (std::size_t i = 0; i < numbers.size() / sizeof(float); ++i) {
    if (std::isfinite(number_at<float>(numbers.data(), i))) continue;
    const std::size_t pixel = i / channels();
    return Error{"PICTURE_UNSUITABLE",
                 "expected finite numbers, found another one at pixel (" + std::to_string(pixel % width()) + ", " +
                     std::to_string(first_row + pixel / width()) + ")",
                 {shown_name(image_), 0, 0, {}},
                 {},
                 {}};
  }
  return Done{};
}

void ImageRows::to_linear(std::span<const std::uint8_t> codes, std::span<float> rgba) const {
  const auto colour = [&](auto code) { return colour_of_code_[code]; };
  const auto alpha = [&](auto code) { return alpha_of_code_[code]; };
  if (code_type() == OIIO::TypeDesc::UINT8) {
    spread<std::uint8_t>(codes.data(), channels(), colour, alpha, rgba);
  } else if (coded()) {
    spread<std::uint16_t>(codes.data(), channels(), colour, alpha, rgba);
  } else {
    const auto decoded = [&](float v) { return file_.srgb ? static_cast<float>(srgb_to_linear(static_cast<double>(v))) : v; };
    spread<float>(
        codes.data(), channels(), decoded, [](float v) { return v; }, rgba);
  }
}

Status ImageRows::read(std::uint32_t rows, std::span<float> rgba) {
  const std::span<float> out = rgba.first(std::size_t{rows} * width() * 4);
  const std::size_t begin = next_ * row_bytes(), size = rows * row_bytes();
  if (begin + size <= kept_.size()) {
    to_linear(std::span(kept_).subspan(begin, size), out);
    next_ += rows;
    return Done{};
  }
  if (Status read = read_codes(rows, codes_); !read) return read;
  if (keeps_ && begin == kept_.size()) {
    kept_.reserve(bytes());
    kept_.insert(kept_.end(), codes_.begin(), codes_.end());
  }
  to_linear(codes_, out);
  return Done{};
}

bool ImageRows::rewind() {
  if (keeps_) next_ = 0;
  return keeps_;
}

}  // namespace etendue
