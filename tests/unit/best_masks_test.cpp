// The search of metal masks in lanes: what is stored may not depend on the machine.
#include "picture/best_masks.h"

#include "draws.h"
#include "instruction_sets.h"
#include "picture/metal_rough_colours.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace etendue {
namespace {

std::vector<ColourPair> some_pairs() {
  Draws draw(1);
  std::vector<ColourPair> pairs{{{0, 0, 0}, {0, 0, 0}}, {{1, 1, 1}, {1, 1, 1}}, {{0, 1, 0}, {65504, 0, -1}}, {{1, 0, 0}, {0, 0, 0.04}}};
  for (int i = 0; i < 500; ++i) {
    const Rgb diffuse = draw.rgb(0, 1), f0 = draw.rgb(0, 1);
    pairs.push_back({diffuse, i % 2 ? f0 : Rgb{0.04, 0.04, 0.04}});
    const double grey = draw.within(0, 1);
    pairs.push_back({{grey, grey, grey}, f0});
  }
  return pairs;
}

std::vector<MaskCost> best_of(const std::vector<ColourPair>& pairs, double weight) {
  std::vector<MaskCost> out(pairs.size());
  best_masks(pairs, weight, out);
  return out;
}

TEST(BestMasks, TheSameBitsOnEveryInstructionSetAndInAnyCompany) {
  const std::vector<ColourPair> pairs = some_pairs();
  for (const double weight : {0.001, 1.0, 1e3, 1e7}) {
    std::vector<MaskCost> alone(pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) alone[i] = best_of({pairs[i]}, weight)[0];
    on_each_instruction_set([&] {
      const std::vector<MaskCost> found = best_of(pairs, weight);
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        EXPECT_EQ(found[i].metal, alone[i].metal) << i;
        EXPECT_EQ(found[i].cost, alone[i].cost) << i;
      }
    });
  }
}

// Both say the same in other words: some tens of roundings of sums of the order of weight and 1.
TEST(BestMasks, CostsAreThoseOfTheColours) {
  const std::vector<ColourPair> pairs = some_pairs();
  for (const double weight : {0.001, 1.0, 1e3, 1e7}) {
    const std::vector<MaskCost> found = best_of(pairs, weight);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double cost = metal_rough_cost(metal_rough_at(found[i].metal, pairs[i], weight), pairs[i], weight);
      EXPECT_NEAR(found[i].cost, cost, 1e-12 * cost + 1e-14) << i << ' ' << weight;
    }
  }
}

}  // namespace
}  // namespace etendue
