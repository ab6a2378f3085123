// What was found for texels, by the numbers that they hold.
#pragma once

#include "etendue/material_fit.h"

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace etendue {

using TexelKey = std::array<float, 8>;
// Their bits.
inline std::array<std::uint64_t, 4> words_of(const TexelKey& key) { return std::bit_cast<std::array<std::uint64_t, 4>>(key); }
inline bool same_numbers(const TexelKey& a, const TexelKey& b) { return words_of(a) == words_of(b); }

// What other codes may cost a core-only reader and a full one.
struct CostLimits {
  float core = 0, full = 0;
};

// The codes that are stored for a texel, and what readers make of them.
struct TexelValue {
  std::array<std::uint16_t, 8> codes{};
  ColourPair wanted, core, full;
  CostLimits limits;
};

// One place a hash: a texel that meets another one in its place takes it. What is found is a function of the key alone, so that neither the
// order of the texels nor the number of caches has any effect on it.
class TexelCache {
 public:
  struct Entry {
    TexelKey key{};
    TexelValue value;
    std::uint64_t count = 0;    // of texels
    std::uint64_t stretch = 0;  // that last used it; 0: empty
  };
  TexelCache() : entries_(std::size_t{1} << 16) {}

  // For x from 0 to `width`: `use(x, value)` with the value of `key_at(x)`, true if the texel takes it. Those that are not known are given
  // to `solve(entries)` together, for a stretch of texels that find places beside each other. `leaving(value, count)` takes what falls out.
  template <class KeyAt, class Solve, class Use, class Leaving>
  void row(std::uint32_t width, KeyAt key_at, Solve solve, Use use, Leaving leaving) {
    std::uint32_t begin = 0;
    const auto finish = [&](std::uint32_t end) {
      if (!fresh_.empty()) solve(std::span<Entry* const>(fresh_));
      for (std::uint32_t x = begin; x < end; ++x) use(x, std::as_const(used_[x - begin]->value));
      fresh_.clear();
      used_.clear();
      begin = end;
      ++stretch_;
    };
    for (std::uint32_t x = 0; x < width; ++x) {
      const TexelKey key = key_at(x);
      Entry* entry = used_.empty() || !same_numbers(used_.back()->key, key) ? &entries_[hash(key)] : used_.back();
      if (entry->stretch == 0 || !same_numbers(entry->key, key)) {
        if (entry->stretch == stretch_) finish(x);
        if (entry->count > 0) leaving(std::as_const(entry->value), entry->count);
        entry->key = key;
        entry->count = 0;
        fresh_.push_back(entry);
      }
      entry->stretch = stretch_;
      ++entry->count;
      used_.push_back(entry);
    }
    finish(width);
  }

  // The value of one texel.
  template <class Find, class Leaving>
  const TexelValue& at(const TexelKey& key, Find find, Leaving leaving) {
    Entry& entry = last_ != nullptr && same_numbers(last_->key, key) ? *last_ : entries_[hash(key)];
    last_ = &entry;
    if (entry.stretch == 0 || !same_numbers(entry.key, key)) {
      if (entry.count > 0) leaving(entry.value, entry.count);
      entry = {key, find(key), 0, stretch_};
    }
    ++entry.count;
    return entry.value;
  }

  template <class Leaving>
  void empty(Leaving leaving) {
    for (Entry& entry : entries_) {
      if (entry.count > 0) leaving(entry.value, entry.count);
      entry.count = 0;
      entry.stretch = 0;
    }
  }

 private:
  // Over the numbers' bits, two at a time: multiplied, and the high half folded into the low one, which it would not reach.
  std::size_t hash(const TexelKey& key) const {
    std::uint64_t h = 0xcbf29ce484222325u;
    for (const std::uint64_t word : words_of(key)) {
      h = (h ^ word) * 0x9e3779b97f4a7c15u;
      h ^= h >> 32;
    }
    return static_cast<std::size_t>(h) & (entries_.size() - 1);
  }
  std::vector<Entry> entries_;
  std::vector<Entry*> fresh_, used_;
  Entry* last_ = nullptr;
  std::uint64_t stretch_ = 1;
};

}  // namespace etendue
