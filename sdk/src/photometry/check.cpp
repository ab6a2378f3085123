#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "etendue/photometry.h"

namespace etendue {
namespace {

struct Range {
  double lo, hi;
};

Range vertical_range(WebType type) { return type == WebType::c ? Range{0, 180} : type == WebType::b ? Range{-180, 180} : Range{-90, 90}; }
Range horizontal_range(WebType type) {
  return type == WebType::c ? Range{-360, 720} : type == WebType::b ? Range{-90, 90} : Range{-180, 180};
}

bool increasing_within(const std::vector<double>& angles, const Range& range) {
  if (angles.empty() || !(angles.front() >= range.lo) || !(angles.back() <= range.hi)) return false;
  return std::adjacent_find(angles.begin(), angles.end(), [](double a, double b) { return !(a < b); }) == angles.end();
}

Error invalid(const IntensityDistribution& d, std::string text) { return {"WEB_INVALID", std::move(text), {d.file, 0, 0, {}}, {}, {}}; }

// Of planes that a mirror repeats; 0: any.
double stored_range(WebSymmetry s) {
  return s == WebSymmetry::about_0_180 || s == WebSymmetry::about_90_270 ? 180 : s == WebSymmetry::quadrant ? 90 : 0;
}

bool of_type_c(WebSymmetry s) { return s <= WebSymmetry::rotational; }

}  // namespace

Status check(const IntensityDistribution& d) {
  const IntensityGrid& grid = d.grid;
  if (!increasing_within(grid.vertical_deg, vertical_range(grid.type)))
    return invalid(d, "expected vertical angles that increase within the range of the web's type");
  if (!increasing_within(grid.horizontal_deg, horizontal_range(grid.type)))
    return invalid(d, "expected horizontal angles that increase within the range of the web's type");
  if (grid.vertical_deg.size() < 2) return invalid(d, "expected at least two vertical angles, found one");
  if (grid.horizontal_deg.back() - grid.horizontal_deg.front() > 360) return invalid(d, "expected horizontal angles within one turn");
  if (grid.type != WebType::c && (grid.horizontal_deg.size() < 2 || (grid.symmetry != WebSymmetry::none && of_type_c(grid.symmetry))))
    return invalid(d, "expected at least two horizontal angles and a symmetry of type A or B");
  if (grid.type == WebType::c && !of_type_c(grid.symmetry)) return invalid(d, "expected a symmetry of type C");
  if (grid.type == WebType::c && (grid.symmetry == WebSymmetry::rotational) != (grid.horizontal_deg.size() == 1))
    return invalid(d, "expected one plane if the web is rotational, else several");
  const double range = stored_range(grid.symmetry);
  if (range > 0 && grid.horizontal_deg.back() - grid.horizontal_deg.front() != range)
    return invalid(d, fmt::format("expected planes over {} degrees for this symmetry", range));
  if (grid.values.size() != grid.vertical_deg.size() * grid.horizontal_deg.size())
    return invalid(
        d, fmt::format("expected {} x {} values, found {}", grid.horizontal_deg.size(), grid.vertical_deg.size(), grid.values.size()));
  const double factor = candelas_per_value(d);
  if (!std::isfinite(factor) || factor < 0)
    return invalid(d, fmt::format("expected factors that are finite and not negative, found {}", factor));
  for (const double value : grid.values) {
    if (!(value >= 0) || !(value * std::max(1.0, factor) <= largest_candelas))
      return invalid(d, fmt::format("expected candelas from 0 to {:g}, found {} x {}", largest_candelas, value, factor));
  }
  return Done{};
}

}  // namespace etendue
