#include "probe.h"
#include "hashing.h"

#include <cmath>

namespace etendue::rendering {
namespace {

// A step from one to the other must run along the surface, and the surface must not turn away meanwhile; two flat faces must be of one
// plane.
bool continuous(const SurfacePoint& a, const SurfacePoint& b) {
  const Vec3d step = b.position - a.position;
  if (a.flat && b.flat) return dot(a.normal, b.normal) > 1 - 1e-6 && std::abs(dot(step, a.geometric_normal)) <= 1e-3 * length(step);
  constexpr double most_rise = 0.7, least_cosine = 0.5;
  const double rise = most_rise * length(step);
  return std::abs(dot(step, a.geometric_normal)) <= rise && std::abs(dot(step, b.geometric_normal)) <= rise &&
         dot(a.normal, b.normal) >= least_cosine;
}

// 0: dark, 1: lit, 2: lit within the inner cone of a spot (the falloff has a kink there).
std::uint64_t state_of(const StageLight& light, const Stage& stage, const SurfacePoint& point, double side, RayCounts& counts) {
  const eval::LightSample sample = delta_light(light, point.position);
  if (sample.pdf <= 0 || sample.radiance == Rgb{}) return 0;
  if (side * dot(point.normal, sample.direction) <= 0) return 0;
  ++counts.shadow;
  if (stage.blocked(point, sample.direction, sample.distance, light.thing)) return 0;
  if (const auto* punctual = std::get_if<eval::PunctualEmitter>(&light.emitter.shape)) {
    if (const auto* spot = std::get_if<SpotShape>(&punctual->shape)) {
      return dot(punctual->frame.columns[2], sample.direction) > std::cos(spot->inner_rad) ? 2 : 1;
    }
  }
  return 1;
}

// The edge of a sun's disk is the only discontinuity of a background.
bool sun_is_at(const StageLight& light, const Ray& ray) {
  return light.background && std::holds_alternative<eval::DistantEmitter>(light.emitter.shape) &&
         !(eval::light_along(light.as_seen, ray.origin, ray.direction).radiance == Rgb{});
}

}  // namespace

bool same(const Probe& a, const Probe& b) {
  if (a.key != b.key) return false;
  return !a.point || !b.point || continuous(*a.point, *b.point);
}

Probe Prober::look(double x, double y, RayCounts& counts) const {
  const Ray ray = camera_.through(x, y);
  ++counts.primary;
  Probe probe{nothing_key, stage_.first(ray)};
  if (!probe.point) {
    for (const StageLight& light : stage_.lights()) {
      if (sun_is_at(light, ray)) probe.key = mixed(probe.key ^ light.index);
    }
    return probe;
  }
  const SurfacePoint& point = *probe.point;
  const double side = dot(point.normal, ray.direction) < 0 ? 1 : -1;
  probe.key = mixed(mixed(point.thing + 2) ^ point.part);
  probe.key = mixed(probe.key ^ (side > 0 ? 1u : 0u));
  const Paint* paint = stage_.thing(point.thing).paint;
  if (paint == nullptr || (side < 0 && !paint->material.double_sided)) return probe;
  for (const StageLight& light : stage_.lights()) {
    const std::uint64_t state = light.delta ? state_of(light, stage_, point, side, counts) : side_of_plane(light, point.position);
    probe.key = mixed(probe.key ^ state);
  }
  return probe;
}

std::uint64_t side_of_plane(const StageLight& light, const Vec3d& position) {
  const auto side = [&](const Vec3d& origin, const Vec3d& normal) -> std::uint64_t {
    const Vec3d to = position - origin;
    return dot(to, normal) > 1e-6 * length(to) ? 1 : 0;
  };
  if (const auto* disk = std::get_if<eval::DiskEmitter>(&light.emitter.shape)) return side(disk->centre, disk->normal);
  const auto* polygon = std::get_if<eval::PolygonEmitter>(&light.emitter.shape);
  return polygon != nullptr && !polygon->vertices.empty() ? side(polygon->vertices.front(), polygon->normal) : 0;
}

eval::LightSample delta_light(const StageLight& light, const Vec3d& position) {
  return eval::sample_light(light.emitter, position, {0.5, 0.5});
}

}  // namespace etendue::rendering
