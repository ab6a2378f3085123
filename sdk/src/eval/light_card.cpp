#include "etendue/light_card.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace etendue::eval {
namespace {

// Integral of texel k's share in the joined picture from somewhere up to x, texels at 0 .. count - 1: a tent of the width 2 around k, and 1
// beyond the middles of the first and the last.
double tent_integral(double x, std::uint32_t k, std::uint32_t count) {
  const double t = x - k;
  if (t < 0) return k == 0 ? 0.5 + t : 0.5 * std::pow(std::max(1 + t, 0.0), 2);
  return k + 1 == count ? 0.5 + t : 1 - 0.5 * std::pow(std::max(1 - t, 0.0), 2);
}
// Of cell j of `cells`: the mean of texel k's share over it.
double share(std::uint32_t j, std::uint32_t cells, std::uint32_t k, std::uint32_t count) {
  const double per_cell = static_cast<double>(count) / cells, begin = j * per_cell - 0.5, end = begin + per_cell;
  return (tent_integral(end, k, count) - tent_integral(begin, k, count)) / per_cell;
}
// Cells that texel k has a share in.
struct Range {
  std::uint32_t begin, end;
};
Range cells_of(std::uint32_t k, std::uint32_t count, std::uint32_t cells) {
  const double per_texel = static_cast<double>(cells) / count;
  const double begin = k == 0 ? 0 : (k - 0.5) * per_texel, end = k + 1 == count ? cells : (k + 1.5) * per_texel;
  return {static_cast<std::uint32_t>(begin), std::min(static_cast<std::uint32_t>(std::ceil(end)), cells)};
}

// Half a texel or less, so that means over the finest cells follow the joined picture.
int finest_level(std::uint32_t width, std::uint32_t height) {
  const std::uint64_t texels = 2 * std::uint64_t{std::max({width, height, 1U})};
  return std::min(static_cast<int>(std::bit_width(texels - 1)), LightCard::most_levels);
}

}  // namespace

LightCardBuilder::LightCardBuilder(std::uint32_t width, std::uint32_t height)
    : width_(width), height_(height), level_(finest_level(width, height)), sums_(std::size_t{1} << (2 * level_)) {}

void LightCardBuilder::add_row(std::span<const float> rgba) {
  if (row_ >= height_ || rgba.size() < std::size_t{4} * width_) return;
  const std::uint32_t cells = 1U << level_;
  std::vector<std::array<double, 6>> along(cells);
  for (std::uint32_t k = 0; k < width_; ++k) {
    const Range range = cells_of(k, width_, cells);
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
      const double weight = share(i, cells, k, width_);
      for (std::size_t c = 0; c < 3; ++c) {
        const double value = rgba[4 * std::size_t{k} + c];
        along[i][c] += weight * value, along[i][c + 3] += weight * value * value;
      }
    }
  }
  const Range range = cells_of(row_, height_, cells);
  for (std::uint32_t j = range.begin; j < range.end; ++j) {
    const double weight = share(j, cells, row_, height_);
    for (std::uint32_t i = 0; i < cells; ++i)
      for (std::size_t c = 0; c < 6; ++c) sums_[(std::size_t{j} << level_) + i][c] += weight * along[i][c];
  }
  ++row_;
}

LightCard LightCardBuilder::finish() && {
  LightCard card;
  card.levels_.resize(static_cast<std::size_t>(level_) + 1);
  for (int level = level_; level >= 0; --level) {
    auto& cells = card.levels_[static_cast<std::size_t>(level)];
    cells.reserve(sums_.size());
    for (const auto& s : sums_) {
      double variance = 0;
      for (std::size_t c = 0; c < 3; ++c) variance = std::max(variance, s[c + 3] - s[c] * s[c]);
      cells.push_back(
          {{static_cast<float>(s[0]), static_cast<float>(s[1]), static_cast<float>(s[2])}, static_cast<float>(std::sqrt(variance))});
    }
    if (level == 0) break;
    const std::size_t side = std::size_t{1} << (level - 1);
    std::vector<std::array<double, 6>> coarser(side * side);
    for (std::size_t j = 0; j < 2 * side; ++j) {
      for (std::size_t i = 0; i < 2 * side; ++i) {
        for (std::size_t c = 0; c < 6; ++c) coarser[j / 2 * side + i / 2][c] += 0.25 * sums_[j * 2 * side + i][c];
      }
    }
    sums_ = std::move(coarser);
  }
  return card;
}

Rgb LightCard::lookup(Vec2d uv, double level) const {
  const double l = std::clamp(level, 0.0, static_cast<double>(finest()));
  const int below = std::min(static_cast<int>(l), std::max(finest() - 1, 0));
  const auto on = [&](int k) {
    const std::uint32_t side = 1U << k;
    const auto place = [&](double t) { return std::clamp(t * side - 0.5, 0.0, side - 1.0); };
    const double x = place(uv.x), y = place(uv.y);
    const auto i = static_cast<std::uint32_t>(x), j = static_cast<std::uint32_t>(y);
    const std::uint32_t i1 = std::min(i + 1, side - 1), j1 = std::min(j + 1, side - 1);
    const auto at = [&](std::uint32_t a, std::uint32_t b) { return vec_cast<double>(cell(k, a, b).mean); };
    const double u = x - i, v = y - j;
    return (at(i, j) * (1 - u) + at(i1, j) * u) * (1 - v) + (at(i, j1) * (1 - u) + at(i1, j1) * u) * v;
  };
  const double t = l - below;
  return finest() == 0 ? on(0) : on(below) * (1 - t) + on(below + 1) * t;
}

}  // namespace etendue::eval
