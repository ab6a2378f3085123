// A specular-glossiness pair of pictures of any size, for measures of the file pipeline:
//   material_pictures FOLDER DIFFUSE_SIDE SPECULAR_SIDE (tiles DIFFUSE.png SPECULAR.png | noise)
// tiles: the given pictures side by side, in every tile but the first one 1 % of the texels a step of 8 bits off.
// noise: colours that drift over some hundred texels with some steps of noise on each texel, a third of it metal.
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>

#include "picture/png_rows.h"

namespace {

using Codes = std::function<void(std::uint32_t x, std::uint32_t y, std::uint16_t* rgba)>;

std::uint32_t hashed(std::uint32_t x, std::uint32_t y, std::uint32_t salt) {
  std::uint64_t h = (std::uint64_t{x} << 32 | y) * 0x9e3779b97f4a7c15u + salt;
  h = (h ^ h >> 31) * 0xbf58476d1ce4e5b9u;
  return static_cast<std::uint32_t>(h >> 32);
}

bool write(const std::string& file, std::uint32_t side, const Codes& codes_at) {
  auto png = etendue::PngRows::open(file, side, side, 4, 8);
  if (!png) return false;
  std::vector<std::uint16_t> row(std::size_t{4} * side);
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) codes_at(x, y, row.data() + std::size_t{4} * x);
    if (!png->write(1, row)) return false;
  }
  return static_cast<bool>(png->close());
}

Codes tiles_of(const std::string& file, std::uint32_t salt) {
  const auto input = OIIO::ImageInput::open(file);
  if (!input) {
    fmt::print(stderr, "cannot read {}\n", file);
    std::exit(2);
  }
  const OIIO::ImageSpec spec = input->spec();
  const auto width = static_cast<std::uint32_t>(spec.width), height = static_cast<std::uint32_t>(spec.height);
  const auto channels = static_cast<std::uint32_t>(spec.nchannels);
  std::vector<std::uint8_t> pixels(std::size_t{width} * height * channels);
  input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT8, pixels.data());
  return [=, pixels = std::move(pixels)](std::uint32_t x, std::uint32_t y, std::uint16_t* rgba) {
    const std::uint8_t* texel = pixels.data() + (std::size_t{y % height} * width + x % width) * channels;
    for (std::uint32_t c = 0; c < 4; ++c) rgba[c] = c < channels ? texel[c] : 255;
    const std::uint32_t chance = hashed(x, y, salt);
    if ((x >= width || y >= height) && chance % 100 == 0) rgba[chance / 100 % 3] = static_cast<std::uint16_t>(rgba[chance / 100 % 3] ^ 1u);
  };
}

Codes noise_of(std::uint32_t salt, bool specular) {
  return [=](std::uint32_t x, std::uint32_t y, std::uint16_t* rgba) {
    const bool metal = std::sin(x / 97.0) + std::cos(y / 131.0) > 0.5;
    for (std::uint32_t c = 0; c < 4; ++c) {
      const double drift = std::sin(x / (150.0 + 20 * c) + salt) * std::cos(y / (190.0 - 15 * c));
      const double middle = c == 3 ? 140 : specular ? (metal ? 190 : 58) : metal ? 12 : 120;
      const double wide = c == 3 ? 60 : specular ? (metal ? 30 : 6) : metal ? 6 : 60;
      const double noise = static_cast<double>(hashed(x, y, salt + c) % 1000) / 1000 - 0.5;
      rgba[c] = static_cast<std::uint16_t>(std::lround(middle + wide * drift + wide / 5 * noise));
    }
  };
}

}  // namespace

int main(int count, char** words) {
  const std::vector<std::string> arguments(words + 1, words + count);
  const bool tiles = arguments.size() == 6 && arguments[3] == "tiles";
  if (!tiles && !(arguments.size() == 4 && arguments[3] == "noise")) {
    fmt::print(stderr, "usage: material_pictures FOLDER DIFFUSE_SIDE SPECULAR_SIDE (tiles DIFFUSE.png SPECULAR.png | noise)\n");
    return 2;
  }
  const auto side = [&](std::size_t i) { return static_cast<std::uint32_t>(std::strtoul(arguments[i].c_str(), nullptr, 10)); };
  const bool written = write(arguments[0] + "/diffuse.png", side(1), tiles ? tiles_of(arguments[4], 1) : noise_of(1, false)) &&
                       write(arguments[0] + "/specular.png", side(2), tiles ? tiles_of(arguments[5], 7) : noise_of(7, true));
  return written ? 0 : 1;
}
