// What metal_rough_of() finds where that is known without a search of the mask.
#pragma once

#include "metal_rough_colours.h"

#include <optional>

namespace etendue {

// 0 or 1 where that is what metal_rough_with() chooses; the pair's numbers are held.
//
// At m = 0 a full reader is exact and a core-only one off by a = .04 - f in f0. No other mask costs a channel less if a >= 0 and
// d >= .04 + a / (2 (1 + w)). For any base colour b, with s = 1 - m, the cost is at least
//   (1 + w) (d - s b)^2 + (.04 s + m b - f)^2.
// If b >= .04, the second square is at least a^2. Else let u = .04 - b > 0, e = d - .04: the first is at least
// (1 + w) (e + u)^2 >= (1 + w) 4 e u >= 2 a u, the second (a - m u)^2 >= a^2 - 2 a u as long as m u <= a; and if u > a, 2 a u alone is
// more than a^2.
//
// A binary mask that costs next to nothing cannot be beaten by more than that; 0 comes before 1.
inline std::optional<double> mask_without_search(const ColourPair& pair, double weight) {
  bool plain = true;
  for (int c = 0; c < 3 && plain; ++c) {
    const double below = core_f0 - pair.f0[c];
    plain = below >= 0 && pair.f0[c] >= 0 && pair.diffuse[c] <= 1 && pair.diffuse[c] >= core_f0 + below / (2 * (1 + weight));
  }
  if (plain) return 0.0;
  const auto cost = [&](double mask) { return costs_of_held(metal_rough_of_held(mask, pair, weight), pair).sum(weight); };
  const double metal = cost(1);
  if (metal > equal_costs) return std::nullopt;
  return cost(0) > metal + equal_costs ? std::optional(1.0) : std::nullopt;
}

// Whether the dielectric f0 of metal_rough_of() certainly is below `largest` in each channel, whatever the mask.
//
// With s = 1 - m and b the best base colour, where no bound holds,
//   k = (f - m b) / s = ((1 + w) s^2 X + m^2 .04) / ((1 + w) s^2 + m^2),   X = ((f + d) s - d) / s^2,
// a mean of .04 and of what a full reader alone would have. X is greatest where dX/ds = (2 d - (f + d) s) / s^3 is 0 or at s = 1: there it
// is (f + d)^2 / (4 d), or f if d >= f. With d >= f moreover k <= f, that is b >= f, that is
//   (1 + w) (d - f s) + m f - .04 m >= 0,
// holds if f >= .04 / (2 + w) or d - f >= .04 / (1 + w). Where b is held to 1, b >= f as well.
// Black diffuse channels, which let masks come near to 1 at will, are left to the search; a margin takes what rounding does.
inline bool dielectric_is_below(const Rgb& largest, const ColourPair& pair, double weight) {
  for (int c = 0; c < 3; ++c) {
    const double d = pair.diffuse[c], f = pair.f0[c], top = largest[c] * (1 - 1e-6);
    if (!(d >= 1e-4 && d <= 1 && f >= 0 && f <= 1)) return false;
    const bool at_most_f = d >= f && (f * (2 + weight) >= core_f0 || (d - f) * (1 + weight) >= core_f0);
    const bool below = at_most_f ? f <= top : core_f0 <= top && (d >= f ? f <= top : (f + d) * (f + d) <= 4 * d * top);
    if (!below) return false;
  }
  return true;
}

}  // namespace etendue
