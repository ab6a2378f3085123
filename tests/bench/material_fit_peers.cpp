#include "material_fit_peers.h"

#include "metal_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#ifdef ETENDUE_CMINPACK
#include <cminpack.h>
#endif

namespace etendue::bench {

#ifdef ETENDUE_CMINPACK
namespace {

struct Task {
  const ColourPair& pair;
  Bounds bounds;
};

// The parameter of an unknown, and its derivative.
struct Parameter {
  double x, slope;
};
Parameter parameter(double u, Bounds bounds) {
  if (bounds == Bounds::sine) return {(1 + std::sin(u)) / 2, std::cos(u) / 2};
  if (bounds == Bounds::clamped_inside) return {std::clamp(u, 0.0, 1.0), u > 0 && u < 1 ? 1.0 : 0.0};
  return {u, 1};
}
// At a bound the sine has no slope and a start would never leave it.
double unknown(double x, Bounds bounds) { return bounds == Bounds::sine ? std::asin(2 * std::clamp(x, 0.01, 0.99) - 1) : x; }

int differences(void* user, int, int, const double* u, double* f, double* jacobian, int rows, int flag) {
  const Task& task = *static_cast<const Task*>(user);
  std::array<Parameter, 5> p;
  for (std::size_t i = 0; i < 5; ++i) p[i] = parameter(u[i], task.bounds);
  const double r = p[0].x, m = p[1].x, s = 1 - m, dielectric = 0.16 * r * r;
  if (flag == 1) {
    for (int c = 0; c < 3; ++c) {
      const double b = p[2 + static_cast<std::size_t>(c)].x;
      f[c] = dielectric * s + b * m - task.pair.f0[c];
      f[3 + c] = s * b - task.pair.diffuse[c];
    }
    return 0;
  }
  std::fill_n(jacobian, 5 * rows, 0.0);
  for (int c = 0; c < 3; ++c) {
    const Parameter& b = p[2 + static_cast<std::size_t>(c)];
    jacobian[c] = 0.32 * r * s * p[0].slope;
    jacobian[rows + c] = (b.x - dielectric) * p[1].slope;
    jacobian[(2 + c) * rows + c] = m * b.slope;
    jacobian[rows + 3 + c] = -b.x * p[1].slope;
    jacobian[(2 + c) * rows + 3 + c] = s * b.slope;
  }
  return 0;
}

}  // namespace

DisneyColours cminpack_fit(const ColourPair& pair, const DisneyColours& start, Bounds bounds) {
  std::array<double, 5> u{};
  u[0] = unknown(start.reflectance, bounds), u[1] = unknown(start.metal, bounds);
  for (int c = 0; c < 3; ++c) u[2 + static_cast<std::size_t>(c)] = unknown(start.base_colour[c], bounds);
  std::array<double, 6> f{};
  std::array<double, 30> jacobian{};
  std::array<int, 5> pivots{};
  std::array<double, 64> work{};
  Task task{pair, bounds};
  lmder1(differences, &task, 6, 5, u.data(), f.data(), jacobian.data(), 6, 1e-8, pivots.data(), work.data(), static_cast<int>(work.size()));
  const auto x = [&](std::size_t i) { return std::clamp(parameter(u[i], bounds).x, 0.0, 1.0); };
  return {{x(2), x(3), x(4)}, x(1), x(0)};
}
#endif

DisneyColours grid_and_golden_section(const ColourPair& pair) {
  const MetalProfile profile(MetalProfile::channels_of(pair), DielectricF0::free);
  constexpr int points = 9, sections = 16;
  double best = 0, least = profile(0).residual;
  for (int i = 1; i < points; ++i) {
    const double m = static_cast<double>(i) / (points - 1);
    if (const double r = profile(m).residual; r < least) least = r, best = m;
  }
  const double ratio = (std::sqrt(5.0) - 1) / 2;
  double low = std::max(best - 1.0 / (points - 1), 0.0), high = std::min(best + 1.0 / (points - 1), 1.0);
  double a = high - ratio * (high - low), b = low + ratio * (high - low), at_a = profile(a).residual, at_b = profile(b).residual;
  for (int i = 0; i < sections; ++i) {
    if (at_a <= at_b) {
      high = b, b = a, at_b = at_a, a = high - ratio * (high - low), at_a = profile(a).residual;
    } else {
      low = a, a = b, at_a = at_b, b = low + ratio * (high - low), at_b = profile(b).residual;
    }
  }
  const double valley = at_a <= at_b ? a : b;
  return fit_disney_at(std::min(at_a, at_b) < least ? valley : best, pair);
}

DisneyColours solve_metallic(const ColourPair& pair) {
  constexpr double dielectric = 0.04, tiny = 1e-6;
  const auto brightness = [](const Rgb& c) { return std::sqrt(0.299 * c.x * c.x + 0.587 * c.y * c.y + 0.114 * c.z * c.z); };
  const double d = brightness(pair.diffuse), f = brightness(pair.f0);
  double m = 0;
  if (f >= dielectric) {
    const double b = d / (1 - dielectric) + f - 2 * dielectric, c = dielectric - f;
    m = std::clamp((-b + std::sqrt(std::max(b * b - 4 * dielectric * c, 0.0))) / (2 * dielectric), 0.0, 1.0);
  }
  DisneyColours out{{}, m, 0.5};
  for (int c = 0; c < 3; ++c) {
    const double of_diffuse = pair.diffuse[c] / (1 - dielectric) / std::max(1 - m, tiny);
    const double of_f0 = (pair.f0[c] - dielectric * (1 - m)) / std::max(m, tiny);
    out.base_colour[c] = std::clamp(of_diffuse + (of_f0 - of_diffuse) * m * m, 0.0, 1.0);
  }
  return out;
}

}  // namespace etendue::bench
