// A look through one point of the picture: what is there, and which punctual lights reach it. Two probes are "the same" if nothing
// discontinuous lies between them as far as they can tell.
#pragma once

#include "camera.h"
#include "stage.h"

namespace etendue::rendering {

inline constexpr std::uint64_t nothing_key = 1;
struct Probe {
  std::uint64_t key = 0;  // nothing_key, or made of thing, part of it, side, and for every light: its state if punctual, its side if flat
  std::optional<SurfacePoint> point;
};

bool same(const Probe& a, const Probe& b);

struct RayCounts {
  std::uint64_t primary = 0, shadow = 0, evaluations = 0;
  RayCounts& operator+=(const RayCounts& o) { return primary += o.primary, shadow += o.shadow, evaluations += o.evaluations, *this; }
};

class Prober {
 public:
  Prober(const Stage& stage, const PinholeCamera& camera) : stage_(stage), camera_(camera) {}
  Probe look(double x, double y, RayCounts& counts) const;

 private:
  const Stage& stage_;
  const PinholeCamera& camera_;
};

// A flat light's plane cuts the picture: 1 on the side where its light is, 0 where there is none, with a kink between. A surface in that
// very plane is on one side of it; other lights have none: 0.
std::uint64_t side_of_plane(const StageLight& light, const Vec3d& position);

// What a punctual light or a true direction sends to a point that sees it: direction, distance and lux facing it; pdf 0 where nothing.
eval::LightSample delta_light(const StageLight& light, const Vec3d& position);

}  // namespace etendue::rendering
