#include "painter.h"
#include "hashing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace etendue::rendering {
namespace {

constexpr int pilot_points = 2;                      // a replicate: 16 samples in all
constexpr int fewest_points = 4, most_points = 128;  // a replicate, where shadows are mixed
constexpr double shadow_share = 0.2;                 // of the expected noise
constexpr double shading_share = 0.02;               // of the expected noise: errors of shading are alike in neighbours
constexpr int most_cells = 8;                        // along a pixel's side
constexpr double dark_share = 0.05;                  // of the typical luminance: what is darker is not judged

constexpr std::uint64_t pilot_purpose = 0, shadow_purpose = 1, place_purpose = 2, typical_purpose = 3;

Rgb squared(const Rgb& c) { return c * c; }

// Points a replicate so that a half-shadowed pixel, standard deviation .5, comes to `goal` of its light. A sequence of n points in the
// dimensions of a shadow converges about as n^-3/4; a light that is only sampled has a standard deviation near 1.
int points_for(double goal, double deviation) {
  const double n = std::pow(deviation / std::max(goal, 1e-6), 4.0 / 3) / replicates;
  return static_cast<int>(std::clamp(n, static_cast<double>(fewest_points), static_cast<double>(most_points)));
}

}  // namespace

LightPainter::LightPainter(const Stage& stage, const PinholeCamera& camera, const Survey& survey, const StageLight& light,
                           const PainterOptions& options)
    : stage_(stage),
      camera_(camera),
      survey_(survey),
      light_(light),
      options_(options),
      lighting_(stage, camera),
      shadows_(!light.delta && light.analytic && stage.can_be_blocked(light)),
      value_(std::size_t{options.width} * options.height),
      variance_(value_.size()) {
  tolerance_.relative = std::clamp(shading_share * options.expected_noise, 1e-7, 1e-3);
  tolerance_.absolute = tolerance_.relative * dark_share * typical_luminance();
}

std::uint64_t LightPainter::seed(std::size_t pixel, std::uint64_t purpose) const {
  return mixed(mixed(options_.seed * 8 + purpose) ^ mixed(light_.index + (std::uint64_t{pixel} << 24)));
}

// Mean reflected luminance over a coarse grid of pixels, without shadows: the measure of what is dark.
double LightPainter::typical_luminance() const {
  constexpr std::uint32_t cells = 12;
  RayCounts counts;
  double total = 0;
  for (std::uint32_t j = 0; j < cells; ++j) {
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t x = (2 * i + 1) * options_.width / (2 * cells), y = (2 * j + 1) * options_.height / (2 * cells);
      total += lighting_.sample(light_, {x, y, nullptr}, 0, 1, seed(index(x, y), typical_purpose), counts).all_sum / (3.0 * replicates);
    }
  }
  return total / (cells * cells);
}

bool LightPainter::run(RowRunner& rows) {
  const std::size_t pixels = value_.size();
  if (shadows_) visible_.assign(pixels, 0), all_.assign(pixels, 0);
  if (light_.analytic) centre_.assign(pixels, {}), known_.assign(pixels, 0);
  const bool done = rows.run([this](std::uint32_t row, RayCounts& counts) {
    if (shadows_) pilot_row(row, counts);
  }) && find_centres(rows) &&
                    rows.run([this](std::uint32_t row, RayCounts& counts) { paint_row(row, counts); });
  return done;
}

bool LightPainter::turns(std::size_t pixel) const {
  constexpr double most = 0.15;
  return survey_.turn(pixel) > most;
}

bool LightPainter::is_plain(const std::optional<SurfacePoint>& point) const {
  const Paint* paint = point ? stage_.thing(point->thing).paint : nullptr;
  return paint != nullptr && !paint->textured();
}

PixelTarget LightPainter::target(std::uint32_t x, std::uint32_t y, const SurfacePoint* centre) const {
  const bool plane = centre != nullptr && centre->flat && survey_.regions(index(x, y)) == nullptr && is_plain(*centre);
  return {x, y, plane ? centre : nullptr};
}

void LightPainter::pilot_row(std::uint32_t row, RayCounts& counts) {
  for (std::uint32_t x = 0; x < options_.width; ++x) {
    const auto centre = stage_.first(camera_.through(x + 0.5, row + 0.5));
    if (!centre && survey_.regions(index(x, row)) == nullptr) continue;
    const PixelTarget where = target(x, row, centre ? &*centre : nullptr);
    const Sampled s = lighting_.sample(light_, where, 1, pilot_points, seed(index(x, row), pilot_purpose), counts);
    visible_[index(x, row)] = static_cast<float>(s.visible_sum);
    all_[index(x, row)] = static_cast<float>(s.all_sum);
  }
}

LightPainter::Surroundings LightPainter::surroundings(std::uint32_t x, std::uint32_t y) const {
  if (light_.delta) return {1, false};
  // On a surface that turns too fast no few places stand for the pixel: all light is sampled, as where it has no closed form.
  if (!light_.analytic || turns(index(x, y))) return {0, true};
  if (!shadows_) return {1, false};
  double visible = 0, all = 0;
  for (std::uint32_t j = y > 0 ? y - 1 : 0; j <= std::min(y + 1, options_.height - 1); ++j) {
    for (std::uint32_t i = x > 0 ? x - 1 : 0; i <= std::min(x + 1, options_.width - 1); ++i) {
      if (i == x && j == y) continue;
      visible += static_cast<double>(visible_[index(i, j)]);
      all += static_cast<double>(all_[index(i, j)]);
    }
  }
  // Both sums are of the same terms in the same order, so equality is exact where nothing was blocked.
  if (all <= 0 || visible == all) return {1, false};
  return {visible / all, visible > 0};
}

Rgb LightPainter::at(double x, double y, double beta, RayCounts& counts) const {
  const Ray ray = camera_.through(x, y);
  ++counts.primary;
  const auto point = stage_.first(ray);
  Rgb value = lighting_.emitted(light_, point, ray);
  if (point && beta > 0 && (light_.delta || light_.analytic)) {
    value += lighting_.reflected(light_, *point, -ray.direction, tolerance_, counts) * beta;
  }
  return value;
}

// One place in each of side x side cells. Neighbouring cells in pairs: half their squared difference estimates (from above, since it holds
// the difference of their means too) the variance inside a cell.
LightPainter::Measured LightPainter::stratified(std::uint32_t x, std::uint32_t y, double beta, int side, RayCounts& counts) const {
  Random random(seed(index(x, y), place_purpose));
  const double cells = static_cast<double>(side) * side;
  Measured out;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; i += 2) {
      std::array<Rgb, 2> pair;
      for (int k = 0; k < 2; ++k) {
        const double u = (i + k + random.next()) / side, v = (j + random.next()) / side;
        pair[static_cast<std::size_t>(k)] = at(x + u, y + v, beta, counts);
      }
      out.value += (pair[0] + pair[1]) / cells;
      out.variance += squared(pair[0] - pair[1]) / (cells * cells);
    }
  }
  return out;
}

// `side` is 2 or 3 places along each side of the pixel: exact up to third or fifth degree.
Rgb LightPainter::gauss_legendre(std::uint32_t x, std::uint32_t y, double beta, int side, RayCounts& counts) const {
  static const double two = std::sqrt(1.0 / 12), three = std::sqrt(0.15);
  const std::array<double, 3> place = side == 2 ? std::array{-two, two, 0.0} : std::array{-three, three, 0.0};
  const std::array<double, 3> weight = side == 2 ? std::array{0.5, 0.5, 0.0} : std::array{5 / 18.0, 5 / 18.0, 8 / 18.0};
  Rgb sum;
  for (std::size_t j = 0; j < static_cast<std::size_t>(side); ++j) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(side); ++i) {
      sum += at(x + 0.5 + place[i], y + 0.5 + place[j], beta, counts) * (weight[i] * weight[j]);
    }
  }
  return sum;
}

LightPainter::Measured LightPainter::smooth(std::uint32_t x, std::uint32_t y, double beta, const std::optional<SurfacePoint>& centre,
                                            RayCounts& counts) const {
  const std::size_t pixel = index(x, y);
  const Thing* thing = centre ? &stage_.thing(centre->thing) : nullptr;
  const bool own_light = thing != nullptr && centre->thing == light_.thing;
  const bool patterned = own_light && static_cast<bool>(light_.emitter.pattern);
  const bool textured = thing != nullptr && thing->paint != nullptr && thing->paint->textured();
  if ((!centre && light_.background) || patterned || (textured && (beta > 0 || own_light))) {
    const bool costly = !light_.delta && textured && !std::holds_alternative<Lambert>(thing->paint->material.model);
    return stratified(x, y, beta, costly ? 2 : 4, counts);
  }
  const Ray ray = camera_.through(x + 0.5, y + 0.5);
  Measured out{lighting_.emitted(light_, centre, ray), {}};
  if (beta <= 0 || thing == nullptr || thing->paint == nullptr || !light_.analytic) return out;
  // With g = |f_xx / f| the next terms are of the order g^2: g^2 / 340 here, g^2 / 4320 and g^3 / 2e6 for the two quadratures below.
  constexpr double gentle = 0.01, steep = 0.1;
  const std::optional<Curvature> bend = curvature(x, y);
  if (light_.delta && turns(pixel)) return stratified(x, y, beta, most_cells, counts);
  if (bend && bend->relative < gentle) {
    out.value += (centre_[pixel] + bend->correction) * beta;
    return out;
  }
  // Beside an edge the second differences are missing. A costly light has noise enough in the reference to hide g / 24.
  if (!bend && known_[pixel] != 0 && !light_.delta && !std::holds_alternative<Lambert>(thing->paint->material.model)) {
    out.value += centre_[pixel] * beta;
    return out;
  }
  const Rgb finer = gauss_legendre(x, y, beta, bend && bend->relative > steep ? 3 : 2, counts);
  // Where the light is smooth, the finer rule's error is under a tenth of the difference; at a kink it is up to a third.
  if (bend) out.variance = squared((out.value + (centre_[pixel] + bend->correction) * beta - finer) / 4.0);
  out.value = finer;
  return out;
}

LightPainter::Measured LightPainter::split(std::uint32_t x, std::uint32_t y, const Regions& regions, double beta, RayCounts& counts) const {
  struct Region {
    Rgb sum, squares;
    double weight = 0;
    int nodes = 0;
  };
  std::map<std::uint32_t, Region> all;
  const bool cheap = light_.delta || regions.only_lambert;
  Rgb between_pairs, previous;
  bool second = false;
  for (const Node& node : cheap ? regions.nodes : regions.coarse) {
    const Rgb value = at(x + static_cast<double>(node.x), y + static_cast<double>(node.y), beta, counts);
    const auto weight = static_cast<double>(node.weight);
    Region& region = all[node.region];
    region.sum += value * weight;
    region.squares += squared(value) * weight;
    region.weight += weight;
    ++region.nodes;
    // Nodes along scanlines come in pairs, one pair a piece: on a texture their difference is the error's measure, as in stratified().
    if (second) between_pairs += squared((value - previous) * weight);
    previous = value;
    second = !second;
  }
  Measured out;
  Rgb low{infinite, infinite, infinite}, high{};
  for (const auto& [number, region] : all) {
    const Rgb mean = region.weight > 0 ? region.sum / region.weight : Rgb{};
    out.value += region.sum;
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], mean[c]);
      high[c] = std::max(high[c], mean[c]);
      // Places chosen at random where the surface varies; the others are a quadrature, whose error is far below the areas'.
      if (cheap || region.nodes < 2) continue;
      const double spread = std::max(0.0, region.squares[c] / region.weight - mean[c] * mean[c]) / (region.nodes - 1);
      out.variance[c] += region.weight * region.weight * spread;
    }
  }
  if (cheap && regions.textured) out.variance += between_pairs;
  out.variance += squared((high - low) * regions.area_error);
  return out;
}

LightPainter::Measured LightPainter::sampled(std::uint32_t x, std::uint32_t y, const Surroundings& around,
                                             const std::optional<SurfacePoint>& centre, RayCounts& counts) const {
  const std::size_t pixel = index(x, y);
  if (light_.analytic && !shadows_ && !around.mixed) return {};
  int points = pilot_points;
  std::uint64_t purpose = pilot_purpose;
  if (around.mixed) {
    points = points_for(shadow_share * options_.expected_noise, around.beta > 0 ? 0.5 : 1.0);
    purpose = shadow_purpose;
  } else {
    // The pilot's own samples are repeated, unless they are known to add nothing.
    const bool all_seen = visible_[pixel] == all_[pixel], none_seen = visible_[pixel] == 0;
    if ((around.beta == 1 && all_seen) || (around.beta == 0 && none_seen)) return {};
  }
  const PixelTarget where = target(x, y, centre ? &*centre : nullptr);
  const Sampled s = lighting_.sample(light_, where, around.beta, points, seed(pixel, purpose), counts);
  return {s.mean, s.variance};
}

void LightPainter::paint_row(std::uint32_t row, RayCounts& counts) {
  for (std::uint32_t x = 0; x < options_.width; ++x) {
    const std::size_t pixel = index(x, row);
    const auto centre = stage_.first(camera_.through(x + 0.5, row + 0.5));
    const Regions* regions = survey_.regions(pixel);
    const Surroundings around = surroundings(x, row);
    const Measured direct = regions != nullptr ? split(x, row, *regions, around.beta, counts) : smooth(x, row, around.beta, centre, counts);
    value_[pixel] = direct.value;
    variance_[pixel] = direct.variance;
    // What shading may be off by is a bound, not a deviation: a tenth of it is a choice (sdk/docs/rendering.md), not a measurement.
    if (!light_.delta) variance_[pixel] += Rgb{1, 1, 1} * std::pow(0.1 * around.beta * tolerance_.absolute, 2);
    if (light_.delta || (regions == nullptr && (!centre || stage_.thing(centre->thing).paint == nullptr))) continue;
    const Measured shadow = sampled(x, row, around, centre, counts);
    value_[pixel] += shadow.value;
    variance_[pixel] += shadow.variance;
  }
}

}  // namespace etendue::rendering
