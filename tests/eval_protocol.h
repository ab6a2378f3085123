// Random lights and points for tests of the evaluation: one shading point in a box of 4 m, the light around it, sizes log-uniform.
#pragma once

#include <utility>

#include "../sdk/src/eval/light_protocol.h"

namespace etendue::eval::protocol {

// A light of one luminance in all channels, and its illuminance.
inline Emitter white(EmitterShape shape, double luminance = 1) {
  Emitter e;
  e.shape = std::move(shape);
  e.radiance = {luminance, luminance, luminance};
  return e;
}
inline double lux_at(const Emitter& e, const Vec3d& p, const Vec3d& n) { return illuminance(e, p, n).x; }

struct Placement {
  Emitter emitter;
  Vec3d position, normal;
  Vec3d towards;  // to the light's centre
};

// `above`: the whole light above the horizon; else it spans both sides of it.
inline Placement place(Kind kind, Random& random, bool above) {
  for (;;) {
    Placement p;
    p.position = {random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)};
    p.normal = random.direction();
    p.towards = random.direction();
    p.emitter.shape = random_shape(kind, p.position, p.towards, random);
    p.emitter.radiance = {1, 1, 1};
    const double low = lowest(p.emitter.shape, p.position, p.normal), high = -lowest(p.emitter.shape, p.position, -p.normal);
    if (above ? low >= 1e-3 : (low < 0 && high > 0)) {
      if (illuminance(p.emitter, p.position, p.normal).x >= 1e-3) return p;
    }
  }
}

// Of scale_bias down to ranges at which it is a million times brighter than the light without it; of Karis' some without a range.
inline Window random_window(Random& random, double range_m) {
  switch (static_cast<int>(random.uniform(0, 7))) {
    case 0:
      return {Falloff::frostbite, range_m};
    case 1:
      return {Falloff::gltf, range_m};
    case 2:
      return {Falloff::linear, range_m};
    case 3:
      return {{random.uniform(0, 1) < 0.5 ? Falloff::Law::power : Falloff::Law::power_squared, random.log_uniform(1, 64)}, range_m};
    case 4:
      return {Falloff::smoothstep, range_m};
    case 5:
      return {Falloff::scale_bias, std::max(range_m, 1 + 1e-6)};
    default:
      return {Falloff::karis, random.uniform(0, 1) < 0.3 ? 0 : range_m};
  }
}

}  // namespace etendue::eval::protocol
