#include "stored_metal_rough.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "deviations.h"
#include "reader_weight.h"

namespace etendue {
namespace {

// Where codes are searched to keep the full reader's limit: the part of its square that masks may cost which go with their neighbours'.
// With what the search aims at it stays within the limit: .97^2 + .05 < 1.
constexpr double left_for_calm = 0.05;

}  // namespace

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
  std::vector<Choice> choices;
  best_of(samples, choices);
  DeviationSums sums;
  for (std::size_t i = 0; i < samples.size(); ++i) sums.add(read(choices[i].codes).full, samples[i]);
  return rms_of(sums.deviation());
}

// Each of base colour and dielectric f0 is chosen for what the others are once stored.
StoredMetalRough::Candidate StoredMetalRough::at(std::uint16_t metal_code, const ColourPair& pair) const {
  MetalRoughColours stored = metal_rough_of_held(mask_.linear(metal_code), pair, weight_);
  Candidate out;
  out.codes[metal] = metal_code;
  const double left = 1 - stored.metal, per_left = left > 0 ? 1 / left : 0;
  for (int c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    stored.base[c] = colour_.linear(out.codes[channel] = colour_.nearest(stored.base[c]));
    // Where it has no effect: at metals, and where no texel has any.
    const double k = left > 0 && largest_k_[c] > 0 ? (pair.f0[c] - stored.metal * stored.base[c]) * per_left / largest_k_[c] : 1;
    out.codes[dielectric + channel] = colour_.nearest(k);
    stored.dielectric_f0[c] = largest_k_[c] * colour_.linear(out.codes[dielectric + channel]);
  }
  out.costs = costs_of_held(stored, pair);
  return out;
}

// Before rounding, which costs more than the tolerance and a different sum at each mask, by chance; a dielectric f0 beyond what is stored
// is no choice. Where codes are searched for the full reader's limit, after it: another mask may not lose what that has gained.
bool StoredMetalRough::is_as_good(std::uint16_t metal_code, const ColourPair& pair, const CostLimits& limits) const {
  const auto within = [&](const ReaderCosts& costs) {
    return costs.core <= static_cast<double>(limits.core) && costs.full <= static_cast<double>(limits.full);
  };
  if (further_codes_ > 0) return within(at(metal_code, pair).costs);
  const MetalRoughColours colours = metal_rough_of_held(mask_.linear(metal_code), pair, weight_);
  const Rgb& k = colours.dielectric_f0;
  return within(costs_of_held(colours, pair)) &&
         (colours.metal == 1 || (k.x <= largest_k_.x && k.y <= largest_k_.y && k.z <= largest_k_.z));
}

void StoredMetalRough::best_of(std::span<const ColourPair> pairs, std::vector<Choice>& out) const {
  std::vector<MetalRoughColours> ideal;
  metal_rough_of_all(pairs, weight_, ideal);
  out.resize(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) out[i] = best_beside(ideal[i], pairs[i]);
}

StoredMetalRough::Choice StoredMetalRough::best_beside(const MetalRoughColours& ideal, const ColourPair& pair) const {
  const double place = ideal.metal * mask_.top();
  const int first = std::max(static_cast<int>(std::floor(place)) - further_codes_, 0);
  const int last = std::min(static_cast<int>(std::ceil(place)) + further_codes_, mask_.top());
  Candidate best = at(static_cast<std::uint16_t>(first), pair);
  for (int code = first + 1; code <= last; ++code)
    if (const Candidate other = at(static_cast<std::uint16_t>(code), pair); other.costs.sum(weight_) < best.costs.sum(weight_))
      best = other;

  // 6 h^2, h half a step; a full reader has less to give, unless nobody asks for it.
  const double half_step = 0.5 / mask_.top(), play = std::max(6 * half_step * half_step, equal_costs);
  const ReaderCosts costs = further_codes_ > 0 ? best.costs : costs_of_held(ideal, pair);
  const double limit = full_reader_limit(bits_), left = further_codes_ > 0 ? left_for_calm * 6 * limit * limit : play / 1000;
  const CostLimits limits{static_cast<float>(costs.core + play), static_cast<float>(costs.full + (weight_ < 1 ? play : left))};
  const auto top = static_cast<std::uint16_t>(mask_.top());
  const std::uint16_t own = best.codes[metal];
  const auto may_be = [&](std::uint16_t code) { return own == code || is_as_good(code, pair, limits); };
  best.codes[binary] = may_be(0) ? std::uint16_t{0} : may_be(top) ? top : own;
  return {best.codes, limits};
}

// The whole way if that is as good; else in steps that grow twofold as long as the masks are as good, then shrink to the last one that is.
// Along the way the cost has one valley, and what it does beyond the first mask that is too dear is of no interest.
StoredMetalRough::Codes StoredMetalRough::towards(std::uint16_t wanted, const Choice& choice, const ColourPair& pair) const {
  const int from = choice.codes[metal], way = std::abs(wanted - from), sign = wanted > from ? 1 : -1;
  const auto code_at = [&](int gone) { return static_cast<std::uint16_t>(from + sign * gone); };
  int gone = 0;
  const auto try_step = [&](int step) {
    const bool good = is_as_good(code_at(gone + step), pair, choice.limits);
    if (good) gone += step;
    return good;
  };
  if (way > 0 && !try_step(way)) {
    int step = 1;
    while (gone + step < way && try_step(step)) step *= 2;
    for (step /= 2; step > 0; step /= 2)
      if (gone + step < way) try_step(step);
  }
  return gone > 0 ? at(code_at(gone), pair).codes : choice.codes;
}

ReadColours StoredMetalRough::read(const Codes& codes) const {
  MetalRoughColours stored;
  stored.metal = mask_.linear(codes[metal]);
  for (int c = 0; c < 3; ++c) {
    const auto channel = static_cast<std::size_t>(c);
    stored.base[c] = colour_.linear(codes[channel]);
    stored.dielectric_f0[c] = largest_k_[c] * colour_.linear(codes[dielectric + channel]);
  }
  return {in_core_reader(stored), in_full_reader(stored)};
}

}  // namespace etendue
