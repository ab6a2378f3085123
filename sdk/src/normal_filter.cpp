#include "etendue/normal_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace etendue {
namespace {

constexpr std::size_t steps = 16;
struct Node {
  float factor, misplaced;
};
constexpr std::array<Node, (steps + 1) * (steps + 1)> table{{
#include "normal_filter_table.inc"
}};

// The table's place of alpha and b = s / sqrt(1 + s^2), s^2 = 2 / kappa: its size is the larger of them, its turn half their ratio from the
// side of alpha.
FilteredLobe nearest_ggx(double alpha, double squared_spread) {
  const double bent = std::sqrt(squared_spread / (1 + squared_spread)), size = std::max(alpha, bent);
  if (!(size > 0)) return {0, 0};
  const double turn = alpha >= bent ? 0.5 * bent / alpha : 1 - 0.5 * alpha / bent;
  const double x = turn * steps, y = std::min(size, 1.0) * steps;
  const auto column = std::min(static_cast<std::size_t>(x), steps - 1), row = std::min(static_cast<std::size_t>(y), steps - 1);
  const double u = x - static_cast<double>(column), v = y - static_cast<double>(row);
  const auto read = [&](float Node::*which) {
    const auto at = [&](std::size_t r, std::size_t c) { return static_cast<double>(table[r * (steps + 1) + c].*which); };
    return (1 - v) * ((1 - u) * at(row, column) + u * at(row, column + 1)) +
           v * ((1 - u) * at(row + 1, column) + u * at(row + 1, column + 1));
  };
  const double estimate = std::sqrt((alpha * alpha + squared_spread) / (1 + squared_spread));
  return {std::min(1.0, estimate * read(&Node::factor)), read(&Node::misplaced)};
}

}  // namespace

double mean_normal_length(double concentration) {
  const double k = std::max(concentration, 0.0);
  if (k == std::numeric_limits<double>::infinity()) return 1;
  // coth k - 1 / k = k / 3 - k^3 / 45 + 2 k^5 / 945 - k^7 / 4725 ...
  if (k < 0.05) return k * (1.0 / 3 - k * k * (1.0 / 45 - k * k * (2.0 / 945 - k * k / 4725)));
  return 1 / std::tanh(k) - 1 / k;
}

// Newton's steps from Banerjee et al. 2005 ("Clustering on the unit hypersphere"), (3 r - r^3) / (1 - r^2), which is within 3 %.
double normal_concentration(double mean_length) {
  const double r = std::clamp(mean_length, 0.0, 1.0);
  if (r == 1) return std::numeric_limits<double>::infinity();
  double k = r * (3 - r * r) / (1 - r * r);
  for (int i = 0; i < 4; ++i) {
    const double sinh = std::sinh(std::min(k, 300.0));
    const double slope = k < 0.05 ? 1.0 / 3 - k * k * (1.0 / 15 - 2.0 / 189 * k * k) : 1 / (k * k) - 1 / (sinh * sinh);
    k = std::max(0.0, k - (mean_normal_length(k) - r) / slope);
  }
  return k;
}

std::optional<NormalFilter> normal_filter_named(std::string_view name) {
  if (name == "ggx") return NormalFilter::ggx;
  if (name == "slopes") return NormalFilter::slopes;
  if (name == "listing32") return NormalFilter::listing32;
  return std::nullopt;
}

FilteredLobe filtered_lobe(double alpha, double mean_length, NormalFilter filter) {
  const double a = std::clamp(alpha, 0.0, 1.0), r = std::clamp(mean_length, 0.0, 1.0);
  if (r == 1) return {a, 0};
  switch (filter) {
    case NormalFilter::ggx: {
      const double concentration = normal_concentration(r);
      // Normals in all directions: facets too.
      return concentration > 0 ? nearest_ggx(a, 2 / concentration) : FilteredLobe{1, 0};
    }
    case NormalFilter::slopes:
      return {std::sqrt(std::min(1.0, a * a + 2 / normal_concentration(r))), 0};
    case NormalFilter::listing32: {
      const double printed = (3 * r - r * r) / (1 - r * r);
      return {std::sqrt(std::min(1.0, a * a + 1 / (2 * printed))), 0};
    }
  }
  return {a, 0};
}

}  // namespace etendue
