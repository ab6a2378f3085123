#include "etendue/picture.h"

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

// Index of the texel that stands at place i of the endless row.
std::int64_t wrapped(std::int64_t i, std::int64_t size, Wrap wrap) {
  switch (wrap) {
    case Wrap::clamp:
      return std::clamp<std::int64_t>(i, 0, size - 1);
    case Wrap::mirror: {
      const std::int64_t m = ((i % (2 * size)) + 2 * size) % (2 * size);
      return m < size ? m : 2 * size - 1 - m;
    }
    case Wrap::repeat:
      break;
  }
  return ((i % size) + size) % size;
}

// Coordinates far outside would leave the range of integers: whole periods of two (a mirror's) do not change the lookup.
double tamed(double t, Wrap wrap) {
  if (!std::isfinite(t)) return 0;
  if (wrap == Wrap::clamp) return std::clamp(t, -1.0, 2.0);
  return std::abs(t) > 1024 ? t - 2 * std::floor(t / 2) : t;
}

// The place in the picture, its sides 1, before it is wrapped.
Vec2d place(const Texture& texture, Vec2d uv) {
  const auto& m = texture.uv_transform;
  return {tamed(m[0][0] * uv.x + m[0][1] * uv.y + m[0][2], texture.wrap_u),
          tamed(m[1][0] * uv.x + m[1][1] * uv.y + m[1][2], texture.wrap_v)};
}

Rgba sample_at(const DecodedImage& image, const Texture& texture, double u, double v) {
  const auto texel = [&](std::int64_t x, std::int64_t y) {
    const auto column = static_cast<std::size_t>(wrapped(x, image.width, texture.wrap_u));
    const auto row = static_cast<std::size_t>(wrapped(y, image.height, texture.wrap_v));
    return image.rgba.data() + (row * image.width + column) * 4;
  };
  if (texture.nearest) {
    const float* t = texel(static_cast<std::int64_t>(std::floor(u * image.width)), static_cast<std::int64_t>(std::floor(v * image.height)));
    return {t[0], t[1], t[2], t[3]};
  }
  // Texel i covers [i, i + 1) and has its value at i + 1/2.
  const double x = u * image.width - 0.5, y = v * image.height - 0.5;
  const auto ix = static_cast<std::int64_t>(std::floor(x)), iy = static_cast<std::int64_t>(std::floor(y));
  const double fx = x - static_cast<double>(ix), fy = y - static_cast<double>(iy);
  const float *a = texel(ix, iy), *b = texel(ix + 1, iy), *c = texel(ix, iy + 1), *d = texel(ix + 1, iy + 1);
  const auto mix = [&](int k) { return (a[k] * (1 - fx) + b[k] * fx) * (1 - fy) + (c[k] * (1 - fx) + d[k] * fx) * fy; };
  return {mix(0), mix(1), mix(2), mix(3)};
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
