// How much a full reader's error counts, so that it stays within a limit and a core-only reader gets the rest.
#pragma once

#include <algorithm>
#include <cmath>

namespace etendue {

// Of a core-only reader alone: just enough to choose the better of what is the same to it.
inline constexpr double weight_for_core = 1e-3;
// With which a full reader sees what it can, but for differences that no number of digits shows.
inline constexpr double largest_weight = 1e7;

// The least weight, of those a factor of 10^(1/8) apart, with which `full_rms(weight)` is within the limit; where no weight brings it
// there, within 3 % of what the largest one does. The more the full reader counts, the smaller its error: bisection.
template <class FullRms>
double least_weight(double limit, FullRms full_rms) {
  constexpr int rungs = 8 * 7;  // from 1 to largest_weight
  const auto weight = [](int rung) { return std::pow(10.0, rung / 8.0); };
  const double bound = std::max(limit, 1.03 * full_rms(weight(rungs)));
  int low = -1, high = rungs;  // `high` is within the bound, `low` is not
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (full_rms(weight(middle)) <= bound ? high : low) = middle;
  }
  return weight(high);
}

}  // namespace etendue
