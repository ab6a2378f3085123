// Metal masks of texels beside each other, so that one can follow its neighbours, and how much they differ.
#pragma once

#include "stored_metal_rough.h"
#include "texture_rows.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace etendue {

// Sum of |differences| of codes between neighbours in a row and in a column: whole numbers, so that their order does not matter.
class MaskVariation {
 public:
  // `above`: empty for the first row.
  template <class Codes>
  void add_row(std::uint32_t width, Codes code, const std::uint16_t* above) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const int here = code(x);
      if (x > 0) add(here, code(x - 1));
      if (above != nullptr) add(here, above[x]);
    }
  }
  void add(const MaskVariation& other) { sum_ += other.sum_, pairs_ += other.pairs_; }
  // Of two neighbours, on average; the mask from 0 to 1.
  double mean(int top) const { return pairs_ > 0 ? static_cast<double>(sum_) / static_cast<double>(pairs_) / top : 0; }

 private:
  void add(int a, int b) { sum_ += static_cast<std::uint64_t>(std::max(a, b) - std::min(a, b)), ++pairs_; }
  std::uint64_t sum_ = 0, pairs_ = 0;
};

// What was chosen for texels on their own, of as many rows as TextureRows::Work::survey is ahead.
class MetalMaskRows {
 public:
  MetalMaskRows(std::uint32_t width, std::uint32_t height, std::uint16_t top)
      : width_(width), height_(height), top_(top), choices_(std::size_t{width} * kept_rows), best_(choices_.size()), binary_(best_) {}

  void put(std::uint32_t x, std::uint32_t y, const StoredMetalRough::Choice& choice) {
    const std::size_t at = index(x, y);
    choices_[at] = choice;
    best_[at] = choice.codes[StoredMetalRough::metal];
    binary_[at] = choice.codes[StoredMetalRough::binary];
  }
  // After the last texel of a row: binary_ becomes what all texels up to `reach` to the left and right can be.
  void finish_row(std::uint32_t y) {
    std::uint16_t* const row = binary_.data() + index(0, y);
    std::vector<std::uint16_t>& own = scratch();
    own.assign(row, row + width_);
    std::uint32_t equal = 0;  // texels that end at `x` and can be the same
    for (std::uint32_t x = 0; x < width_ + reach; ++x) {
      if (x < width_) equal = x > 0 && own[x] == own[x - 1] ? equal + 1 : 1;
      if (x < reach) continue;
      const std::uint32_t middle = x - reach, begin = middle - std::min(middle, reach), end = std::min(x, width_ - 1);
      const bool binary = own[middle] == 0 || own[middle] == top_;
      row[middle] = binary && equal >= end - begin + 1 ? own[middle] : neither;
    }
  }
  const StoredMetalRough::Choice& at(std::uint32_t x, std::uint32_t y) const { return choices_[index(x, y)]; }
  const std::uint16_t* best_row(std::uint32_t y) const { return best_.data() + index(0, y); }

  // The masks that a row's texels shall come near to: 0 or 1 if all around one can be that, else the middle one of the best of the nine
  // around it, those beyond the border being the nearest inside. A smaller `reach` would let binary masks come and go like the noise that
  // they hide.
  void wanted_row(std::uint32_t y, std::vector<std::uint16_t>& out) const {
    const std::uint16_t* const middle = binary_.data() + index(0, y);
    out.assign(middle, middle + width_);
    for (std::uint32_t other = y - std::min(y, reach); other <= std::min(y + reach, height_ - 1); ++other) {
      const std::uint16_t* const row = binary_.data() + index(0, other);
      for (std::uint32_t x = 0; x < width_; ++x) out[x] = row[x] == middle[x] ? out[x] : neither;
    }
    const std::array<const std::uint16_t*, 3> rows{best_row(y > 0 ? y - 1 : y), best_row(y), best_row(std::min(y + 1, height_ - 1))};
    for (std::uint32_t x = 0; x < width_; ++x) {
      if (out[x] != neither) continue;
      std::array<std::uint16_t, 9> nine;
      std::size_t i = 0;
      for (const std::uint16_t* row : rows)
        for (const std::uint32_t column : {x > 0 ? x - 1 : x, x, std::min(x + 1, width_ - 1)}) nine[i++] = row[column];
      if (std::any_of(nine.begin(), nine.end(), [&](std::uint16_t code) { return code != nine[0]; }))
        std::nth_element(nine.begin(), nine.begin() + 4, nine.end());
      out[x] = nine[4];
    }
  }

 private:
  static constexpr std::uint32_t reach = 8, kept_rows = 4 * TextureRows::band_rows;
  static_assert(reach <= TextureRows::band_rows);
  static constexpr std::uint16_t neither = 1;  // of the two ends, 0 and 255 or more
  std::size_t index(std::uint32_t x, std::uint32_t y) const { return std::size_t{y % kept_rows} * width_ + x; }
  static std::vector<std::uint16_t>& scratch() {
    thread_local std::vector<std::uint16_t> row;
    return row;
  }
  std::uint32_t width_, height_;
  std::uint16_t top_;
  std::vector<StoredMetalRough::Choice> choices_;
  std::vector<std::uint16_t> best_, binary_;
};

}  // namespace etendue
