#include "round_light.h"

namespace etendue::eval {
namespace {

RoundLight cap_light(const Vec3d& axis, double cosine, double sine) {
  const Basis b = basis_around(axis);
  // 1 - cos = sin^2 / (1 + cos) keeps its digits for narrow caps. The half angle is at most pi / 2 times its sine.
  return {axis, b.tangent, b.bitangent, sine * sine / (1 + cosine), true, 1.5708 * sine};
}

struct Visitor {
  const Emitter& emitter;
  const LocalFrame& frame;

  std::optional<RoundLight> operator()(const DistantEmitter& e) const {
    if (!(e.radius_rad > 0) || e.radius_rad > 1) return std::nullopt;
    return cap_light(frame.vector(e.towards), std::cos(e.radius_rad), std::sin(e.radius_rad));
  }
  std::optional<RoundLight> operator()(const SphereEmitter& e) const {
    const Vec3d centre = frame.point(e.centre);
    const double d = length(centre);
    if (!(e.radius > 0) || !(d > e.radius)) return std::nullopt;
    return cap_light(centre / d, std::sqrt((d - e.radius) * (d + e.radius)) / d, e.radius / d);
  }
  // From outside its rim's sphere a disk is within the half angle asin(R / d).
  std::optional<RoundLight> operator()(const DiskEmitter& e) const {
    const Vec3d centre = frame.point(e.centre), normal = frame.vector(e.normal);
    const double d = length(centre), height = -dot(centre, normal);
    if (!(e.radius > 0) || !(d > e.radius) || !(height > 0 || (emitter.two_sided && height < 0))) return std::nullopt;
    const Basis b = basis_around(normal);
    return RoundLight{centre, b.tangent * e.radius, b.bitangent * e.radius, std::abs(height) * e.radius * e.radius,
                      false,  1.5708 * e.radius / d};
  }
  template <class Other>
  std::optional<RoundLight> operator()(const Other&) const {
    return std::nullopt;
  }
};

}  // namespace

std::optional<RoundLight> clear_round_light(const Emitter& emitter, const LocalFrame& frame, const Horizons& horizons) {
  const auto light = std::visit(Visitor{emitter, frame}, emitter.shape);
  if (!light) return std::nullopt;
  const Vec3d towards = light->cap ? light->centre : normalised(light->centre);
  const double clear = 2 * light->widest;
  if (!(towards.z > clear) || (horizons.distinct && !(dot(towards, horizons.surface) > clear))) return std::nullopt;
  return light;
}

}  // namespace etendue::eval
