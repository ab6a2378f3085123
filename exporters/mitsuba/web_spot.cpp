#include "web_spot.h"

#include <algorithm>
#include <cmath>

namespace etendue::mitsuba {
namespace {

// Beyond it the picture, which lies on a plane ahead, is stretched: a cube is finer.
constexpr double widest_rad = 60 * pi / 180;

// Of the cone about the nadir that holds all light: a cell with a lit node ends at that node's neighbours, and in each of the three types
// a cell is furthest from the nadir at a corner (cos gamma = cos V cos H in types A and B).
double half_angle(const IntensityWeb& web) {
  const std::vector<double>& polar = web.polar().nodes();
  std::vector<double> azimuth = web.azimuth().nodes();
  if (azimuth.empty()) azimuth = {0};
  const auto lit = [&](std::size_t j, std::size_t i) {
    const auto near = [](std::size_t k, std::size_t count) { return std::pair(k > 0 ? k - 1 : 0, std::min(k + 1, count - 1)); };
    const auto [first, last] = near(i, polar.size());
    const auto [left, right] = near(j, azimuth.size());
    for (std::size_t b = left; b <= right; ++b)
      for (std::size_t a = first; a <= last; ++a)
        if (web.node(b, a) > 0) return true;
    return false;
  };
  double widest = 0;
  for (std::size_t j = 0; j < azimuth.size(); ++j) {
    for (std::size_t i = 0; i < polar.size(); ++i) {
      if (!lit(j, i)) continue;
      const Vec3d d = direction_of(web.type(), web.unfolded(polar[i], azimuth[j], 0), web.frame());
      widest = std::max(widest, std::atan2(std::hypot(d.x, d.y), -d.z));
    }
  }
  return widest;
}

class Table {
 public:
  Table(const ShadedWeb& web, double outer_rad, std::uint32_t texels)
      : web_(web), extent_(std::tan(outer_rad)), texels_(static_cast<int>(texels)) {
    for (int row = 0; row < texels_; ++row)
      for (int column = 0; column < texels_; ++column) cd_.push_back(web_towards(column, row));
  }

  // Lumens by Gauss's rule with 2 x 2 points a texel, inside the cone.
  double flux() const {
    const double offset = 0.5 / std::sqrt(3.0), h = 2 * extent_ / (texels_ - 1);
    double sum = 0;
    for (int row = 0; row + 1 < texels_; ++row) {
      for (int column = 0; column + 1 < texels_; ++column) {
        for (const double dy : {-offset, offset}) {
          for (const double dx : {-offset, offset}) {
            const double c = column + 0.5 + dx, r = row + 0.5 + dy, x = place(c), y = place(r), square = 1 + x * x + y * y;
            if (square <= 1 + extent_ * extent_) sum += interpolated(c, r) / (square * std::sqrt(square));
          }
        }
      }
    }
    return sum * h * h / 4;
  }

  // 4/3 of the largest deviation of `factor` times the table a quarter of a texel apart, inside the cone.
  double error(double factor) const {
    double worst = 0;
    for (int j = 0; j <= 4 * (texels_ - 1); ++j) {
      for (int i = 0; i <= 4 * (texels_ - 1); ++i) {
        const double c = 0.25 * i, r = 0.25 * j, x = place(c), y = place(r);
        if (x * x + y * y > extent_ * extent_) continue;
        worst = std::max(worst, std::abs(factor * interpolated(c, r) - web_towards(c, r)));
      }
    }
    return 4.0 / 3 * worst;
  }

  double peak() const { return *std::max_element(cd_.begin(), cd_.end()); }
  const std::vector<double>& cd() const { return cd_; }

 private:
  double place(double index) const { return extent_ * (2 * index / (texels_ - 1) - 1); }
  // Mitsuba's spot has +x to its left: half a turn about y leads to the light's frame. A direction beyond a bright end is drawn back onto
  // it, so that texels outside the cone do not darken its edge.
  double web_towards(double column, double row) const {
    const double x = -place(column), y = place(row), leg = std::hypot(x, y);
    const double held = leg > extent_ ? extent_ * (1 - 1e-9) / leg : 1;
    return web_.towards(normalised(Vec3d{x * held, y * held, -1}));
  }
  double interpolated(double column, double row) const {
    const int i = std::min(static_cast<int>(column), texels_ - 2), j = std::min(static_cast<int>(row), texels_ - 2);
    const double s = column - i, t = row - j;
    const auto at = [&](int c, int r) {
      return cd_[static_cast<std::size_t>(r) * static_cast<std::size_t>(texels_) + static_cast<std::size_t>(c)];
    };
    return (1 - t) * ((1 - s) * at(i, j) + s * at(i + 1, j)) + t * ((1 - s) * at(i, j + 1) + s * at(i + 1, j + 1));
  }

  const ShadedWeb& web_;
  double extent_;
  int texels_;
  std::vector<double> cd_;
};

}  // namespace

std::optional<WebSpot> web_spot(const ShadedWeb& web, double wanted_cd, std::uint32_t fewest, std::uint32_t most) {
  const double table_rad = half_angle(web.web), outer_rad = web.shade != nullptr ? std::min(table_rad, web.outer_rad) : table_rad;
  if (outer_rad > widest_rad || !(outer_rad > 0)) return {};
  std::optional<WebSpot> spot;
  for (std::uint32_t texels = fewest; texels <= most; texels *= 2) {
    const Table table(web, outer_rad, texels);
    const double flux = table.flux();
    if (!(flux > 0)) continue;
    const double factor = web.flux_lm() / flux, error_cd = table.error(factor);
    const bool stuck = spot && error_cd > 0.9 * spot->error_cd;
    if (!spot || error_cd < spot->error_cd) {
      const double peak = table.peak();
      spot = WebSpot{outer_rad, factor * peak, texels, {}, error_cd};
      for (const double cd : table.cd()) spot->shares.push_back(static_cast<float>(cd / peak));
    }
    if (error_cd <= wanted_cd || stuck) break;
  }
  return spot;
}

}  // namespace etendue::mitsuba
