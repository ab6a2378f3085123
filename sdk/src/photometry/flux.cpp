// Flux: the integral of what is evaluated. Derived in sdk/docs/photometry.md.
#include <algorithm>
#include <array>
#include <cmath>

#include "etendue/intensity_web.h"
#include "gauss.h"
#include "polynomial.h"

namespace etendue {
namespace {

constexpr double degree = pi / 180;

// Integral of a piecewise linear function of the azimuth over part of its axis, from its values at the nodes, in radians.
template <class Value>
double linear_integral(const std::vector<double>& nodes, double from, double to, const Value& value) {
  double sum = 0;
  for (std::size_t j = 0; j + 1 < nodes.size(); ++j) {
    const double lo = std::max(from, nodes[j]), hi = std::min(to, nodes[j + 1]);
    if (!(lo < hi)) continue;
    const double a = value(j), b = value(j + 1), t = (0.5 * (lo + hi) - nodes[j]) / (nodes[j + 1] - nodes[j]);
    sum += (hi - lo) * degree * (a + t * (b - a));
  }
  return sum;
}

}  // namespace

double IntensityWeb::profile_integral(std::size_t plane, std::uint32_t i, double from_deg, double to_deg) const {
  const std::vector<double>& x = polar_.nodes();
  const double middle = 0.5 * (from_deg + to_deg) * degree, half = 0.5 * (to_deg - from_deg) * degree;
  const bool whole = from_deg == x[i] && to_deg == x[i + 1];
  const double* const y = &candela_[plane * x.size() + i];
  const double left = whole ? y[0] : profile(plane, i, from_deg, std::cos(from_deg * degree));
  const double right = whole ? y[1] : profile(plane, i, to_deg, std::cos(to_deg * degree));
  if (interpolation_ == Interpolation::cosine) return (left + right) * std::sin(middle) * std::sin(half);
  if (interpolation_ == Interpolation::linear) {
    const photometry::SineMoments m = photometry::sine_moments(half);
    return std::sin(middle) * 0.5 * (left + right) * m.e0 + std::cos(middle) * 0.5 * (right - left) / half * m.o1;
  }
  // Part of a cubic: its slopes at the new ends, from the Hermite form of the whole.
  const double* const s = &slope_[plane * x.size() + i];
  const double width = x[i + 1] - x[i];
  const auto slope_at = [&](double angle) {
    const double t = (angle - x[i]) / width, u = 1 - t;
    return (6 * t * u * (y[1] - y[0]) / width + s[0] * u * (1 - 3 * t) + s[1] * t * (3 * t - 2)) / degree;
  };
  return photometry::integral_with_sine(photometry::cubic_between(left, right, slope_at(from_deg), slope_at(to_deg), half), middle, half);
}

double IntensityWeb::plane_integral(std::size_t plane, double from_deg, double to_deg) const {
  const std::vector<double>& x = polar_.nodes();
  double sum = 0;
  for (std::uint32_t i = 0; i + 1 < x.size(); ++i) {
    const double lo = std::max(from_deg, x[i]), hi = std::min(to_deg, x[i + 1]);
    if (lo < hi) sum += profile_integral(plane, i, lo, hi);
  }
  return sum;
}

namespace {

// A, B: with the latitude l and the longitude p from the beam, cos(gamma) = cos(l) cos(p), so the cone gamma <= G holds |p| <= acos(cos G /
// cos l). Over p the interpolant is integrated exactly, over l by Gauss between the nodes and where the bound begins or ends; l = (3 x -
// x^3) / 2 takes away the square root that it has there.
double flux_inside_cone(const IntensityWeb& web, double cone_deg) {
  const std::vector<double>& polar = web.polar().nodes();
  const std::vector<double>& azimuth = web.azimuth().nodes();
  const double edge = std::min(cone_deg, 180 - cone_deg), cosine_of_cone = std::cos(cone_deg * degree);
  std::vector<double> splits{90 - edge, 90 + edge};
  splits.insert(splits.end(), polar.begin(), polar.end());
  std::sort(splits.begin(), splits.end());
  double sum = 0;
  for (std::size_t k = 0; k + 1 < splits.size(); ++k) {
    const double lo = std::max(splits[k], polar.front()), hi = std::min(splits[k + 1], polar.back());
    if (!(lo < hi)) continue;
    const std::uint32_t i = web.polar().interval(0.5 * (lo + hi));
    for (const photometry::GaussNode& node : photometry::gauss_16) {
      const double x = node.x, angle = 0.5 * (lo + hi) + 0.25 * (hi - lo) * x * (3 - x * x);
      const double sine = std::sin(angle * degree), bound = cosine_of_cone / sine;
      if (bound >= 1) continue;
      const double reach = bound <= -1 ? 180 : std::acos(bound) / degree;
      const double across =
          linear_integral(azimuth, -reach, reach, [&](std::size_t j) { return web.profile(j, i, angle, std::cos(angle * degree)); });
      sum += node.weight * 0.75 * (hi - lo) * degree * (1 - x * x) * sine * across;
    }
  }
  return web.copies() * sum;
}

}  // namespace

double IntensityWeb::flux_between(double from_gamma_deg, double to_gamma_deg) const {
  const double from = std::clamp(from_gamma_deg, 0.0, 180.0), to = std::clamp(to_gamma_deg, from, 180.0);
  if (from == to) return 0;
  if (type_ != WebType::c && !(from == 0 && to == 180))
    return std::max(0.0, (to == 180 ? flux_lm_ : flux_inside_cone(*this, to)) - (from == 0 ? 0 : flux_inside_cone(*this, from)));
  if (symmetry_ == WebSymmetry::rotational) return 2 * pi * plane_integral(0, from, to);
  std::vector<double> planes(azimuth_.nodes().size());
  for (std::size_t j = 0; j < planes.size(); ++j) planes[j] = plane_integral(j, from, to);
  const std::vector<double>& nodes = azimuth_.nodes();
  return copies() * linear_integral(nodes, nodes.front(), nodes.back(), [&](std::size_t j) { return planes[j]; });
}

}  // namespace etendue
