#include "etendue/picture.h"

#include "etendue/srgb.h"

#include "image_file.h"

#include <algorithm>
#include <memory>
#include <span>
#include <string_view>

namespace etendue {
namespace {

constexpr std::uint64_t max_side = 1u << 20;

// OpenImageIO chooses the reader by a file name: the one that the first bytes ask for.
const char* name_for_reader(std::span<const std::uint8_t> bytes) {
  const std::string_view head(reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(bytes.size(), 12));
  if (head.substr(0, 4) == "\x89PNG") return "embedded.png";
  if (head.substr(0, 2) == "\xff\xd8") return "embedded.jpg";
  if (head.substr(0, 4) == "\x76\x2f\x31\x01") return "embedded.exr";
  if (head.substr(0, 4) == "RIFF" && head.substr(8, 4) == "WEBP") return "embedded.webp";
  if (head.substr(0, 2) == "#?") return "embedded.hdr";
  return nullptr;
}

// Numbers of the file to red, green, blue, alpha.
void spread(std::span<const float> values, const OIIO::ImageSpec& spec, bool srgb, std::span<float> rgba) {
  const auto channels = static_cast<std::size_t>(spec.nchannels);
  const bool has_alpha = channels == 2 || channels >= 4;
  for (std::size_t i = 0; i < rgba.size() / 4; ++i) {
    const float* in = values.data() + i * channels;
    for (std::size_t c = 0; c < 3; ++c) {
      const float v = in[channels < 3 ? 0 : c];
      rgba[i * 4 + c] = srgb ? static_cast<float>(srgb_to_linear(static_cast<double>(v))) : v;
    }
    rgba[i * 4 + 3] = has_alpha ? in[channels == 2 ? 1 : 3] : 1.0f;
  }
}

}  // namespace

std::string shown_name(const ImageRef& image) {
  if (!image.file.empty()) return image.file;
  return image.name.empty() ? "embedded image" : image.name;
}

Error unreadable(const ImageRef& image, std::string text) {
  return {"FILE_UNREADABLE", "expected an image that OpenImageIO can read: " + std::move(text), {shown_name(image), 0, 0, {}}, {}, {}};
}

Result<ImageFile> open_image(const ImageRef& image, Encoding encoding, std::uint64_t max_pixels) {
  OIIO::ImageSpec config;
  config["oiio:UnassociatedAlpha"] = 1;  // colours as stored, not multiplied by alpha
  ImageFile out;
  if (image.embedded) {
    const char* name = name_for_reader({image.embedded.data(), image.embedded.size()});
    if (name == nullptr) return unreadable(image, "the first bytes are those of no known format");
    out.memory = std::make_unique<OIIO::Filesystem::IOMemReader>(const_cast<std::uint8_t*>(image.embedded.data()), image.embedded.size());
    OIIO::Filesystem::IOProxy* proxy = out.memory.get();
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, static_cast<void*>(&proxy));
    out.input = OIIO::ImageInput::open(name, &config, proxy);
  } else {
    out.input = OIIO::ImageInput::open(image.file, &config);
  }
  if (!out.input) return unreadable(image, OIIO::geterror());
  const OIIO::ImageSpec& spec = out.spec = out.input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 || spec.nchannels > 64) {
    return unreadable(image, "expected a flat image of 1 to 64 channels");
  }
  const auto width = static_cast<std::uint64_t>(spec.width);
  const auto height = static_cast<std::uint64_t>(spec.height);
  if (width > max_side || height > max_side || width * height > max_pixels) {
    return Error{
        "PICTURE_UNSUITABLE",
        "expected at most " + std::to_string(max_pixels) + " pixels, found " + std::to_string(width) + " x " + std::to_string(height),
        {shown_name(image), 0, 0, {}},
        {},
        {}};
  }
  // Files of floating-point numbers are linear whatever the slot says, as in Mitsuba's bitmap.
  out.srgb = encoding == Encoding::srgb && !spec.format.is_floating_point();
  return out;
}

Result<DecodedImage> decode(const ImageRef& image, Encoding encoding, std::uint64_t max_pixels) {
  Result<ImageFile> opened = open_image(image, encoding, max_pixels);
  if (!opened) return opened.error();
  const OIIO::ImageSpec& spec = opened->spec;
  DecodedImage out{static_cast<std::uint32_t>(spec.width), static_cast<std::uint32_t>(spec.height), {}};
  const std::size_t pixels = std::size_t{out.width} * out.height;
  std::vector<float> values(pixels * static_cast<std::size_t>(spec.nchannels));
  if (!opened->input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data()))
    return unreadable(image, opened->input->geterror());
  out.rgba.resize(pixels * 4);
  spread(values, spec, opened->srgb, out.rgba);
  return out;
}

Status decode_rows(const ImageRef& image, Encoding encoding, const std::function<void(const ImageRow&)>& use, std::uint64_t max_pixels) {
  Result<ImageFile> opened = open_image(image, encoding, max_pixels);
  if (!opened) return opened.error();
  const OIIO::ImageSpec& spec = opened->spec;
  const bool tiled = spec.tile_width > 0;
  const int band = tiled ? spec.tile_height : std::min(64, spec.height);
  const auto width = static_cast<std::size_t>(spec.width), channels = static_cast<std::size_t>(spec.nchannels);
  std::vector<float> values(width * static_cast<std::size_t>(band) * channels), rgba(4 * width);
  for (int begin = 0; begin < spec.height; begin += band) {
    const int rows = std::min(band, spec.height - begin), y = spec.y + begin;
    OIIO::ImageInput& input = *opened->input;
    const bool read = tiled ? input.read_tiles(0, 0, spec.x, spec.x + spec.width, y, y + rows, 0, 1, 0, spec.nchannels,
                                               OIIO::TypeDesc::FLOAT, values.data())
                            : input.read_scanlines(0, 0, y, y + rows, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data());
    if (!read) return unreadable(image, input.geterror());
    for (int row = 0; row < rows; ++row) {
      spread(std::span(values).subspan(static_cast<std::size_t>(row) * width * channels, width * channels), spec, opened->srgb, rgba);
      use({static_cast<std::uint32_t>(spec.width), static_cast<std::uint32_t>(spec.height), static_cast<std::uint32_t>(begin + row), rgba});
    }
  }
  return Done{};
}

}  // namespace etendue
