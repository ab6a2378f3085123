#include "punctual.h"

#include "etendue/intensity_web.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace etendue::eval {

// Linear in the cosine between the cones, squared (Lagarde and de Rousiers 2014, listing 4; KHR_lights_punctual).
double angular_falloff(const SpotShape& spot, const Vec3d& local) {
  const double cosine = -local.z, inner = std::cos(spot.inner_rad), outer = std::cos(spot.outer_rad);
  if (cosine >= inner) return 1;
  if (cosine <= outer) return 0;
  const double x = (cosine - outer) / (inner - outer);
  return x * x;
}

double angular_falloff(const FrustumShape& frustum, const Vec3d& local) {
  const double depth = -local.z;
  if (!(depth > 0)) return 0;
  const bool inside =
      std::abs(local.x) <= depth * std::tan(0.5 * frustum.width_rad) && std::abs(local.y) <= depth * std::tan(0.5 * frustum.height_rad);
  return inside ? 1 : 0;
}

std::optional<Incident> incident_from(const PunctualEmitter& emitter, const Window& window, const Vec3d& position) {
  const Vec3d to_light = emitter.position - position;
  const double distance = length(to_light);
  // Nearer than this the inverse square leaves the range of double.
  if (!(distance > 1e-140)) return std::nullopt;
  const Vec3d towards = to_light / distance;
  const auto& axes = emitter.frame.columns;
  const Vec3d local{-dot(axes[0], towards), -dot(axes[1], towards), -dot(axes[2], towards)};
  struct Share {
    const Vec3d& local;
    double operator()(const PointShape&) const { return 1; }
    double operator()(const SpotShape& s) const { return angular_falloff(s, local); }
    double operator()(const FrustumShape& f) const { return angular_falloff(f, local); }
    double operator()(const ProfileShape& p) const {
      const double passed = p.cone ? angular_falloff(*p.cone, local) : 1;
      return passed > 0 ? passed * p.web->towards(local) : 0;
    }
  };
  const double share = std::visit(Share{local}, emitter.shape);
  return Incident{towards, distance, emitter.intensity * (share * window_at(window, distance) / (distance * distance))};
}

}  // namespace etendue::eval
