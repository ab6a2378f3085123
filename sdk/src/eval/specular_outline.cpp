#include "specular_outline.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace etendue::eval {
namespace {

// A line crosses a polygon of r corners that turn inwards at 2 (r + 1) places at most, and is within it between every other two.
std::size_t parts_of(const PolygonEmitter& polygon) {
  const std::vector<Vec3d>& v = polygon.vertices;
  const std::size_t n = v.size();
  std::size_t inwards = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3d before = v[i] - v[(i + n - 1) % n], after = v[(i + 1) % n] - v[i];
    inwards += dot(cross(before, after), polygon.normal) < -1e-12 * length(before) * length(after) ? 1 : 0;
  }
  return std::min(inwards + 1, most_horizon_sides);
}

}  // namespace

std::optional<OutlinedLight> outlined(const Emitter& emitter) {
  OutlinedLight light{{}, emitter.two_sided, false, 0};
  if (const auto* polygon = std::get_if<PolygonEmitter>(&emitter.shape)) {
    if (polygon->vertices.size() < 3) return std::nullopt;
    light.shape = CornersSeen{{polygon->vertices.rbegin(), polygon->vertices.rend()}, polygon->normal, parts_of(*polygon)};
    return light;
  }
  if (const auto* sphere = std::get_if<SphereEmitter>(&emitter.shape); sphere != nullptr && sphere->radius > 0) {
    light.shape = BallSeen{sphere->centre, sphere->radius};
    return light;
  }
  if (const auto* disk = std::get_if<DiskEmitter>(&emitter.shape); disk != nullptr && disk->radius > 0) {
    light.shape = DiskSeen{disk->centre, disk->normal, disk->radius};
    return light;
  }
  if (const auto* tube = std::get_if<TubeEmitter>(&emitter.shape); tube != nullptr && tube->radius > 0) {
    light.shape = TubeSeen{tube->a, tube->b, tube->radius, tube->caps};
    return light;
  }
  if (const auto* sun = std::get_if<DistantEmitter>(&emitter.shape); sun != nullptr && sun->radius_rad > 0 && sun->radius_rad < 0.5 * pi) {
    light.shape = CapSeen{sun->towards, std::cos(sun->radius_rad), std::sin(sun->radius_rad)};
    return light;
  }
  return std::nullopt;
}

OutlinedLight OutlinedLight::seen_from(const Vec3d& origin) const {
  OutlinedLight light = *this;
  if (auto* polygon = std::get_if<CornersSeen>(&light.shape))
    for (Vec3d& corner : polygon->corners) corner = corner - origin;
  if (auto* ball = std::get_if<BallSeen>(&light.shape)) ball->centre = ball->centre - origin;
  if (auto* disk = std::get_if<DiskSeen>(&light.shape)) disk->centre = disk->centre - origin;
  if (auto* tube = std::get_if<TubeSeen>(&light.shape)) tube->a = tube->a - origin, tube->b = tube->b - origin;
  return light;
}

void lay_sides(const OutlinedLight& light, const PlaceBlock& places, std::size_t count, SideBlock& block) {
  if (std::holds_alternative<CornersSeen>(light.shape)) return lay_polygon_sides(light, places, count, block);
  if (std::holds_alternative<BallSeen>(light.shape) || std::holds_alternative<CapSeen>(light.shape))
    return lay_round_sides(light, places, count, block);
  lay_arc_sides(light, places, count, block);
}

}  // namespace etendue::eval
