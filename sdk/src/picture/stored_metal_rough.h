// Metallic-roughness as textures hold it: the codes for a pair of colours, and how much each kind of reader counts in their choice.
#pragma once

#include "code_table.h"
#include "metal_rough_colours.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace etendue {

// What other codes may cost a core-only reader and a full one.
struct CostLimits {
  float core = 0, full = 0;
};

// What the two kinds of readers make of a texel.
struct ReadColours {
  ColourPair core, full;
};

class StoredMetalRough {
 public:
  using Codes = std::array<std::uint16_t, 8>;
  // What they are: 0-2 base colour, 3 metal mask, 4-6 dielectric f0 over its largest, 7 the mask that is binary if possible.
  static constexpr std::size_t metal = 3, dielectric = 4, binary = 7;
  struct Choice {
    Codes codes{};
    CostLimits limits;  // for other masks
  };

  // `largest_k`: of the dielectric part's f0, which is stored as a share of it. Serves a core-only reader until fit() is called.
  StoredMetalRough(int bits, const Rgb& largest_k);

  // Readers::all: the weight of the full reader that keeps its rms over the samples within full_reader_limit(). Where the two codes around
  // the best mask are too few for that (a bright surface: steps of 8-bit sRGB near 1 are .009), six are tried.
  void fit(std::span<const ColourPair> samples);

  // Of each pair the best one of the codes on both sides of the best mask, by what is stored. Codes [binary]: 0 or else 1 where that is as
  // good.
  void best_of(std::span<const ColourPair> pairs, std::vector<Choice>& out) const;
  // Of masks that are as good the one nearest to `wanted`, on the way there from the best one.
  Codes towards(std::uint16_t wanted, const Choice& choice, const ColourPair& pair) const;
  ReadColours read(const Codes& codes) const;

  double weight() const { return weight_; }
  const CodeTable& colour() const { return colour_; }
  const CodeTable& mask() const { return mask_; }

 private:
  struct Candidate {
    Codes codes{};
    ReaderCosts costs;
  };
  Choice best_beside(const MetalRoughColours& ideal, const ColourPair& pair) const;
  Candidate at(std::uint16_t metal, const ColourPair& pair) const;
  double full_rms(std::span<const ColourPair> samples) const;
  bool is_as_good(std::uint16_t metal, const ColourPair& pair, const CostLimits& limits) const;

  int bits_;
  CodeTable colour_, mask_;
  Rgb largest_k_;
  double weight_;
  int further_codes_ = 0;  // on each side
};

}  // namespace etendue
