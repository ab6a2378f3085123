// Correlated colour temperature and Duv, exactly.
#include "etendue/colour.h"
#include "parameter_error.h"
#include "planck_locus.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace etendue {
namespace {

constexpr double least_K = 500, largest_K = 100000;
constexpr double least_reciprocal = 1 / largest_K, largest_reciprocal = 1 / least_K;
constexpr double largest_duv = 0.05;

// The locus' unit normal towards larger v: the tangent towards larger M (redder, larger u) turned left.
Vec2d normal_of(const LocusPoint& p) {
  const double length = std::hypot(p.first.x, p.first.y);
  return {-p.first.y / length, p.first.x / length};
}

Error out_of_range(const char* what, double temperature_K) {
  return parameter_error(
      "kelvin", "TEMPERATURE_OUT_OF_RANGE",
      fmt::format("expected a temperature of {} between {} K and {} K, found {} K", what, least_K, largest_K, temperature_K));
}

// Samples of the locus from which the search starts, built on first use.
constexpr int sample_count = 129;
using Samples = std::array<Vec2d, sample_count>;
double reciprocal_of_sample(int i) { return largest_reciprocal * i / (sample_count - 1); }
const Samples& samples() {
  static const Samples all = [] {
    Samples made;
    for (int i = 0; i < sample_count; ++i) made[static_cast<std::size_t>(i)] = planck_locus(reciprocal_of_sample(i)).uv;
    return made;
  }();
  return all;
}

double squared_distance(const Vec2d& a, const Vec2d& b) {
  const double x = a.x - b.x, y = a.y - b.y;
  return x * x + y * y;
}

}  // namespace

Uv to_uv1960(const Chromaticity& xy) {
  const double d = -2 * xy.x + 12 * xy.y + 3;
  return {4 * xy.x / d, 6 * xy.y / d};
}
Chromaticity from_uv1960(const Uv& uv) {
  const double d = 2 * uv.u - 8 * uv.v + 4;
  return {3 * uv.u / d, 2 * uv.v / d};
}
double difference_uv1976(const Chromaticity& a, const Chromaticity& b) {
  const Uv p = to_uv1960(a), q = to_uv1960(b);
  return std::hypot(p.u - q.u, 1.5 * (p.v - q.v));
}

Result<Chromaticity> to_chromaticity(const ColourTemperature& temperature) {
  if (!(temperature.kelvin >= least_K && temperature.kelvin <= largest_K))
    return out_of_range("a correlated colour temperature", temperature.kelvin);
  if (!(std::abs(temperature.duv) <= largest_duv))
    return parameter_error("duv", "DUV_OUT_OF_RANGE",
                           fmt::format("expected a Duv between -{0} and {0}, found {1}", largest_duv, temperature.duv),
                           "further from the Planckian locus a correlated colour temperature has no meaning");
  const LocusPoint p = planck_locus(1 / temperature.kelvin);
  const Vec2d n = normal_of(p);
  return from_uv1960({p.uv.x + temperature.duv * n.x, p.uv.y + temperature.duv * n.y});
}

// The nearest point c(M) to q has (c - q) . c' = 0; Newton's steps with the exact derivative c' . c' + (c - q) . c'' from the nearest
// sample. The derivative stays positive because the centre of curvature is further away than q (|Duv| <= .05 < .100). Steps are halved
// where they would not come nearer.
Result<ColourTemperature> to_colour_temperature(const Chromaticity& xy) {
  const auto not_near = [&](double duv) {
    return parameter_error(
        "xy", "NOT_NEAR_LOCUS",
        fmt::format("expected a chromaticity within |Duv| <= {} of the Planckian locus, found ({}, {}) with a distance of {:.4f}",
                    largest_duv, xy.x, xy.y, duv),
        "it has no correlated colour temperature");
  };
  const Uv given = to_uv1960(xy);
  const Vec2d q{given.u, given.v};
  if (!(std::isfinite(q.x) && std::isfinite(q.y) && xy.y > 0)) return not_near(std::numeric_limits<double>::infinity());

  const Samples& all = samples();
  const auto nearest = std::min_element(all.begin(), all.end(),
                                        [&](const Vec2d& a, const Vec2d& b) { return squared_distance(a, q) < squared_distance(b, q); });
  double m = reciprocal_of_sample(static_cast<int>(nearest - all.begin()));
  LocusPoint p = planck_locus(m);
  double distance = squared_distance(p.uv, q);
  if (distance > 4 * largest_duv * largest_duv) return not_near(std::sqrt(distance));

  constexpr int most_steps = 40;
  for (int i = 0; i < most_steps; ++i) {
    const Vec2d away{p.uv.x - q.x, p.uv.y - q.y};
    const double slope = p.first.x * p.first.x + p.first.y * p.first.y + away.x * p.second.x + away.y * p.second.y;
    double step = -(away.x * p.first.x + away.y * p.first.y) / slope;
    LocusPoint next = planck_locus(std::max(m + step, 0.0));
    while (squared_distance(next.uv, q) > distance && std::abs(step) > 1e-12 * largest_reciprocal) {
      step /= 2;
      next = planck_locus(std::max(m + step, 0.0));
    }
    const double taken = std::max(m + step, 0.0) - m;
    m += taken;
    p = next;
    distance = squared_distance(p.uv, q);
    if (std::abs(taken) <= 1e-15 * m) break;
  }
  const Vec2d n = normal_of(p);
  const double duv = (q.x - p.uv.x) * n.x + (q.y - p.uv.y) * n.y;
  if (std::abs(duv) > largest_duv * (1 + 1e-9)) return not_near(duv);
  // Half a part in 10^9 beyond the ends is rounding.
  constexpr double slack = 5e-10;
  if (m < least_reciprocal * (1 - slack) || m > largest_reciprocal * (1 + slack))
    return about("xy", out_of_range("a correlated colour temperature", m > 0 ? 1 / m : std::numeric_limits<double>::infinity()));
  return ColourTemperature{std::clamp(1 / m, least_K, largest_K), duv};
}

Result<double> mired_of(double temperature_K) {
  if (temperature_K > 0 && std::isfinite(1e6 / temperature_K)) return 1e6 / temperature_K;
  return parameter_error("kelvin", "TEMPERATURE_OUT_OF_RANGE", fmt::format("expected a temperature above 0 K, found {} K", temperature_K));
}
Result<double> shifted_by_mired(double temperature_K, double shift_mired) {
  const Result<double> mired = mired_of(temperature_K);
  if (!mired) return mired.error();
  const double shifted = *mired + shift_mired;
  if (shifted > 0 && std::isfinite(1e6 / shifted)) return 1e6 / shifted;
  return parameter_error("shift_mired", "TEMPERATURE_OUT_OF_RANGE",
                         fmt::format("expected a shift that leaves a positive temperature, found {} K ({} mired) shifted by {} mired",
                                     temperature_K, *mired, shift_mired));
}

}  // namespace etendue
