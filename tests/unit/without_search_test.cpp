// What is known of the best metal mask without a search is what the search finds.
#include "picture/without_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "draws.h"

namespace etendue {
namespace {

// Dielectrics around f0 = .04 and d = .04, metals without and with next to no diffuse colour, and anything.
std::vector<ColourPair> some_pairs(unsigned seed) {
  Draws draw(seed);
  std::vector<ColourPair> pairs{{{0, 0, 0}, {0, 0, 0}}, {{1, 1, 1}, {0, 0, 0}}, {{0.04, 0.04, 0.04}, {0.04, 0.04, 0.04}}};
  for (int i = 0; i < 300; ++i) {
    const Rgb dark = draw.rgb(0, 0.05), low = draw.rgb(0, 0.06), any_diffuse = draw.rgb(0, 1), any_f0 = draw.rgb(0, 1);
    const double little = draw.within(0, 1e-5);
    pairs.push_back({Rgb{0.02, 0.02, 0.02} + dark, low});
    pairs.push_back({any_diffuse, low});
    pairs.push_back({any_diffuse * little, any_f0});
    pairs.push_back({dark, any_f0});
    pairs.push_back({{0, 0, 0}, any_f0});
    pairs.push_back({any_diffuse, any_f0});
  }
  return pairs;
}

constexpr double weights[] = {1e-3, 1.0, 1e3, 1e7};

TEST(WithoutSearch, TheMaskIsTheOneThatIsFound) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const std::vector<ColourPair> pairs = some_pairs(seed);
    for (const double weight : weights) {
      std::size_t known[2] = {0, 0};
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        const std::optional<double> mask = mask_without_search(pairs[i], weight);
        if (!mask) continue;
        EXPECT_EQ(*mask, metal_rough_of(pairs[i], weight).metal) << seed << ' ' << i << ' ' << weight;
        ++known[*mask > 0 ? 1 : 0];
      }
      EXPECT_GT(known[0], 50u);
      EXPECT_GT(known[1], 100u);
    }
  }
}

TEST(WithoutSearch, ManyAreWhatEachIs) {
  const std::vector<ColourPair> pairs = some_pairs(4);
  for (const double weight : weights) {
    std::vector<MetalRoughColours> all;
    metal_rough_of_all(pairs, weight, all);
    ASSERT_EQ(all.size(), pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const MetalRoughColours one = metal_rough_of(pairs[i], weight);
      EXPECT_TRUE(all[i].base == one.base && all[i].metal == one.metal && all[i].dielectric_f0 == one.dielectric_f0) << i;
    }
  }
}

// At every mask, which includes the best one. A limit somewhat above f0 is where the answer is either.
TEST(WithoutSearch, WhatIsBelowIsBelowAtEveryMask) {
  for (const unsigned seed : {5u, 6u, 7u}) {
    const std::vector<ColourPair> pairs = some_pairs(seed);
    Draws draw(seed);
    for (const double weight : weights) {
      std::size_t below = 0, not_below = 0;
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        const double share = draw.within(0.9, 1.5);
        const Rgb largest = pairs[i].f0 * share;
        if (!dielectric_is_below(largest, pairs[i], weight)) {
          ++not_below;
          continue;
        }
        ++below;
        for (int step = 0; step < 100; ++step) {
          const Rgb k = metal_rough_at(step / 100.0, pairs[i], weight).dielectric_f0;
          for (int c = 0; c < 3; ++c) EXPECT_LE(k[c], largest[c]) << seed << ' ' << i << ' ' << step << ' ' << weight;
        }
      }
      EXPECT_GT(below, 50u);
      EXPECT_GT(not_below, 100u);
    }
  }
}

}  // namespace
}  // namespace etendue
