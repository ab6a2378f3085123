#include "etendue/io.h"
#include "etendue/picture_write.h"
#include "etendue/srgb.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>

namespace etendue {

Status write_png(const Picture& picture, const std::filesystem::path& file) {
  const auto unsuitable = [&file](std::string text) {
    return Error{"PICTURE_UNSUITABLE", std::move(text), {file.string(), 0, 0, {}}, {}, {}};
  };
  const Layer* layer = picture.find("");
  const std::size_t count = std::size_t{picture.width} * picture.height * 3;
  if (layer == nullptr || layer->channels != 3 || layer->pixels.size() != count || count == 0)
    return unsuitable("expected a layer \"\" of width x height x 3 values");
  std::vector<std::uint8_t> codes(count);
  std::transform(layer->pixels.begin(), layer->pixels.end(), codes.begin(), [](float linear) {
    const double code = linear_to_srgb(std::clamp(static_cast<double>(linear), 0.0, 1.0));
    return static_cast<std::uint8_t>(std::isfinite(code) ? std::lround(255 * code) : 0);
  });
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  OIIO::ImageSpec spec(static_cast<int>(picture.width), static_cast<int>(picture.height), 3, OIIO::TypeDesc::UINT8);
  spec["oiio:ColorSpace"] = "sRGB";
  const auto output = OIIO::ImageOutput::create("memory.png", &memory);
  if (!output || !output->open("memory.png", spec) || !output->write_image(OIIO::TypeDesc::UINT8, codes.data()) || !output->close())
    return unsuitable("OpenImageIO: " + (output ? output->geterror() : OIIO::geterror()));
  return write_file(file, std::as_bytes(std::span(bytes)));
}

}  // namespace etendue
