// What was found for texels, by the numbers that they hold.
#pragma once

#include "etendue/material_fit.h"

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace etendue {

using TexelKey = std::array<float, 8>;

// The codes that are stored for a texel, and what readers make of them.
struct TexelValue {
  std::array<std::uint16_t, 8> codes{};
  ColourPair wanted, core, full;
};

// One place a hash: a texel that meets another one in its place takes it. What is found is a function of the key alone, so that neither the
// order of the texels nor the number of caches has any effect on it.
class TexelCache {
 public:
  TexelCache() : entries_(std::size_t{1} << 17) {}

  // `found` makes a value of a key, `leaving` takes a value with the number of texels that had it.
  template <class Find, class Leaving>
  const TexelValue& at(const TexelKey& key, Find find, Leaving leaving) {
    Entry& entry = entries_[hash(key)];
    if (entry.count == 0 || entry.key != key) {
      if (entry.count > 0) leaving(entry.value, entry.count);
      entry = {key, find(key), 0};
    }
    ++entry.count;
    return entry.value;
  }
  template <class Leaving>
  void empty(Leaving leaving) {
    for (Entry& entry : entries_) {
      if (entry.count > 0) leaving(entry.value, entry.count);
      entry.count = 0;
    }
  }

 private:
  struct Entry {
    TexelKey key{};
    TexelValue value;
    std::uint64_t count = 0;
  };
  // Fowler, Noll and Vo's multiplication over the numbers' bits, its high half taken.
  std::size_t hash(const TexelKey& key) const {
    std::uint64_t h = 0xcbf29ce484222325u;
    for (const float value : key) h = (h ^ std::bit_cast<std::uint32_t>(value)) * 0x9e3779b97f4a7c15u;
    return static_cast<std::size_t>(h >> 32) & (entries_.size() - 1);
  }
  std::vector<Entry> entries_;
};

}  // namespace etendue
