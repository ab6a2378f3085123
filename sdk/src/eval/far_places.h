// Lights that are small beside the nearest singularity of what they are seen in: one smooth map each, and rules of a few places over it.
// Derivations: sdk/docs/specular.md, "Far lights".
#pragma once

#include "round_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

namespace etendue::eval {

// A parallelogram, relative to the point.
struct FlatPatch {
  Vec3d centre, half_x, half_y;
  double height_area;  // the point's height above its plane times its area

  // Direction and solid angle per part of the area, of the place (x, y) in [-1, 1]^2.
  RoundLight::Place at(double x, double y) const {
    const Vec3d p = centre + half_x * x + half_y * y;
    const double inverse = 1 / length(p);
    return {p * inverse, height_area * inverse * inverse * inverse};
  }
};

// Places along each side of a parallelogram, by Gauss and Legendre; of a round light the first number alone: rings, by Gauss in the squared
// radius, each of four places a ring; 0 rings are its middle alone.
struct FarCounts {
  std::size_t x = 1, y = 1;
};
inline constexpr std::size_t most_far_order = 8, most_far_rings = 4;
inline constexpr double largest_far_size = 0.8;  // up to which the bounds below have been measured

struct FarSeen {
  std::optional<FlatPatch> flat;
  std::optional<RoundLight> round;
  // Half widths (of a round light its half angle) over the distance of the nearest singularity, below 1.
  double x = 0, y = 0;
  double facing = 1;  // cosine at a flat light
};

// How a function with its nearest singularity at the distance 1 / size from the middle of [-1, 1] falls from each degree to the next in
// Chebyshev's or Legendre's series: 1 / rho of the ellipse of Bernstein through it.
inline double falls_by(double size) { return size / (1 + std::sqrt((1 - size) * (1 + size))); }

// What the rule errs by, as a part of the light, for a light of that size: in the leading term a function that falls with the fourth power
// of the distance, ((m + t)^2 + a^2)^-2, has the coefficients of Gegenbauer's C^(2), at most (k + 1)(k + 2)(k + 3) / 6 size^-k, of which
// the rule of n nodes misses e_2n = 2^2n n!^4 / ((2n + 1) (2n)!^2) of the mean of t^2n, and 2 falls_by() is the size in the limit. Twice
// that stands for what else bends: masking, Fresnel's term, the solid angle.
inline double far_bound_of_side(std::size_t order, double size) {
  constexpr std::array<double, most_far_order> leading{13.333, 49.778, 122.88, 245.20, 429.31, 687.77, 1033.1, 1478.0};
  return 2 * leading[order - 1] * std::pow(falls_by(size), 2 * static_cast<double>(order));
}
// Of round lights: twice what has been measured (tests/acceptance/far_errors).
inline double far_bound_of_rings(std::size_t rings, double size) {
  constexpr std::array<double, most_far_rings + 1> measured{4.1, 8.7, 32, 81, 230};
  return 2 * measured[rings] * std::pow(falls_by(size), std::max(4 * static_cast<double>(rings), 2.0));
}

// Of doubles: half vectors near the horizon, slopes that alpha divides, the height above a flat light's plane, a part of the distance.
inline double far_rounding(double alpha, double view_cosine, double facing) {
  return 1e-12 + 2e-14 / facing + (alpha > 0 ? 2e-16 / (alpha * view_cosine) : 0);
}

// The nearest singularity of the BRDF's cosine about `towards`, in radians. Of the lobe as in relative_size; of masking that of the light's
// cosine, which is its height or more; of Fresnel's term and of the half vector itself l = -v.
inline double nearest_singularity(const Vec3d& towards, const Vec3d& view, double alpha) {
  const double apart = length(view + towards), smooth = std::min(towards.z, apart);
  if (!(alpha > 0) || !(apart > 0)) return smooth;
  const HalfAngle h = half_angle(view, towards);
  return std::min(smooth, apart * h.cos2 * std::sqrt(h.sin2 / std::max(h.cos2, 1e-300) + alpha * alpha));
}

// Parallelograms, disks, spheres and suns of one luminance without a window, clear of the horizons; nothing for others.
std::optional<FarSeen> far_seen(const Emitter& emitter, const LocalFrame& frame, const Horizons& horizons, const Vec3d& view, double alpha);

struct UnitRule {
  std::span<const double> x, weight;  // on [0, 1]
};
UnitRule unit_rule(std::size_t nodes);  // 1 to 12

// The integral of kernel(direction) over the directions of the light.
template <class Kernel>
Rgb over_places(const FarSeen& light, const FarCounts& counts, const Kernel& kernel) {
  Rgb sum;
  const auto add = [&](const RoundLight::Place& place, double weight) { sum += kernel(place.direction) * (place.density * weight); };
  if (light.flat) {
    const UnitRule along = unit_rule(counts.x), across = unit_rule(counts.y);
    for (std::size_t i = 0; i < counts.x; ++i)
      for (std::size_t j = 0; j < counts.y; ++j)
        add(light.flat->at(2 * along.x[i] - 1, 2 * across.x[j] - 1), along.weight[i] * across.weight[j]);
    return sum;
  }
  if (counts.x == 0) {
    add(light.round->at(0, 0), pi);
    return sum;
  }
  const UnitRule rings = unit_rule(counts.x);
  const std::size_t around = 4 * counts.x;
  for (std::size_t k = 0; k < around; ++k) {
    const double turn = 2 * pi * (static_cast<double>(k) + 0.5) / static_cast<double>(around), cs = std::cos(turn), sn = std::sin(turn);
    for (std::size_t i = 0; i < counts.x; ++i) {
      const double radius = std::sqrt(rings.x[i]);
      add(light.round->at(radius * cs, radius * sn), rings.weight[i] * (pi / static_cast<double>(around)));
    }
  }
  return sum;
}

}  // namespace etendue::eval
