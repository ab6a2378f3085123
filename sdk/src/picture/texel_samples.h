// Some texels of a picture.
#pragma once

#include "etendue/material_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

// Some texels that stand for all: one in each cell of a grid, at a place in it that no pattern of the picture follows.
class Samples {
 public:
  Samples(std::uint32_t width, std::uint32_t height)
      : cell_(static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(width) * height / 2048)))),
        columns_((width + cell_ - 1) / cell_),
        pairs_(std::size_t{columns_} * ((height + cell_ - 1) / cell_)),
        width_(width),
        height_(height) {}
  // The sampled texels of a row. Each has a place of its own, so that rows can be given from several threads.
  template <class PairAt>
  void add_row(std::uint32_t y, PairAt pair_at) {
    const std::uint32_t row = y / cell_;
    if (place(row, columns_, std::min(cell_, height_ - row * cell_)) != y % cell_) return;
    for (std::uint32_t column = 0; column < columns_; ++column)
      pairs_[std::size_t{row} * columns_ + column] = pair_at(column * cell_ + place(row, column, std::min(cell_, width_ - column * cell_)));
  }
  std::span<const ColourPair> pairs() const { return pairs_; }

 private:
  // The high half of a product of Knuth's multiplicative hashing.
  static std::uint32_t place(std::uint32_t row, std::uint32_t column, std::uint32_t size) {
    const std::uint64_t hash = ((std::uint64_t{row} << 32 | column) + 1) * 0x9e3779b97f4a7c15u;
    return static_cast<std::uint32_t>((hash >> 40) % size);
  }
  std::uint32_t cell_, columns_;
  std::vector<ColourPair> pairs_;
  std::uint32_t width_, height_;
};

}  // namespace etendue
