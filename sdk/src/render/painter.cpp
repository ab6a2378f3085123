#include "painter.h"
#include "hashing.h"

#include <algorithm>
#include <cmath>

namespace etendue::rendering {
namespace {

constexpr Effort pilot{8, 1};
constexpr std::uint32_t reach = 2;                   // pixels to each side whose pilots say what is shadowed: 192 samples
constexpr int fewest_points = 4, most_points = 128;  // of each eighth, where shadows are mixed
constexpr double shadow_share = 0.2;                 // of the expected noise
constexpr double shading_share = 0.02;               // of the expected noise: errors of shading are alike in neighbours
constexpr double dark_share = 0.05;                  // of the typical luminance: what is darker is not judged

constexpr std::uint64_t pilot_purpose = 0, shadow_purpose = 1, typical_purpose = 3;  // 2: places.cpp

// Effort so that a half-shadowed pixel, standard deviation .5, comes to `goal` of its light. A sequence of n points in the dimensions of a
// shadow converges about as n^-3/4; a light that is only sampled has a standard deviation near 1. What its samples leave may be most of the
// variance that differences are divided by, and 1 / variance has the mean nu / (nu - 2) of what it should be if nu + 1 replicates measured
// it: 7 / 5 for 8 of them, 31 / 29 for 32.
Effort effort_for(double goal, bool only_sampled) {
  const double n = std::pow((only_sampled ? 1.0 : 0.5) / std::max(goal, 1e-6), 4.0 / 3) / pilot.replicates;
  const auto points = static_cast<int>(std::clamp(n, static_cast<double>(fewest_points), static_cast<double>(most_points)));
  if (!only_sampled) return {pilot.replicates, points};
  constexpr int parts = 4;
  return {parts * pilot.replicates, points / parts};
}

Effort effort_of(std::uint32_t samples) {
  const int replicates = std::min(pilot.replicates, static_cast<int>(samples));
  return {replicates, static_cast<int>(samples) / replicates};
}

double sum(const Rgb& c) { return c.x + c.y + c.z; }

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
      variance_(value_.size()),
      bound_(value_.size()) {
  tolerance_.relative = std::clamp(shading_share * options.expected_noise, 1e-7, 1e-3);
  tolerance_.absolute = tolerance_.relative * dark_share * typical_luminance();
  if (options.shading_tolerance > 0) tolerance_ = {options.shading_tolerance, 0};
  plan_.emplace(light.emitter, tolerance_, light.picture);
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
      total += sum(lighting_.sample(light_, {x, y, nullptr}, pilot, seed(index(x, y), typical_purpose), counts).total().all) /
               (3.0 * pilot.replicates);
    }
  }
  return total / (cells * cells);
}

bool LightPainter::run(RowRunner& rows) {
  const std::size_t pixels = value_.size();
  if (shadows_) visible_.assign(pixels, 0), all_.assign(pixels, 0);
  if (light_.analytic) black_.assign(pixels, {}), slope_.assign(pixels, {}), centre_bound_.assign(pixels, 0), known_.assign(pixels, 0);
  if (light_.picture != nullptr) pictured_.assign(pixels, 0);
  if (shadows_) mixed_variance_.assign(pixels, {}), is_mixed_.assign(pixels, 0);
  return rows.run([this](std::uint32_t row, RayCounts& counts) {
    if (light_.picture != nullptr) picture_row(row);
    if (shadows_) pilot_row(row, counts);
  }) && find_centres(rows) &&
         rows.run([this](std::uint32_t row, RayCounts& counts) { paint_row(row, counts); }) &&
         rows.run([this](std::uint32_t row, RayCounts&) {
           if (shadows_) pool_row(row);
         });
}

bool LightPainter::is_uneven(std::size_t pixel) const {
  constexpr double most = 0.15;
  return survey_.unevenness(pixel) > most;
}

bool LightPainter::has_plan(std::size_t pixel) const { return light_.analytic && (light_.picture == nullptr || pictured_[pixel] != 0); }

bool LightPainter::is_plain(const std::optional<SurfacePoint>& point) const {
  const Paint* paint = point ? stage_.thing(point->thing).paint : nullptr;
  return paint != nullptr && !paint->textured();
}

// Light of extended lights on it is smooth but for a texture's colour.
bool LightPainter::is_coloured(const std::optional<SurfacePoint>& point) const {
  const Paint* paint = point && !light_.delta ? stage_.thing(point->thing).paint : nullptr;
  return paint != nullptr && paint->coloured();
}

bool LightPainter::is_matt(const SurfacePoint& point) const {
  return std::holds_alternative<Lambert>(stage_.thing(point.thing).paint->material.model);
}

PixelTarget LightPainter::target(std::uint32_t x, std::uint32_t y, const SurfacePoint* centre) const {
  const bool plane = centre != nullptr && centre->flat && survey_.regions(index(x, y)) == nullptr && is_plain(*centre);
  return {x, y, plane ? centre : nullptr};
}

// A narrow lobe shows a picture as sharp as it is: many of its cells for each place, and many places for each pixel. Samples do that at
// less.
void LightPainter::picture_row(std::uint32_t row) {
  constexpr double narrowest = 0.1;
  for (std::uint32_t x = 0; x < options_.width; ++x) {
    const std::size_t pixel = index(x, row);
    if (const Regions* regions = survey_.regions(pixel)) {
      pictured_[pixel] = regions->only_lambert ? 1 : 0;
      continue;
    }
    const auto centre = stage_.first(camera_.through(x + 0.5, row + 0.5));
    const Paint* const paint = centre ? stage_.thing(centre->thing).paint : nullptr;
    pictured_[pixel] = paint == nullptr || lobe_width(paint->material.model) >= narrowest ? 1 : 0;
  }
}

void LightPainter::pilot_row(std::uint32_t row, RayCounts& counts) {
  for (std::uint32_t x = 0; x < options_.width; ++x) {
    const auto centre = stage_.first(camera_.through(x + 0.5, row + 0.5));
    if (!centre && survey_.regions(index(x, row)) == nullptr) continue;
    const PixelTarget where = target(x, row, centre ? &*centre : nullptr);
    const Sampled::Sums sums = lighting_.sample(light_, where, pilot, seed(index(x, row), pilot_purpose), counts).total();
    visible_[index(x, row)] = static_cast<float>(sum(sums.visible));
    all_[index(x, row)] = static_cast<float>(sum(sums.all));
  }
}

LightPainter::Surroundings LightPainter::surroundings(std::uint32_t x, std::uint32_t y) const {
  if (light_.delta) return {1, false};
  // Where the surface is uneven no few places stand for the pixel: all light is sampled, as where it has no closed form.
  if (!has_plan(index(x, y)) || is_uneven(index(x, y))) return {0, true};
  if (!shadows_) return {1, false};
  double visible = 0, all = 0;
  for (std::uint32_t j = y > reach ? y - reach : 0; j <= std::min(y + reach, options_.height - 1); ++j) {
    for (std::uint32_t i = x > reach ? x - reach : 0; i <= std::min(x + reach, options_.width - 1); ++i) {
      if (i == x && j == y) continue;
      visible += static_cast<double>(visible_[index(i, j)]);
      all += static_cast<double>(all_[index(i, j)]);
    }
  }
  // Both sums are of the same terms in the same order, so equality is exact where nothing was blocked.
  if (all <= 0 || visible == all) return {1, false};
  return {visible / all, visible > 0};
}

LightPainter::Measured LightPainter::exact(std::uint32_t x, std::uint32_t y, double beta, const std::optional<SurfacePoint>& centre,
                                           RayCounts& counts) const {
  const Regions* regions = survey_.regions(index(x, y));
  return regions != nullptr ? split(x, y, *regions, beta, counts) : smooth(x, y, beta, centre, counts);
}

Sampled LightPainter::sampled(std::uint32_t x, std::uint32_t y, const Surroundings& around, const std::optional<SurfacePoint>& centre,
                              RayCounts& counts) const {
  const std::size_t pixel = index(x, y);
  if (light_.delta || (survey_.regions(pixel) == nullptr && (!centre || stage_.thing(centre->thing).paint == nullptr))) return {};
  if (has_plan(pixel) && !shadows_ && !around.mixed) return {};
  Effort effort = pilot;
  std::uint64_t purpose = pilot_purpose;
  if (around.mixed) {
    effort = options_.shadow_samples > 0 && !around.only_sampled()
                 ? effort_of(options_.shadow_samples)
                 : effort_for(shadow_share * options_.expected_noise, around.only_sampled());
    purpose = shadow_purpose;
  } else {
    // The pilot's own samples are repeated, unless they are known to add nothing.
    const bool all_seen = visible_[pixel] == all_[pixel], none_seen = visible_[pixel] == 0;
    if ((around.beta == 1 && all_seen) || (around.beta == 0 && none_seen)) return {};
  }
  const PixelTarget where = target(x, y, centre ? &*centre : nullptr);
  return lighting_.sample(light_, where, effort, seed(pixel, purpose), counts);
}

LightPainter::Shadowed LightPainter::by_difference(std::uint32_t x, std::uint32_t y, const Surroundings& around,
                                                   const std::optional<SurfacePoint>& centre, RayCounts& counts) const {
  Measured all = exact(x, y, around.beta, centre, counts);
  const Deviating difference = sampled(x, y, around, centre, counts).difference(around.beta);
  all.value += difference.mean;
  return {all, difference.variance};
}

LightPainter::Shadowed LightPainter::by_ratio(std::uint32_t x, std::uint32_t y, const Surroundings& around,
                                              const std::optional<SurfacePoint>& centre, RayCounts& counts) const {
  const Deviating ratio = sampled(x, y, around, centre, counts).ratio(around.beta);
  const Measured seen = exact(x, y, 0, centre, counts), lit = exact(x, y, 1, centre, counts);
  const Rgb light = lit.value - seen.value;
  return {{seen.value + light * ratio.mean, lit.variance, lit.bound, lit.supposed}, squared(light) * ratio.variance};
}

void LightPainter::paint_row(std::uint32_t row, RayCounts& counts) {
  for (std::uint32_t x = 0; x < options_.width; ++x) {
    const std::size_t pixel = index(x, row);
    const auto centre = stage_.first(camera_.through(x + 0.5, row + 0.5));
    const Regions* regions = survey_.regions(pixel);
    Surroundings around = surroundings(x, row);
    if (around.beta > 0 && regions == nullptr && is_coloured(centre) && !is_matt(*centre) && !is_gentle(x, row, *centre))
      around = {0, true};
    const bool ratio = shadows_ && options_.shadows == Shadows::ratio && !around.only_sampled();
    const Shadowed shadowed = ratio ? by_ratio(x, row, around, centre, counts) : by_difference(x, row, around, centre, counts);
    value_[pixel] = shadowed.all.value;
    variance_[pixel] = shadowed.all.variance;
    // What shading may be off by is a bound, not a deviation: a tenth of it is a choice (sdk/docs/rendering.md), not a measurement.
    const Rgb shading = Rgb{1, 1, 1} * std::pow(0.1 * shadowed.all.bound, 2);
    variance_[pixel] += shading;
    bound_[pixel] = shadowed.all.supposed + shading;
    if (shadows_ && around.mixed && around.beta > 0 && regions == nullptr) {
      mixed_variance_[pixel] = shadowed.shadow_variance;
      is_mixed_[pixel] = 1;
    } else {
      variance_[pixel] += shadowed.shadow_variance;
    }
  }
}

// Where little is blocked most pixels happen to sample none of it, and would state a variance of 0: what neighbours on the same surface
// measured is as good for a pixel as its own.
void LightPainter::pool_row(std::uint32_t row) {
  for (std::uint32_t x = 0; x < options_.width; ++x) {
    const std::size_t pixel = index(x, row);
    if (is_mixed_[pixel] == 0) continue;
    Rgb sum;
    int count = 0;
    for (std::uint32_t j = row > reach ? row - reach : 0; j <= std::min(row + reach, options_.height - 1); ++j) {
      for (std::uint32_t i = x > reach ? x - reach : 0; i <= std::min(x + reach, options_.width - 1); ++i) {
        const std::size_t other = index(i, j);
        if (is_mixed_[other] == 0 || survey_.key(other) != survey_.key(pixel)) continue;
        sum += mixed_variance_[other];
        ++count;
      }
    }
    variance_[pixel] += sum / count;
  }
}

}  // namespace etendue::rendering
