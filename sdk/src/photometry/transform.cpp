#include "etendue/photometric_transform.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "etendue/intensity_web.h"

namespace etendue {
namespace {

Error not_type_c() { return {"WEB_INVALID", "expected a web of type C", {}, "resample it first", {}}; }

double wrapped(double c) {
  const double turn = c - 360 * std::floor(c / 360);
  return turn < 360 ? turn : 0;
}

std::span<const double> plane(const IntensityGrid& grid, std::size_t j) {
  return std::span(grid.values).subspan(j * grid.vertical_deg.size(), grid.vertical_deg.size());
}

// A plane of the full circle and the stored one that it repeats.
struct Plane {
  double c_deg;
  std::size_t stored;
};

// All planes in [0, 360), by angle. A stored plane one turn behind the first repeats it and is left out.
std::vector<Plane> planes_of(const IntensityGrid& grid) {
  const std::vector<double>& h = grid.horizontal_deg;
  std::vector<Plane> planes;
  const auto add = [&](double c, std::size_t stored) { planes.push_back({wrapped(c), stored}); };
  for (std::size_t j = 0; j < h.size(); ++j) {
    if (grid.symmetry == WebSymmetry::none && j > 0 && h[j] - h[0] == 360) continue;
    add(h[j], j);
    const bool quadrant = grid.symmetry == WebSymmetry::quadrant;
    if (quadrant || grid.symmetry == WebSymmetry::about_0_180) add(-h[j], j);
    if (quadrant || grid.symmetry == WebSymmetry::about_90_270) add(180 - h[j], j);
    if (quadrant) add(180 + h[j], j);
  }
  std::stable_sort(planes.begin(), planes.end(), [](const Plane& a, const Plane& b) { return a.c_deg < b.c_deg; });
  planes.erase(std::unique(planes.begin(), planes.end(), [](const Plane& a, const Plane& b) { return a.c_deg == b.c_deg; }), planes.end());
  return planes;
}

void append_plane(IntensityGrid& to, double c, std::span<const double> values) {
  to.horizontal_deg.push_back(c);
  to.values.insert(to.values.end(), values.begin(), values.end());
}

// The first plane once more, one turn behind it.
void close_circle(IntensityGrid& grid) {
  const auto first = plane(grid, 0);
  const std::vector<double> copy(first.begin(), first.end());
  append_plane(grid, grid.horizontal_deg.front() + 360, copy);
}

struct Range {
  double first, last;
};
Range stored_range(WebSymmetry symmetry) {
  switch (symmetry) {
    case WebSymmetry::about_90_270:
      return {-90, 90};
    case WebSymmetry::about_0_180:
      return {0, 180};
    case WebSymmetry::quadrant:
      return {0, 90};
    default:
      return {0, 360};
  }
}

// The planes of `from`, turned, that fall into what the symmetry stores.
IntensityGrid collected(const IntensityGrid& from, double turn, WebSymmetry symmetry) {
  IntensityGrid to{from.type, symmetry, from.vertical_deg, {}, {}};
  const Range range = stored_range(symmetry);
  std::vector<Plane> planes = planes_of(from);
  for (Plane& p : planes) {
    p.c_deg = wrapped(p.c_deg + turn);
    if (range.first < 0 && p.c_deg > 180) p.c_deg -= 360;
  }
  std::sort(planes.begin(), planes.end(), [](const Plane& a, const Plane& b) { return a.c_deg < b.c_deg; });
  for (const Plane& p : planes)
    if (p.c_deg >= range.first && p.c_deg <= range.last) append_plane(to, p.c_deg, plane(from, p.stored));
  return to;
}

// Largest difference between planes at C and at reflect(C), without moving a value; infinite where one of them has no partner.
template <class Reflect>
double mirror_error(const IntensityGrid& grid, const std::vector<Plane>& planes, const Reflect& reflect) {
  double worst = 0;
  for (const Plane& p : planes) {
    const double c = wrapped(reflect(p.c_deg));
    const auto partner = std::find_if(planes.begin(), planes.end(), [&](const Plane& q) { return std::abs(q.c_deg - c) < 1e-9; });
    if (partner == planes.end()) return HUGE_VAL;
    const auto a = plane(grid, p.stored), b = plane(grid, partner->stored);
    for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
  }
  return worst;
}

// All planes moved; the one at 0, where the circle is cut, lies between the last and the first.
IntensityGrid turned_between_planes(const IntensityGrid& grid, double turn_deg) {
  IntensityGrid result = collected(grid, turn_deg, WebSymmetry::none);
  if (result.horizontal_deg.front() > 0) {
    const double before = result.horizontal_deg.back() - 360, after = result.horizontal_deg.front(), t = before / (before - after);
    const auto last = plane(result, result.horizontal_deg.size() - 1), first = plane(result, 0);
    std::vector<double> cut;
    for (std::size_t i = 0; i < first.size(); ++i) cut.push_back(last[i] + t * (first[i] - last[i]));
    result.horizontal_deg.insert(result.horizontal_deg.begin(), 0);
    result.values.insert(result.values.begin(), cut.begin(), cut.end());
  }
  close_circle(result);
  return result;
}

}  // namespace

Result<IntensityGrid> turned(const IntensityGrid& grid, double turn_deg) {
  if (grid.type != WebType::c) return not_type_c();
  if (!(std::abs(turn_deg) <= 1e6)) return Error{"WEB_INVALID", "expected a turn of at most 1e6 degrees", {}, {}, {}};
  if (grid.symmetry == WebSymmetry::rotational) return grid;
  if (std::fmod(turn_deg, 90) != 0) return turned_between_planes(grid, turn_deg);
  WebSymmetry symmetry = grid.symmetry;
  const bool quarter = std::fmod(turn_deg, 180) != 0;
  if (quarter && symmetry == WebSymmetry::about_0_180) {
    symmetry = WebSymmetry::about_90_270;
  } else if (quarter && symmetry == WebSymmetry::about_90_270) {
    symmetry = WebSymmetry::about_0_180;
  }
  IntensityGrid result = collected(grid, turn_deg, symmetry);
  if (symmetry == WebSymmetry::none) close_circle(result);
  return result;
}

Result<IntensityGrid> unfolded(const IntensityGrid& grid) {
  if (grid.type != WebType::c) return not_type_c();
  IntensityGrid result = collected(grid, 0, WebSymmetry::none);
  close_circle(result);
  return result;
}

FoldedGrid folded(const IntensityGrid& grid, double tolerance) {
  if (grid.type != WebType::c || grid.symmetry == WebSymmetry::rotational) return {grid, 0};
  const std::vector<Plane> planes = planes_of(grid);
  const double allowed = tolerance * *std::max_element(grid.values.begin(), grid.values.end());
  double rotation = 0;
  for (const Plane& p : planes)
    for (std::size_t i = 0; i < grid.vertical_deg.size(); ++i)
      rotation = std::max(rotation, std::abs(plane(grid, p.stored)[i] - plane(grid, planes[0].stored)[i]));
  if (rotation <= allowed) {
    IntensityGrid one{grid.type, WebSymmetry::rotational, grid.vertical_deg, {}, {}};
    append_plane(one, 0, plane(grid, planes[0].stored));
    return {std::move(one), rotation};
  }
  const double about_0 = mirror_error(grid, planes, [](double c) { return -c; });
  const double about_90 = mirror_error(grid, planes, [](double c) { return 180 - c; });
  const auto holds = [&](double c) { return std::any_of(planes.begin(), planes.end(), [&](const Plane& p) { return p.c_deg == c; }); };
  const bool quadrant = about_0 <= allowed && about_90 <= allowed && holds(0) && holds(90);
  // A value and its image in both mirrors may differ by the sum of the two.
  if (quadrant && about_0 + about_90 <= allowed) return {collected(grid, 0, WebSymmetry::quadrant), about_0 + about_90};
  if (about_0 <= allowed && holds(0) && holds(180)) return {collected(grid, 0, WebSymmetry::about_0_180), about_0};
  if (about_90 <= allowed && holds(90) && holds(270)) return {collected(grid, 0, WebSymmetry::about_90_270), about_90};
  return {grid, 0};
}

Result<IntensityDistribution> scaled_to_flux(IntensityDistribution distribution, double flux_lm) {
  const Result<IntensityWeb> web = IntensityWeb::of(distribution);
  if (!web) return web.error();
  if (!(web->flux_lm() > 0) || !(flux_lm > 0) || !std::isfinite(flux_lm))
    return Error{"WEB_INVALID", "expected a flux above 0 lm, of the luminaire and to scale it to", {distribution.file, 0, 0, {}}, {}, {}};
  const double factor = flux_lm / web->flux_lm();
  if (auto* ies = std::get_if<IesRecord>(&distribution.record)) {
    ies->multiplier *= factor;
    if (ies->lumens_per_lamp > 0) ies->lumens_per_lamp *= factor;
  } else {
    std::get_if<EulumdatRecord>(&distribution.record)->lamp_sets[distribution.lamp_set].flux_lm *= factor;
  }
  return distribution;
}

}  // namespace etendue
