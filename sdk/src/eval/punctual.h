// Lights without extent as seen from a point: one direction and the illuminance on a plane facing it.
#pragma once

#include "etendue/eval.h"

#include <optional>

namespace etendue::eval {

struct Incident {
  Vec3d towards;  // unit, to the light
  double distance = 0;
  Rgb illuminance;  // lx facing it
};

// Nothing where the point is the light itself.
std::optional<Incident> incident_from(const PunctualEmitter& emitter, const Window& window, const Vec3d& position);

// Share of the axial intensity that a light sends along a unit direction of its own frame (emission along -z).
double angular_falloff(const SpotShape& spot, const Vec3d& local);
double angular_falloff(const FrustumShape& frustum, const Vec3d& local);

}  // namespace etendue::eval
