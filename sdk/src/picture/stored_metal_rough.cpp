#include "stored_metal_rough.h"

#include <cmath>
#include <limits>

#include "deviations.h"
#include "reader_weight.h"

namespace etendue {

StoredMetalRough::StoredMetalRough(int bits, const Rgb& largest_k)
    : bits_(bits), colour_(bits, true), mask_(bits, false), largest_k_(largest_k), weight_(weight_for_core) {}

void StoredMetalRough::fit(std::span<const ColourPair> samples) {
  // The samples' rms is that of all texels to some percent.
  const double aim = 0.97 * full_reader_limit(bits_);
  const auto with = [&](double weight) {
    weight_ = weight;
    return full_rms(samples);
  };
  further_codes_ = 0;
  if (with(largest_weight) > aim) further_codes_ = 2;
  weight_ = least_weight(aim, with);
}

double StoredMetalRough::full_rms(std::span<const ColourPair> samples) const {
  DeviationSums sums;
  for (const ColourPair& pair : samples) sums.add((*this)(pair).full, pair);
  return rms_of(sums.deviation());
}

TexelValue StoredMetalRough::operator()(const ColourPair& pair) const {
  const double metal = metal_rough_of(pair, weight_).metal * mask_.top();
  const int first = std::max(static_cast<int>(std::floor(metal)) - further_codes_, 0);
  const int last = std::min(static_cast<int>(std::ceil(metal)) + further_codes_, mask_.top());
  TexelValue best;
  double least = std::numeric_limits<double>::infinity();
  for (int code = first; code <= last; ++code) {
    TexelValue value;
    const double cost = metal_rough_cost(store(static_cast<std::uint16_t>(code), pair, value), pair, weight_);
    if (!(cost < least)) continue;
    least = cost;
    best = value;
  }
  return best;
}

MetalRoughColours StoredMetalRough::store(std::uint16_t metal, const ColourPair& pair, TexelValue& out) const {
  MetalRoughColours stored = metal_rough_at(mask_.linear(metal), pair, weight_);
  out.codes[3] = metal;
  for (int c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    stored.base[c] = colour_.linear(out.codes[channel] = colour_.nearest(stored.base[c]));
    const double left = 1 - stored.metal, largest = largest_k_[c];
    // Where it has no effect: at metals, and where no texel has any.
    const double k = left > 0 && largest > 0 ? (pair.f0[c] - stored.metal * stored.base[c]) / left / largest : 1;
    out.codes[4 + channel] = colour_.nearest(k);
    stored.dielectric_f0[c] = largest * colour_.linear(out.codes[4 + channel]);
  }
  out.wanted = pair;
  out.core = in_core_reader(stored);
  out.full = in_full_reader(stored);
  return stored;
}

}  // namespace etendue
