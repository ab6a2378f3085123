#include "etendue/picture.h"

#include <algorithm>
#include <cmath>

#include "lookup.h"

namespace etendue {
namespace {

Rgba sample_at(const DecodedImage& image, const Texture& texture, double u, double v) {
  const auto texel = [&](std::int64_t x, std::int64_t y) {
    const auto column = static_cast<std::size_t>(wrapped(x, image.width, texture.wrap_u));
    const auto row = static_cast<std::size_t>(wrapped(y, image.height, texture.wrap_v));
    return image.rgba.data() + (row * image.width + column) * 4;
  };
  const auto at = mixed(between(u, image.width, texture.nearest), between(v, image.height, texture.nearest), texture.nearest, texel);
  return {at[0], at[1], at[2], at[3]};
}

}  // namespace

Rgba sample(const DecodedImage& image, const Texture& texture, Vec2d uv) {
  if (image.width == 0 || image.height == 0) return {};
  const Vec2d at = place(texture, uv);
  return sample_at(image, texture, at.x, at.y);
}

std::uint32_t cut_out_cells(const DecodedImage& image, const Texture& texture) {
  constexpr std::uint64_t most_texels = std::uint64_t{1} << 22;
  return texture.nearest || std::uint64_t{image.width} * image.height > most_texels ? 1 : 4;
}

Rgba sample_cell(const DecodedImage& image, const Texture& texture, Vec2d uv) {
  if (image.width == 0 || image.height == 0) return {};
  const Vec2d at = place(texture, uv);
  const double cells = cut_out_cells(image, texture);
  const auto middle = [](double t, double count) { return (std::floor(t * count) + 0.5) / count; };
  return sample_at(image, texture, middle(at.x, image.width * cells), middle(at.y, image.height * cells));
}

}  // namespace etendue
