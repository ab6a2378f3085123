// Unblocked light at the centres of smooth pixels: evaluated on a coarse lattice first, then on finer ones, and interpolated in between
// where it bends so little that the interpolation's error is below the tolerance.
#include "painter.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

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
  if (!has_plan(index(x, y))) return false;
  if (options_.shadows == Shadows::ratio || surroundings(x, y).beta > 0) return true;
  return (x > 0 && surroundings(x - 1, y).beta > 0) || (y > 0 && surroundings(x, y - 1).beta > 0) ||
         (x + 1 < options_.width && surroundings(x + 1, y).beta > 0) || (y + 1 < options_.height && surroundings(x, y + 1).beta > 0);
}

// All of a row that are to be evaluated are evaluated together; none of a pass hangs on another of it.
void LightPainter::centre_row(std::uint32_t row, int pass, RayCounts& counts) {
  std::vector<SeenPoint> wanted;
  std::vector<std::size_t> pixels;
  const auto keep = [&](std::size_t pixel, const Response& response) {
    black_[pixel] = response.black;
    slope_[pixel] = response.slope;
    centre_bound_[pixel] = static_cast<float>(response.bound);
    known_[pixel] = 1;
  };
  for (std::uint32_t x = 0; x < options_.width; ++x) {
    const std::size_t pixel = index(x, row);
    if (place_of(x, row).pass() != pass || survey_.regions(pixel) != nullptr || !centre_is_needed(x, row)) continue;
    const Ray ray = camera_.through(x + 0.5, row + 0.5);
    const auto point = stage_.first(ray);
    if (!is_plain(point) && !is_coloured(point)) continue;
    // Lambert's closed forms cost no more than an interpolation; pictures have none.
    const Rgb colour = base_colour_at(*stage_.thing(point->thing).paint, point->uv);
    const std::optional<Response> between = is_matt(*point) && light_.picture == nullptr ? std::nullopt : interpolated(x, row, colour);
    if (between) {
      keep(pixel, *between);
    } else {
      wanted.push_back({*point, -ray.direction}), pixels.push_back(pixel);
    }
  }
  const std::vector<Response> found = lighting_.responses(light_, wanted, *plan_, counts);
  for (std::size_t k = 0; k < found.size(); ++k) keep(pixels[k], found[k]);
}

// The cubic through four places at -3, -1, 1, 3 steps has (9 (f(-1) + f(1)) - f(-3) - f(3)) / 16 in the middle and errs by .375 h^4 f4, h
// the step, f4 the fourth derivative. Five places 2 h apart have the fourth difference 16 h^4 f4: those from -3 to 5 and from -5 to 3 say
// what f4 is on both sides, and the larger stands for the error, doubled, as it is not constant in between.
std::optional<Response> LightPainter::interpolated(std::uint32_t x, std::uint32_t y, const Rgb& colour) const {
  const Place place = place_of(x, y);
  if (light_.delta || !(place.between_x || place.between_y)) return std::nullopt;
  const std::int64_t at = place.between_x ? x : y, end = place.between_x ? options_.width : options_.height;
  const std::int64_t pixel = index(x, y), reach = std::int64_t{place.step} * (place.between_x ? 1 : options_.width);
  const auto pixel_at = [&](int steps) { return static_cast<std::size_t>(pixel + steps * reach); };
  // Of the same surface, so many steps away.
  const auto known = [&](int steps) {
    const std::int64_t there = at + std::int64_t{steps} * place.step;
    if (there < 0 || there >= end) return false;
    return known_[pixel_at(steps)] != 0 && survey_.key(pixel_at(steps)) == survey_.key(static_cast<std::size_t>(pixel));
  };
  const bool before = known(-5), after = known(5);
  if (!known(-3) || !known(-1) || !known(1) || !known(3) || !(before || after)) return std::nullopt;
  const auto cubic = [&](const std::vector<Rgb>& f) {
    return (f[pixel_at(-1)] + f[pixel_at(1)]) * (9.0 / 16) - (f[pixel_at(-3)] + f[pixel_at(3)]) / 16.0;
  };
  const auto fourth = [&](int from) {
    Rgb sum;
    const std::array<double, 5> binomial{1, -4, 6, -4, 1};
    for (int i = 0; i < 5; ++i) sum += centre(pixel_at(from + 2 * i), colour) * binomial[static_cast<std::size_t>(i)];
    return largest(sum);
  };
  const double error = 2 * 0.375 / 16 * std::max(before ? fourth(-5) : 0, after ? fourth(-3) : 0);
  const Rgb black = cubic(black_), slope = cubic(slope_);
  if (error > std::max(0.2 * tolerance_.relative * largest(black + slope * colour), tolerance_.absolute)) return std::nullopt;
  const auto bound = [&](int steps) { return static_cast<double>(centre_bound_[pixel_at(steps)]); };
  return Response{black, slope, std::max(bound(-1), bound(1)) + error};
}

// The mean of f over a pixel of side 1 is f + (f_xx + f_yy) / 24 + O(4th derivatives); second differences of neighbours give f_xx, f_yy.
std::optional<LightPainter::Curvature> LightPainter::curvature(std::uint32_t x, std::uint32_t y, const Rgb& colour) const {
  const std::size_t pixel = index(x, y);
  if (known_[pixel] == 0 || x == 0 || y == 0 || x + 1 >= options_.width || y + 1 >= options_.height) return std::nullopt;
  for (const std::size_t n : {pixel - 1, pixel + 1, pixel - options_.width, pixel + options_.width}) {
    if (known_[n] == 0 || survey_.key(n) != survey_.key(pixel)) return std::nullopt;
  }
  const Rgb f = centre(pixel, colour);
  const Rgb f_xx = centre(pixel - 1, colour) + centre(pixel + 1, colour) - f * 2.0;
  const Rgb f_yy = centre(pixel - options_.width, colour) + centre(pixel + options_.width, colour) - f * 2.0;
  // Where the centre is dark and a neighbour is not, the light ends nearby: as bent as can be.
  const double size = largest(f), bend = largest(f_xx) + largest(f_yy);
  return Curvature{(f_xx + f_yy) / 24.0, size > 0 ? bend / size : bend > 0 ? 1.0 : 0.0};
}

// Against each neighbour that shows the same: of light that changes by a part s, in whatever power of the distance to where it ends, f_xx /
// f is about s^2, and the centre errs by s^2 / 24.
bool LightPainter::is_level(std::uint32_t x, std::uint32_t y, const Rgb& colour) const {
  constexpr double most = 0.15;
  const std::size_t pixel = index(x, y);
  const Rgb f = centre(pixel, colour);
  const auto level = [&](std::size_t n) {
    return known_[n] == 0 || survey_.key(n) != survey_.key(pixel) || largest(centre(n, colour) - f) <= most * largest(f);
  };
  return (x == 0 || level(pixel - 1)) && (x + 1 >= options_.width || level(pixel + 1)) && (y == 0 || level(pixel - options_.width)) &&
         (y + 1 >= options_.height || level(pixel + options_.width));
}

// Whether second differences are enough for the pixel's mean, or none is needed.
bool LightPainter::is_gentle(std::uint32_t x, std::uint32_t y, const SurfacePoint& centre) const {
  if (known_[index(x, y)] == 0) return false;
  const Rgb colour = base_colour_at(*stage_.thing(centre.thing).paint, centre.uv);
  const std::optional<Curvature> bend = curvature(x, y, colour);
  return bend ? bend->relative < gentle_bend : is_level(x, y, colour);
}

// Differences to neighbours that show the same; what lies beside an edge has them on one side only, and then no second ones.
LightPainter::Local LightPainter::local(const std::vector<Rgb>& values, std::uint32_t x, std::uint32_t y) const {
  const std::size_t pixel = index(x, y);
  const Rgb f = values[pixel];
  const auto along = [&](std::uint32_t at, std::uint32_t end, std::size_t step) {
    const auto shows_the_same = [&](std::size_t n) { return known_[n] != 0 && survey_.key(n) == survey_.key(pixel); };
    const bool before = at > 0 && shows_the_same(pixel - step), after = at + 1 < end && shows_the_same(pixel + step);
    const Rgb back = before ? f - values[pixel - step] : Rgb{}, ahead = after ? values[pixel + step] - f : Rgb{};
    if (before && after) return std::pair((back + ahead) * 0.5, ahead - back);
    return std::pair(back + ahead, Rgb{});
  };
  const auto [f_x, f_xx] = along(x, options_.width, 1);
  const auto [f_y, f_yy] = along(y, options_.height, options_.width);
  return {f, f_x, f_y, f_xx, f_yy};
}

}  // namespace etendue::rendering
