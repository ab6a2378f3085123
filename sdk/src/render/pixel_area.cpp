// The mean over a pixel's area of light that has a closed form or comes from a point: quadrature where it is smooth, regions where edges
// cut the pixel, random places where nothing is smooth.
#include "hashing.h"
#include "painter.h"

#include <array>
#include <cmath>
#include <map>
#include <span>
#include <vector>

namespace etendue::rendering {
namespace {

constexpr std::uint64_t place_purpose = 2, spread_purpose = 4;  // of random numbers
constexpr double place_share = 0.2;                             // of the expected noise
constexpr int fewest_cells = 3, most_cells = 12;                // along a pixel's side, two places in each
constexpr int halvings_for_points = 4, halvings_for_areas = 2;

// Independent places with the relative standard deviation `spread` come to `goal` at (spread / goal)^2 of them.
int cells_for(double spread, double goal) {
  const double side = std::ceil(spread / std::max(goal, 1e-6) / std::sqrt(2.0));
  return static_cast<int>(std::clamp(side, static_cast<double>(fewest_cells), static_cast<double>(most_cells)));
}

bool has_profile(const StageLight& light) {
  const auto* punctual = std::get_if<eval::PunctualEmitter>(&light.emitter.shape);
  return punctual != nullptr && std::holds_alternative<eval::ProfileShape>(punctual->shape);
}

}  // namespace

Reflected LightPainter::at(double x, double y, double beta, RayCounts& counts) const {
  const Vec2d place{x, y};
  return at(std::span(&place, 1), beta, counts).front();
}

std::vector<Reflected> LightPainter::at(std::span<const Vec2d> places, double beta, RayCounts& counts) const {
  std::vector<Reflected> out;
  std::vector<SeenPoint> lit;
  std::vector<std::size_t> index;
  for (const Vec2d& place : places) {
    const Ray ray = camera_.through(place.x, place.y);
    ++counts.primary;
    const auto point = stage_.first(ray);
    out.push_back({lighting_.emitted(light_, point, ray), 0});
    if (!point || beta <= 0 || !(light_.delta || light_.analytic)) continue;
    lit.push_back({*point, -ray.direction}), index.push_back(out.size() - 1);
  }
  const std::vector<Reflected> reflected = lighting_.reflected(light_, lit, *plan_, counts);
  for (std::size_t k = 0; k < reflected.size(); ++k) {
    out[index[k]].value += reflected[k].value * beta;
    out[index[k]].bound = reflected[k].bound * beta;
  }
  return out;
}

// Two places in each of side x side cells: half their squared difference has the mean of the variance inside the cell, so that the pixel's
// variance is known without bias. How many cells is asked of a pilot whose own places are not used.
LightPainter::Measured LightPainter::over_places(std::uint32_t x, std::uint32_t y, const Integrand& light) const {
  constexpr int pilot_places = 8;
  const std::size_t pixel = index(x, y);
  Random pilot(seed(pixel, spread_purpose)), random(seed(pixel, place_purpose));
  Rgb sum, squares;
  for (int i = 0; i < pilot_places; ++i) {
    const int column = i % 4, row = i / 4;
    const double u = (column + pilot.next()) / 4, v = (row + pilot.next()) / 2;
    const Rgb value = light(x + u, y + v).value;
    sum += value;
    squares += squared(value);
  }
  const Rgb spread = (squares - squared(sum) / pilot_places) / (pilot_places - 1);
  const double mean = largest(sum) / pilot_places;
  const int side = cells_for(mean > 0 ? std::sqrt(largest(spread)) / mean : 0, place_share * options_.expected_noise);
  const double cells = static_cast<double>(side) * side;
  Measured out;
  for (int cell = 0; cell < side * side; ++cell) {
    const int column = cell % side, row = cell / side;
    std::array<Rgb, 2> pair;
    for (Rgb& value : pair) {
      const double u = (column + random.next()) / side, v = (row + random.next()) / side;
      const Reflected here = light(x + u, y + v);
      value = here.value;
      out.bound += here.bound / (2 * cells);
    }
    out.value += (pair[0] + pair[1]) / (2 * cells);
    out.variance += squared((pair[0] - pair[1]) / (2 * cells));
  }
  return out;
}

// Over a textured surface the light for each colour is smooth: the texture is looked up at random places, the light comes from the centres.
LightPainter::Measured LightPainter::over_colours(std::uint32_t x, std::uint32_t y, double beta, const SurfacePoint& centre,
                                                  RayCounts& counts) const {
  const Local black = local(black_, x, y), slope = local(slope_, x, y);
  const Paint& paint = *stage_.thing(centre.thing).paint;
  const double bound = static_cast<double>(centre_bound_[index(x, y)]);
  return over_places(x, y, [&](double at_x, double at_y) {
    ++counts.primary;
    const auto point = stage_.first(camera_.through(at_x, at_y));
    const Rgb colour = base_colour_at(paint, point && point->thing == centre.thing ? point->uv : centre.uv);
    const double dx = at_x - (x + 0.5), dy = at_y - (y + 0.5);
    return Reflected{(black.at(dx, dy) + slope.at(dx, dy) * colour) * beta, bound * beta};
  });
}

// `side` is 2 or 3 places along each side: exact up to third or fifth degree.
Reflected LightPainter::gauss_legendre(const Cell& cell, double beta, int side, RayCounts& counts) const {
  static const double two = std::sqrt(1.0 / 12), three = std::sqrt(0.15);
  const std::array<double, 3> place = side == 2 ? std::array{-two, two, 0.0} : std::array{-three, three, 0.0};
  const std::array<double, 3> weight = side == 2 ? std::array{0.5, 0.5, 0.0} : std::array{5 / 18.0, 5 / 18.0, 8 / 18.0};
  const auto count = static_cast<std::size_t>(side);
  std::vector<Vec2d> places;
  for (std::size_t j = 0; j < count; ++j)
    for (std::size_t i = 0; i < count; ++i)
      places.push_back({cell.x + cell.side * (0.5 + place[i]), cell.y + cell.side * (0.5 + place[j])});
  const std::vector<Reflected> light = at(places, beta, counts);
  Reflected sum;
  for (std::size_t k = 0; k < light.size(); ++k) {
    sum.value += light[k].value * (weight[k % count] * weight[k / count]);
    sum.bound += light[k].bound * (weight[k % count] * weight[k / count]);
  }
  return sum;
}

// Two rules; where they differ by more than the tolerance, the cell's quarters instead. Where the light is smooth the finer rule's error is
// under a tenth of the difference, at a kink up to a third of it: a quarter stands for it.
LightPainter::Measured LightPainter::cubature(const Cell& cell, double beta, const Halvings& halvings, RayCounts& counts) const {
  const Reflected coarse = gauss_legendre(cell, beta, 2, counts), fine = gauss_legendre(cell, beta, 3, counts);
  const Rgb error = (fine.value - coarse.value) / 4.0;
  const double allowed = std::max(tolerance_.relative * largest(fine.value), tolerance_.absolute) * halvings.share;
  if (halvings.most == 0 || (halvings.least == 0 && largest(error) <= allowed))
    return {fine.value, squared(error), fine.bound, squared(error)};
  Measured out;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const double half = cell.side / 2;
    const int column = quarter % 2, row = quarter / 2;
    const Measured part = cubature({cell.x + column * half, cell.y + row * half, half}, beta, halvings.within(), counts);
    out.value += part.value / 4.0;
    out.variance += part.variance / 16.0;
    out.supposed += part.supposed / 16.0;
    out.bound += part.bound / 4;
  }
  return out;
}

LightPainter::Measured LightPainter::smooth(std::uint32_t x, std::uint32_t y, double beta, const std::optional<SurfacePoint>& centre,
                                            RayCounts& counts) const {
  const std::size_t pixel = index(x, y);
  const Thing* thing = centre ? &stage_.thing(centre->thing) : nullptr;
  const bool own_light = thing != nullptr && centre->thing == light_.thing;
  const bool patterned = own_light && static_cast<bool>(light_.emitter.pattern);
  const bool textured = thing != nullptr && thing->paint != nullptr && thing->paint->textured();
  if (beta > 0 && light_.analytic && !own_light && is_coloured(centre) && is_gentle(x, y, *centre)) {
    return over_colours(x, y, beta, *centre, counts);
  }
  if ((!centre && light_.background) || patterned || (textured && (beta > 0 || own_light)) || (light_.delta && is_uneven(pixel))) {
    return over_places(x, y, [&](double at_x, double at_y) { return at(at_x, at_y, beta, counts); });
  }
  const Ray ray = camera_.through(x + 0.5, y + 0.5);
  Measured out{lighting_.emitted(light_, centre, ray), {}, 0, {}};
  if (beta <= 0 || thing == nullptr || thing->paint == nullptr || !light_.analytic) return out;
  const bool cheap = light_.delta || (light_.picture == nullptr && std::holds_alternative<Lambert>(thing->paint->material.model));
  // With g = |f_xx / f| the next terms are of the order g^2: g^2 / 340 here, g^2 / 4320 for the rule of 2 x 2.
  constexpr double steep = 0.1;
  const Rgb any_colour;
  const std::optional<Curvature> bend = curvature(x, y, any_colour);
  const Cell whole{static_cast<double>(x), static_cast<double>(y), 1};
  // A profile is linear between its directions. Of a slope that changes by J within the pixel the second differences, which take it for a
  // bend, miss up to J / 12; quarters find it.
  constexpr double kinked = 1e-3;
  constexpr Halvings kinks{halvings_for_points, 1, 0.1};
  if (has_profile(light_) && !(bend && bend->relative < kinked)) return cubature(whole, beta, kinks, counts);
  // Beside an edge the second differences are missing. A costly light that hardly changes from pixel to pixel needs none.
  if ((bend && bend->relative < gentle_bend) || (!bend && known_[pixel] != 0 && !cheap && is_level(x, y, any_colour))) {
    out.value += (black_[pixel] + (bend ? bend->correction : Rgb{})) * beta;
    out.bound = static_cast<double>(centre_bound_[pixel]) * beta;
    return out;
  }
  if (bend && bend->relative > steep) return cubature(whole, beta, {cheap ? halvings_for_points : halvings_for_areas}, counts);
  const Reflected mean = gauss_legendre(whole, beta, 2, counts);
  return {mean.value, {}, mean.bound, {}};
}

LightPainter::Measured LightPainter::split(std::uint32_t x, std::uint32_t y, const Regions& regions, double beta, RayCounts& counts) const {
  struct Region {
    Rgb sum, squares;
    double weight = 0;
    int nodes = 0;
  };
  std::map<std::uint32_t, Region> all;
  const bool cheap = light_.delta || (light_.picture == nullptr && regions.only_lambert);
  Measured out;
  const bool kinked = !regions.kinked.empty() && std::count(regions.kinks.begin(), regions.kinks.end(), light_.index) > 0;
  const auto& nodes = kinked ? regions.kinked : cheap ? regions.nodes : regions.coarse;
  std::vector<Vec2d> places;
  places.reserve(nodes.size());
  for (const Node& node : nodes) places.push_back({x + static_cast<double>(node.x), y + static_cast<double>(node.y)});
  const std::vector<Reflected> light = at(places, beta, counts);
  for (std::size_t k = 0; k < light.size(); ++k) {
    const Node& node = nodes[k];
    const Reflected& here = light[k];
    const auto weight = static_cast<double>(node.weight);
    Region& region = all[node.region];
    region.sum += here.value * weight;
    region.squares += squared(here.value) * weight;
    region.weight += weight;
    ++region.nodes;
    out.bound += here.bound * weight;
  }
  Rgb low{infinite, infinite, infinite}, high{};
  for (const auto& [number, region] : all) {
    const Rgb mean = region.weight > 0 ? region.sum / region.weight : Rgb{};
    const SurfaceKind kind = regions.kinds[number];
    out.value += region.sum;
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], mean[c]);
      high[c] = std::max(high[c], mean[c]);
      // Places chosen at random; the others are a quadrature, whose error is far below the areas'.
      if (region.nodes < 2 || !(cheap || kinked ? kind.textured : kind.varies)) continue;
      const double spread = std::max(0.0, region.squares[c] / region.weight - mean[c] * mean[c]) / (region.nodes - 1);
      out.variance[c] += region.weight * region.weight * spread;
    }
  }
  out.supposed = squared((high - low) * regions.area_error);
  out.variance += out.supposed;
  return out;
}

}  // namespace etendue::rendering
