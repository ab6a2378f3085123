// What one light sends towards the eye: from its own surface, reflected without anything in between, and what shadows take away from that.
#pragma once

#include "probe.h"

#include "etendue/light_within.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace etendue::rendering {

inline Rgb squared(const Rgb& c) { return c * c; }
inline double largest(const Rgb& c) { return std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)}); }

// Independent estimates that a variance is computed from, and points in each.
struct Effort {
  int replicates, points;
};

struct Deviating {
  Rgb mean, variance;  // of the mean
};

// A pixel's reflected light by samples, with and without shadows; the two estimates of it are derived in sdk/docs/rendering.md.
struct Sampled {
  struct Sums {
    Rgb visible, all;
  };
  std::vector<Sums> replicates;  // of each the samples' sum over its points
  int points = 0;

  Sums total() const;
  // Of the shadowed light less beta times the unblocked.
  Deviating difference(double beta) const;
  // Of the shadowed light over the unblocked, channel by channel; where there is none of that, `otherwise`.
  Deviating ratio(double otherwise) const;
};

// Reflected light with nothing in between, and what is told of its error (in the channel where that is largest).
struct Reflected {
  Rgb value;
  double bound = 0;
};

// Reflected light as a function of the surface's base colour, which it is affine in: all of it in `black` where no texture changes that.
struct Response {
  Rgb black, slope;
  double bound = 0;
};

// A surface as it is seen.
struct SeenPoint {
  SurfacePoint point;
  Vec3d view;
  std::optional<Rgb> base_colour = std::nullopt;  // instead of the paint's
};

// Where the samples of a pixel lie: over its area, or on one plane that fills it.
struct PixelTarget {
  std::uint32_t x = 0, y = 0;
  const SurfacePoint* plane = nullptr;  // set: a flat, untextured surface fills the whole pixel
};

class Lighting {
 public:
  Lighting(const Stage& stage, const PinholeCamera& camera) : stage_(stage), camera_(camera) {}

  // Luminance of the light's own surface, or of the environment behind everything.
  Rgb emitted(const StageLight& light, const std::optional<SurfacePoint>& point, const Ray& ray) const;
  // As many as points. Of a punctual light, with its shadow; of others by the plan. Only for analytic and delta lights.
  std::vector<Reflected> reflected(const StageLight& light, std::span<const SeenPoint> points, const eval::LightPlan& plan,
                                   RayCounts& counts) const;
  std::vector<Response> responses(const StageLight& light, std::span<const SeenPoint> points, const eval::LightPlan& plan,
                                  RayCounts& counts) const;
  // Over pixel and light.
  Sampled sample(const StageLight& light, const PixelTarget& target, const Effort& effort, std::uint64_t seed, RayCounts& counts) const;

 private:
  Reflected from_direction(const StageLight& light, const SeenPoint& seen, const eval::ShadingPoint& shading, RayCounts& counts) const;
  std::optional<SurfacePoint> target_point(const PixelTarget& target, const Ray& ray, RayCounts& counts) const;

  const Stage& stage_;
  const PinholeCamera& camera_;
};

}  // namespace etendue::rendering
