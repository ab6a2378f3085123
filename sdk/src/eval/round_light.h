// Disks, spheres and suns as one smooth map from the unit disk to directions. Derivations: sdk/docs/evaluation.md.
#pragma once

#include "local.h"
#include "microfacet.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace etendue::eval {

struct RoundLight {
  Vec3d centre;   // of a disk, relative to the point; of a cap of directions (sphere, sun): its axis, unit
  Vec3d u, v;     // across: of a disk as long as its radius, of a cap unit
  double weight;  // of a disk: the point's height above its plane times its squared radius; of a cap: 1 - cosine of its half angle
  bool cap;
  double widest;  // bound on the half angle that it is seen under

  struct Place {
    Vec3d direction;
    double density;  // solid angle per area of the unit disk
  };
  // Disk: d omega = height R^2 / d^3 dx dy. Cap: Lambert's azimuthal equal-area map, whose density is constant.
  Place at(double x, double y) const {
    if (cap) {
      const double drop = weight * (x * x + y * y);
      return {centre * (1 - drop) + (u * x + v * y) * std::sqrt(weight * (2 - drop)), 2 * weight};
    }
    const Vec3d p = centre + u * x + v * y;
    const double inverse = 1 / length(p);
    return {p * inverse, weight * inverse * inverse * inverse};
  }
};

// A round light of one luminance that is clear of both horizons by its own half angle or more; nothing for all else.
std::optional<RoundLight> clear_round_light(const Emitter& emitter, const LocalFrame& frame, const Horizons& horizons);

// The light's half angle against the distance of the nearest singularity of a GGX lobe (without one, alpha 0: the half angle itself).
// Density: 1 / (alpha^2 + m^2)^2 in the slope m of the half vector h, with poles sqrt(m_0^2 + alpha^2) away from the slope m_0 at the
// light's centre. A direction that turns by rho turns h by no more than rho / |v + l| and moves m by 1 / (n.h)^2 of that.
// Masking: sqrt(z^2 + alpha^2 (1 - z^2)) in the light's height z, which branches about sqrt(z^2 + alpha^2) away.
inline double relative_size(const RoundLight& light, const Vec3d& view, double alpha) {
  if (!(alpha > 0)) return light.widest;
  const Vec3d towards = light.at(0, 0).direction;
  const HalfAngle h = half_angle(view, towards);
  const double alpha2 = alpha * alpha, to_pole = 2 * h.v_dot_h * h.cos2 * std::sqrt(h.sin2 / h.cos2 + alpha2);
  return light.widest / std::min(to_pole, std::sqrt(towards.z * towards.z + alpha2));
}

}  // namespace etendue::eval
