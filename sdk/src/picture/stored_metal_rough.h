// Metallic-roughness as textures hold it: the codes for a pair of colours, and how much each kind of reader counts in their choice.
#pragma once

#include "code_table.h"
#include "etendue/material_conversion.h"
#include "texel_cache.h"

#include <span>

namespace etendue {

// The best of what can be stored: metal masks on both sides of the best one, with the base colour and dielectric f0 for each.
class StoredMetalRough {
 public:
  // `largest_k`: of the dielectric part's f0, which is stored as a share of it. Serves a core-only reader until fit() is called.
  StoredMetalRough(int bits, const Rgb& largest_k);

  // Readers::all: the weight of the full reader that keeps its rms over the samples within full_reader_limit(). Where the two codes around
  // the best mask are too few for that (a bright surface: steps of 8-bit sRGB near 1 are .009), six are tried.
  void fit(std::span<const ColourPair> samples);

  // Codes: 0-2 base colour, 3 metal, 4-6 dielectric f0 over its largest.
  TexelValue operator()(const ColourPair& pair) const;

  double weight() const { return weight_; }
  const CodeTable& colour() const { return colour_; }
  const CodeTable& mask() const { return mask_; }

 private:
  MetalRoughColours store(std::uint16_t metal, const ColourPair& pair, TexelValue& out) const;
  double full_rms(std::span<const ColourPair> samples) const;

  int bits_;
  CodeTable colour_, mask_;
  Rgb largest_k_;
  double weight_;
  int further_codes_ = 0;  // on each side
};

}  // namespace etendue
