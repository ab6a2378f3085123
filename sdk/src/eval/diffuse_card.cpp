#include "etendue/diffuse_card.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {
namespace {

constexpr double first_distance = 4;  // in longer sides: the picture's weights differ by 4 % at most from there

// Sum of the card's cells with the solid angle of each from a place: area r / d^3 of cells that are a quarter of the distance d wide at
// most, which is 1 % off then, much alike in neighbours.
class Seen {
 public:
  Seen(const LightCard& card, double width, double height, Vec2d from, double distance)
      : card_(card), width_(width), height_(height), from_(from), squared_(distance * distance) {
    add(0, 0, 0);
  }
  Vec3f mean() const { return vec_cast<float>(sum_ / weights_); }

 private:
  void add(int level, std::uint32_t x, std::uint32_t y) {
    constexpr double widest = 0.25;
    const double side = std::ldexp(1.0, -level), w = side * width_, h = side * height_;
    const double dx = (x + 0.5) * w - from_.x, dy = (y + 0.5) * h - from_.y, d2 = dx * dx + dy * dy + squared_;
    const LightCard::Cell& cell = card_.cell(level, x, y);
    if (level == card_.finest() || std::max(w, h) * std::max(w, h) <= widest * widest * d2) {
      const double weight = w * h / (d2 * std::sqrt(d2));
      sum_ += vec_cast<double>(cell.mean) * weight, weights_ += weight;
      return;
    }
    for (std::uint32_t i = 0; i < 4; ++i) add(level + 1, 2 * x + i % 2, 2 * y + i / 2);
  }

  const LightCard& card_;
  double width_, height_;
  Vec2d from_;
  double squared_, weights_ = 0;
  Rgb sum_;
};

}  // namespace

DiffuseCard::DiffuseCard(const LightCard& card, double width, double height)
    : longer_(std::max(width, height)), mean_(card.cell(0, 0, 0).mean) {
  for (int level = 0; level <= std::min(card.finest(), most_levels); ++level) {
    const std::uint32_t side = 1U << level;
    const double distance = std::ldexp(first_distance * longer_, -level);
    std::vector<Vec3f>& layer = layers_.emplace_back();
    layer.reserve(std::size_t{side} * side);
    for (std::uint32_t y = 0; y < side; ++y)
      for (std::uint32_t x = 0; x < side; ++x)
        layer.push_back(Seen(card, width, height, {(x + 0.5) / side * width, (y + 0.5) / side * height}, distance).mean());
  }
}

Rgb DiffuseCard::on(std::size_t layer, Vec2d uv) const {
  const std::uint32_t side = 1U << layer;
  const auto place = [&](double t) { return std::clamp(t * side - 0.5, 0.0, side - 1.0); };
  const double x = place(uv.x), y = place(uv.y);
  const auto i = static_cast<std::uint32_t>(x), j = static_cast<std::uint32_t>(y);
  const std::uint32_t i1 = std::min(i + 1, side - 1), j1 = std::min(j + 1, side - 1);
  const auto at = [&](std::uint32_t a, std::uint32_t b) { return vec_cast<double>(layers_[layer][std::size_t{b} * side + a]); };
  const double u = x - i, v = y - j;
  return (at(i, j) * (1 - u) + at(i1, j) * u) * (1 - v) + (at(i, j1) * (1 - u) + at(i1, j1) * u) * v;
}

Rgb DiffuseCard::lookup(Vec2d uv, double distance) const {
  const double level = std::log2(first_distance * longer_ / std::max(distance, 1e-12 * longer_));
  if (level <= 0) {  // the first layer has one place; beyond it the mean, reached at twice the distance
    const double t = std::min(-level, 1.0);
    return vec_cast<double>(layers_[0][0]) * (1 - t) + vec_cast<double>(mean_) * t;
  }
  const double l = std::min(level, static_cast<double>(layers_.size() - 1));
  const std::size_t below = std::min(static_cast<std::size_t>(l), layers_.size() - 1), above = std::min(below + 1, layers_.size() - 1);
  const double t = l - static_cast<double>(below);
  return on(below, uv) * (1 - t) + on(above, uv) * t;
}

}  // namespace etendue::eval
