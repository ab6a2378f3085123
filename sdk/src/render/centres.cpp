// Unblocked light at the centres of smooth pixels: evaluated on a coarse lattice first, then on finer ones, and interpolated in between
// where it bends so little that the interpolation's error is below the tolerance.
#include "painter.h"

namespace etendue::rendering {
namespace {

constexpr std::uint32_t coarsest = 4;

// The lattice's step that a place belongs to, and whether it lies between two places of the coarser one along x, along y, or both.
struct Place {
  std::uint32_t step;
  bool between_x, between_y;
  // 0 for the coarsest lattice; then two passes for each finer one: places between two in one direction, then in both.
  int pass() const { return step == coarsest ? 0 : (step == 2 ? 1 : 3) + (between_x && between_y ? 1 : 0); }
};
Place place_of(std::uint32_t x, std::uint32_t y) {
  std::uint32_t step = coarsest;
  while (x % step != 0 || y % step != 0) step /= 2;
  return {step, step < coarsest && (x / step) % 2 == 1, step < coarsest && (y / step) % 2 == 1};
}

}  // namespace

bool LightPainter::find_centres(RowRunner& rows) {
  for (int pass = 0; pass < centre_passes; ++pass) {
    const bool done = rows.run([this, pass](std::uint32_t row, RayCounts& counts) {
      if (light_.analytic) centre_row(row, pass, counts);
    });
    if (!done) return false;
  }
  return true;
}

bool LightPainter::centre_is_needed(std::uint32_t x, std::uint32_t y) const {
  if (surroundings(x, y).beta > 0) return true;
  return (x > 0 && surroundings(x - 1, y).beta > 0) || (y > 0 && surroundings(x, y - 1).beta > 0) ||
         (x + 1 < options_.width && surroundings(x + 1, y).beta > 0) || (y + 1 < options_.height && surroundings(x, y + 1).beta > 0);
}

void LightPainter::centre_row(std::uint32_t row, int pass, RayCounts& counts) {
  for (std::uint32_t x = 0; x < options_.width; ++x) {
    const std::size_t pixel = index(x, row);
    if (place_of(x, row).pass() != pass || survey_.regions(pixel) != nullptr || !centre_is_needed(x, row)) continue;
    const Ray ray = camera_.through(x + 0.5, row + 0.5);
    const auto point = stage_.first(ray);
    if (!is_plain(point)) continue;
    // Lambert's closed forms cost no more than an interpolation.
    const bool matt = std::holds_alternative<Lambert>(stage_.thing(point->thing).paint->material.model);
    const std::optional<Reflected> between = matt ? std::nullopt : interpolated(x, row);
    const Reflected value = between ? *between : lighting_.reflected(light_, *point, -ray.direction, tolerance_, counts);
    centre_[pixel] = value.value;
    centre_bound_[pixel] = static_cast<float>(value.bound);
    known_[pixel] = 1;
  }
}

// The cubic through four places at -3, -1, 1, 3 steps has (9 (f(-1) + f(1)) - f(-3) - f(3)) / 16 in the middle. With h the step, f2 and f4
// the second and fourth derivatives, it differs from the straight line's value by b = h^2 f2 / 2 and errs by .375 h^4 f4; with f4 of the
// order f2^2 / f that is 1.5 b^2 / f.
std::optional<Reflected> LightPainter::interpolated(std::uint32_t x, std::uint32_t y) const {
  const Place place = place_of(x, y);
  if (light_.delta || !(place.between_x || place.between_y)) return std::nullopt;
  const std::size_t stride = place.between_x ? 1 : options_.width;
  const std::uint32_t at = place.between_x ? x : y, end = place.between_x ? options_.width : options_.height;
  const std::size_t pixel = index(x, y), reach = place.step * stride;
  if (at < 3 * place.step || at + 3 * place.step >= end) return std::nullopt;
  for (const std::size_t n : {pixel - 3 * reach, pixel - reach, pixel + reach, pixel + 3 * reach}) {
    if (known_[n] == 0 || survey_.key(n) != survey_.key(pixel)) return std::nullopt;
  }
  const Rgb inner = centre_[pixel - reach] + centre_[pixel + reach], outer = centre_[pixel - 3 * reach] + centre_[pixel + 3 * reach];
  const Rgb value = inner * (9.0 / 16) - outer / 16.0;
  const double bend = largest(inner - outer) / 16;
  const double allowed = std::max(0.3 * std::sqrt(tolerance_.relative) * largest(value), tolerance_.absolute);
  if (bend > allowed) return std::nullopt;
  const double size = largest(value), own = static_cast<double>(std::max(centre_bound_[pixel - reach], centre_bound_[pixel + reach]));
  return Reflected{value, own + (size > 0 ? 1.5 * bend * bend / size : bend)};
}

// The mean of f over a pixel of side 1 is f + (f_xx + f_yy) / 24 + O(4th derivatives); second differences of neighbours give f_xx, f_yy.
std::optional<LightPainter::Curvature> LightPainter::curvature(std::uint32_t x, std::uint32_t y) const {
  const std::size_t pixel = index(x, y);
  if (known_[pixel] == 0 || x == 0 || y == 0 || x + 1 >= options_.width || y + 1 >= options_.height) return std::nullopt;
  for (const std::size_t n : {pixel - 1, pixel + 1, pixel - options_.width, pixel + options_.width}) {
    if (known_[n] == 0 || survey_.key(n) != survey_.key(pixel)) return std::nullopt;
  }
  const Rgb f_xx = centre_[pixel - 1] + centre_[pixel + 1] - centre_[pixel] * 2.0;
  const Rgb f_yy = centre_[pixel - options_.width] + centre_[pixel + options_.width] - centre_[pixel] * 2.0;
  // Where the centre is dark and a neighbour is not, the light ends nearby: as bent as can be.
  const double size = largest(centre_[pixel]), bend = largest(f_xx) + largest(f_yy);
  return Curvature{(f_xx + f_yy) / 24.0, size > 0 ? bend / size : bend > 0 ? 1.0 : 0.0};
}

// Against each neighbour that shows the same: of light that changes by a part s, in whatever power of the distance to where it ends, f_xx /
// f is about s^2, and the centre errs by s^2 / 24.
bool LightPainter::is_level(std::uint32_t x, std::uint32_t y) const {
  constexpr double most = 0.15;
  const std::size_t pixel = index(x, y);
  const auto level = [&](std::size_t n) {
    return known_[n] == 0 || survey_.key(n) != survey_.key(pixel) || largest(centre_[n] - centre_[pixel]) <= most * largest(centre_[pixel]);
  };
  return (x == 0 || level(pixel - 1)) && (x + 1 >= options_.width || level(pixel + 1)) && (y == 0 || level(pixel - options_.width)) &&
         (y + 1 >= options_.height || level(pixel + options_.width));
}

}  // namespace etendue::rendering
