// Where a texture is looked up, and what is found between texels.
#pragma once

#include "etendue/image.h"
#include "etendue/vec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace etendue {

// Index of the texel that stands at place i of the endless row.
inline std::int64_t wrapped(std::int64_t i, std::int64_t size, Wrap wrap) {
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
inline double tamed(double t, Wrap wrap) {
  if (!std::isfinite(t)) return 0;
  if (wrap == Wrap::clamp) return std::clamp(t, -1.0, 2.0);
  return std::abs(t) > 1024 ? t - 2 * std::floor(t / 2) : t;
}

// The place in the picture, its sides 1, before it is wrapped.
inline Vec2d place(const Texture& texture, Vec2d uv) {
  const auto& m = texture.uv_transform;
  return {tamed(m[0][0] * uv.x + m[0][1] * uv.y + m[0][2], texture.wrap_u),
          tamed(m[1][0] * uv.x + m[1][1] * uv.y + m[1][2], texture.wrap_v)};
}

// A place between texels: texel i covers [i, i + 1) and has its value at i + 1/2. Nearest: `low` alone.
struct Between {
  std::int64_t low;
  double share;  // of low + 1
};
inline Between between(double t, std::uint32_t size, bool nearest) {
  const double x = t * size - (nearest ? 0 : 0.5), low = std::floor(x);
  return {static_cast<std::int64_t>(low), nearest ? 0 : x - low};
}

// Of four texels the mean by their shares: a, and b to its right; below them c and d.
template <class Texel>
std::array<double, 4> mean_of(const Texel& a, const Texel& b, const Texel& c, const Texel& d, double right, double below) {
  std::array<double, 4> out{};
  for (std::size_t k = 0; k < 4; ++k)
    out[k] = (a[k] * (1 - right) + b[k] * right) * (1 - below) + (c[k] * (1 - right) + d[k] * right) * below;
  return out;
}

// `texel(x, y)` is four floats at indices that are not wrapped yet.
template <class Texel>
std::array<double, 4> mixed(const Between& x, const Between& y, bool nearest, Texel texel) {
  const auto a = texel(x.low, y.low);
  if (nearest) {
    std::array<double, 4> out{};
    for (std::size_t k = 0; k < 4; ++k) out[k] = static_cast<double>(a[k]);
    return out;
  }
  const auto b = texel(x.low + 1, y.low), c = texel(x.low, y.low + 1), d = texel(x.low + 1, y.low + 1);
  return mean_of(a, b, c, d, x.share, y.share);
}

}  // namespace etendue
