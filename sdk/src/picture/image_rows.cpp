#include "image_rows.h"

#include <cmath>
#include <cstring>

#include "etendue/srgb.h"

namespace etendue {
namespace {

template <class Code>
void spread(const std::uint8_t* bytes, std::size_t channels, const std::vector<float>& colour, const std::vector<float>& alpha,
            std::span<float> rgba) {
  const bool has_alpha = channels == 2 || channels >= 4;
  const auto code_at = [&](std::size_t i) {
    Code code;
    std::memcpy(&code, bytes + i * sizeof(Code), sizeof(Code));
    return code;
  };
  for (std::size_t i = 0; i < rgba.size() / 4; ++i) {
    for (std::size_t c = 0; c < 3; ++c) rgba[i * 4 + c] = colour[code_at(i * channels + (channels < 3 ? 0 : c))];
    rgba[i * 4 + 3] = has_alpha ? alpha[code_at(i * channels + (channels == 2 ? 1 : 3))] : 1.0f;
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

Status ImageRows::read(std::uint32_t rows, std::span<float> rgba) {
  OIIO::ImageInput& input = *file_.input;
  const OIIO::ImageSpec& spec = file_.spec;
  const bool coded = !colour_of_code_.empty();
  const OIIO::TypeDesc type = coded ? spec.format : OIIO::TypeDesc(OIIO::TypeDesc::FLOAT);
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  const std::size_t pixels = std::size_t{rows} * width();
  bytes_.resize(pixels * channels * type.size());
  const int begin = spec.y + static_cast<int>(next_), end = begin + static_cast<int>(rows);
  const bool tiled = spec.tile_width > 0;
  const bool read = tiled ? input.read_tiles(0, 0, spec.x, spec.x + spec.width, begin, end, 0, 1, 0, spec.nchannels, type, bytes_.data())
                          : input.read_scanlines(0, 0, begin, end, 0, 0, spec.nchannels, type, bytes_.data());
  if (!read) return unreadable(image_, input.geterror());
  const std::span<float> out = rgba.first(pixels * 4);
  if (spec.format == OIIO::TypeDesc::UINT8 && coded) {
    spread<std::uint8_t>(bytes_.data(), channels, colour_of_code_, alpha_of_code_, out);
  } else if (coded) {
    spread<std::uint16_t>(bytes_.data(), channels, colour_of_code_, alpha_of_code_, out);
  } else {
    const bool alpha = has_alpha();
    for (std::size_t i = 0; i < pixels; ++i) {
      const auto value = [&](std::size_t channel) {
        float number;
        std::memcpy(&number, bytes_.data() + (i * channels + channel) * sizeof(float), sizeof(float));
        return number;
      };
      for (std::size_t c = 0; c < 3; ++c) {
        const float v = value(channels < 3 ? 0 : c);
        out[i * 4 + c] = file_.srgb ? static_cast<float>(srgb_to_linear(static_cast<double>(v))) : v;
      }
      out[i * 4 + 3] = alpha ? value(channels == 2 ? 1 : 3) : 1.0f;
      for (std::size_t c = 0; c < 4; ++c) {
        if (!std::isfinite(out[i * 4 + c]))
          return Error{"PICTURE_UNSUITABLE",
                       "expected finite numbers, found another one at pixel (" + std::to_string(i % width()) + ", " +
                           std::to_string(next_ + i / width()) + ")",
                       {shown_name(image_), 0, 0, {}},
                       {},
                       {}};
      }
    }
  }
  next_ += rows;
  return Done{};
}

}  // namespace etendue
