// What a distance window takes from the light of an extended emitter, in closed form: E of the window is E without it less this.
//
// Both windows are functions of the fourth power of the distance, and the form factor has n.y (m.y) / |y|^4: within the range what they
// take is the integral of a polynomial over the emitter, beyond it is all of the light there. Derivation: sdk/docs/area-lights.md.
#pragma once

#include "local.h"

#include <optional>

namespace etendue::eval {

// Lengths in units of the range.
class Taken {
 public:
  explicit Taken(Falloff falloff) : squared_(falloff == Falloff::frostbite) {}
  // (1 - w) / d^4 within the range: 1, and 2 - d^4 of the squared window.
  double per_fourth(double d2) const { return squared_ ? 2 - d2 * d2 : 1; }
  // 1 - w.
  double at(double d2) const { return d2 < 1 ? d2 * d2 * per_fourth(d2) : 1; }

 private:
  bool squared_;
};

struct WindowLoss {
  double value = 0;  // sr; of a line 1/m2
  bool all = false;  // the whole light is beyond the range
};

// For a luminance of 1 cd/m2, or of lines an intensity of 1 cd. `emitter` has a window. Nothing where there is no closed form: from inside
// of what emits on both sides, and of round lights with two horizons.
std::optional<WindowLoss> window_loss(const Emitter& emitter, const LocalFrame& frame, const Horizons& horizons);

// Above the horizon of z: a sphere seen from outside; with `outwards` that half of it, the cap of a tube.
double ball_loss(const Vec3d& centre, double radius, const Taken& taken, const std::optional<Vec3d>& outwards);
// The side of a tube from a to b.
double tube_side_loss(const Vec3d& a, const Vec3d& b, double radius, const Taken& taken);

}  // namespace etendue::eval
