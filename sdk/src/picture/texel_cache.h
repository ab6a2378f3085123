// What was found for texels, by the numbers that they hold.
#pragma once

#include <hwy/cache_control.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace etendue {

// The bits of eight floats, two a word.
using TexelKey = std::array<std::uint64_t, 4>;
inline std::uint64_t word_of(float low, float high) {
  return std::uint64_t{std::bit_cast<std::uint32_t>(high)} << 32 | std::bit_cast<std::uint32_t>(low);
}
inline float number_at(const TexelKey& key, std::size_t i) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(key[i / 2] >> (i % 2 * 32)));
}

// One place a hash: a texel that meets another one in its place takes it. What is found is a function of the key alone, so that neither the
// order of the texels nor the number of caches has any effect on it. With a Value of at most 24 bytes an entry is one cache line.
template <class Value>
class TexelCache {
 public:
  struct alignas(64) Entry {
    TexelKey key{};
    Value value{};
    std::uint64_t stretch = 0;  // that last used it; 0: empty
  };
  TexelCache() : entries_(std::size_t{1} << 16) {}

  // For x from 0 to `count`: `use(x, value)` with the value of `key_at(x)`. Those that are not known are given to `solve(entries)`
  // together, for a stretch of texels that find places beside each other. `leaving(key, value)` takes what falls out.
  template <class KeyAt, class Solve, class Use, class Leaving>
  void together(std::uint32_t count, KeyAt key_at, Solve solve, Use use, Leaving leaving) {
    std::uint32_t begin = 0;
    const auto finish = [&](std::uint32_t end) {
      if (!fresh_.empty()) solve(std::span<Entry* const>(fresh_));
      for (std::uint32_t x = begin; x < end; ++x) use(x, used_[x - begin]->value);
      fresh_.clear();
      used_.clear();
      begin = end;
      ++stretch_;
    };
    in_blocks(count, key_at, [&](std::uint32_t x, const Place& place) {
      Entry& entry = *place.entry;
      if (entry.stretch == 0 || entry.key != place.key) {
        if (entry.stretch == stretch_) finish(x);
        if (entry.stretch != 0) leaving(std::as_const(entry.key), std::as_const(entry.value));
        entry.key = place.key;
        entry.value = {};
        fresh_.push_back(&entry);
      }
      entry.stretch = stretch_;
      used_.push_back(&entry);
    });
    finish(count);
  }

  // The same, each found as it comes: `find(x, key)` is its value.
  template <class KeyAt, class Find, class Use, class Leaving>
  void each(std::uint32_t count, KeyAt key_at, Find find, Use use, Leaving leaving) {
    in_blocks(count, key_at, [&](std::uint32_t x, const Place& place) {
      Entry& entry = *place.entry;
      if (entry.stretch == 0 || entry.key != place.key) {
        if (entry.stretch != 0) leaving(std::as_const(entry.key), std::as_const(entry.value));
        entry = {place.key, find(x, place.key), stretch_};
      }
      use(x, entry.value);
    });
  }

  template <class Leaving>
  void empty(Leaving leaving) {
    for (Entry& entry : entries_) {
      if (entry.stretch != 0) leaving(std::as_const(entry.key), std::as_const(entry.value));
      entry.stretch = 0;
    }
  }

 private:
  struct Place {
    TexelKey key{};
    Entry* entry = nullptr;
  };
  // Memory is asked for the entries of some texels before the first of them is needed: they lie anywhere.
  template <class KeyAt, class Use>
  void in_blocks(std::uint32_t count, KeyAt key_at, Use use) {
    std::array<Place, 32> places;
    const auto most = static_cast<std::uint32_t>(places.size());
    for (std::uint32_t begin = 0; begin < count; begin += most) {
      const std::uint32_t some = std::min(most, count - begin);
      for (std::uint32_t i = 0; i < some; ++i) {
        places[i].key = key_at(begin + i);
        if (i > 0 && places[i].key == places[i - 1].key) {
          places[i].entry = places[i - 1].entry;
          continue;
        }
        places[i].entry = &entries_[hash(places[i].key)];
        hwy::Prefetch(places[i].entry);
      }
      for (std::uint32_t i = 0; i < some; ++i) use(begin + i, std::as_const(places[i]));
    }
  }

  // Over the numbers' bits, two at a time: multiplied, and the high half folded into the low one, which it would not reach.
  std::size_t hash(const TexelKey& key) const {
    std::uint64_t h = 0xcbf29ce484222325u;
    for (const std::uint64_t word : key) {
      h = (h ^ word) * 0x9e3779b97f4a7c15u;
      h ^= h >> 32;
    }
    return static_cast<std::size_t>(h) & (entries_.size() - 1);
  }
  std::vector<Entry> entries_;
  std::vector<Entry*> fresh_, used_;
  std::uint64_t stretch_ = 1;
};

}  // namespace etendue
