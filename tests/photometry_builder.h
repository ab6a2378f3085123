// Distributions for tests: a grid filled from a function of direction.
#pragma once

#include <functional>

#include "etendue/intensity_web.h"

namespace etendue::test {

inline std::vector<double> steps(double from, double to, double step) {
  std::vector<double> angles;
  for (int i = 0; from + i * step < to + 1e-9; ++i) angles.push_back(from + i * step);
  return angles;
}

// Candelas as they are: every factor is 1.
inline IntensityDistribution distribution_of(WebType type, WebSymmetry symmetry, std::vector<double> vertical,
                                             std::vector<double> horizontal, const std::function<double(const Vec3d&)>& candelas) {
  IntensityDistribution d;
  d.grid = {type, symmetry, std::move(vertical), std::move(horizontal), {}};
  for (const double h : d.grid.horizontal_deg)
    for (const double v : d.grid.vertical_deg) d.grid.values.push_back(candelas(direction_of(type, {v, h})));
  return d;
}

inline IntensityWeb web_of(const IntensityDistribution& d, Interpolation interpolation = Interpolation::linear,
                           const WebFrame& frame = {}) {
  Result<IntensityWeb> web = IntensityWeb::of(d, interpolation, frame);
  return web ? std::move(*web) : IntensityWeb{};
}

// A floodlight with a closed form: I = 1000 cos^6 V cos^2 H of type B = 1000 (-z)^6 / (x^2 + z^2)^2 in the forward half, since
// cos V = -z / r and cos H = r with r^2 = x^2 + z^2. Its flux is 1000 (5 pi / 16) (4 / 3).
inline double floodlight(const Vec3d& u) {
  const double r2 = u.x * u.x + u.z * u.z;
  if (!(u.z < 0) || r2 < 1e-30) return 0;
  const double forward = u.z * u.z / r2;
  return 1000 * forward * forward * forward * r2;
}
inline constexpr double floodlight_flux_lm = 1000 * 5 * pi / 16 * 4 / 3;

}  // namespace etendue::test
