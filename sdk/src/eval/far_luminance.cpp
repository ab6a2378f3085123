#include "etendue/far_luminance.h"

#include "far_places.h"
#include "gauss_rule.h"
#include "kernels.h"
#include "specular_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace etendue::eval {
namespace {

template <std::size_t... N>
UnitRule rule_of(std::size_t nodes, std::index_sequence<N...>) {
  UnitRule found;
  const auto take = [&](const auto& rule) { found = {rule.x, rule.weight}; };
  ((nodes == N + 1 ? take(gauss<N + 1>()) : void()), ...);
  return found;
}

// A parallelogram of the four vertices in turn.
std::optional<FlatPatch> flat_patch(const Emitter& emitter, const LocalFrame& frame) {
  const auto* polygon = std::get_if<PolygonEmitter>(&emitter.shape);
  if (polygon == nullptr || polygon->vertices.size() != 4) return std::nullopt;
  std::array<Vec3d, 4> v;
  for (std::size_t i = 0; i < 4; ++i) v[i] = frame.point(polygon->vertices[i]);
  const Vec3d half_x = (v[1] - v[0]) * 0.5, half_y = (v[3] - v[0]) * 0.5, centre = (v[0] + v[2]) * 0.5;
  const double skew = length(v[0] + v[2] - v[1] - v[3]);
  if (!(skew <= 1e-9 * (length(half_x) + length(half_y)))) return std::nullopt;
  const double height = -dot(centre, frame.vector(polygon->normal));
  if (!(height > 0 || (emitter.two_sided && height < 0))) return std::nullopt;
  return FlatPatch{centre, half_x, half_y, 4 * std::abs(height) * length(cross(half_x, half_y))};
}

// Within the bound's domain: of lobes GGX alone, of Fresnel's terms those that do not bend inside of what angles there are.
bool takes(const Brdf& brdf) {
  struct {
    static bool smooth(double eta, double k) { return eta >= 1.2 || k >= 1; }
    bool operator()(const Lambert&) const { return true; }
    bool operator()(const Principled& m) const { return m.specular >= 0.25 || m.specular == 0; }
    bool operator()(const Standard&) const { return true; }
    bool operator()(const Conductor& m) const { return smooth(m.eta.x, m.k.x) && smooth(m.eta.y, m.k.y) && smooth(m.eta.z, m.k.z); }
    bool operator()(const MetalRough& m) const { return m.ior >= 1; }
    bool operator()(const DisneyDiffuse&) const { return true; }
    bool operator()(const FrostbiteDiffuse&) const { return true; }
    bool operator()(const GltfDiffuse& m) const { return m.ior >= 1; }
    bool operator()(const OrenNayar&) const { return false; }
    bool operator()(const GotandaDiffuse&) const { return false; }
    bool operator()(const GgxLobe&) const { return true; }
    bool operator()(const TwoColour&) const { return true; }
    bool operator()(const SpecularLobe& m) const { return round_ggx(Brdf{m}).has_value(); }
  } taken;
  return std::visit(taken, brdf);
}

struct Rule {
  FarCounts counts;
  double bound;
};
std::optional<Rule> flat_rule(const FarSeen& seen, double relative) {
  const auto order = [&](double size, double allowed) -> std::size_t {
    for (std::size_t n = 1; n <= most_far_order; ++n)
      if (far_bound_of_side(n, size) <= allowed) return n;
    return 0;
  };
  const FarCounts counts{order(seen.x, 0.5 * relative), order(seen.y, 0.5 * relative)};
  if (counts.x == 0 || counts.y == 0) return std::nullopt;
  return Rule{counts, far_bound_of_side(counts.x, seen.x) + far_bound_of_side(counts.y, seen.y)};
}
std::optional<Rule> round_rule(const FarSeen& seen, double relative) {
  for (std::size_t rings = 0; rings <= most_far_rings; ++rings)
    if (const double bound = far_bound_of_rings(rings, seen.x); bound <= relative) return Rule{{rings, 1}, bound};
  return std::nullopt;
}

}  // namespace

std::optional<Estimate> far_luminance(const Emitter& emitter, const ShadingPoint& point, double relative) {
  if (!takes(point.brdf) || !is_uniform_area_light(emitter)) return std::nullopt;
  const LocalFrame frame(point);
  const Vec3d view = frame.vector(point.view);
  if (!(view.z > 0)) return Estimate{};
  const Horizons horizons = horizons_of(frame, point.normal, point.surface_normal);
  return with_kernel(point.brdf, view, [&](const auto& kernel) -> std::optional<Estimate> {
    const double alpha = kernel.facts().alpha;
    const std::optional<FarSeen> seen = far_seen(emitter, frame, horizons, view, alpha);
    if (!seen || std::max(seen->x, seen->y) > largest_far_size) return std::nullopt;
    const double rounding = far_rounding(alpha, view.z, seen->facing);
    const auto rule = seen->flat ? flat_rule(*seen, relative - rounding) : round_rule(*seen, relative - rounding);
    if (!rule) return std::nullopt;
    Estimate estimate;
    estimate.value = luminance_of(emitter) * over_places(*seen, rule->counts, kernel);
    estimate.error = estimate.value * (rule->bound + rounding);
    estimate.evaluations = seen->flat ? rule->counts.x * rule->counts.y : std::max<std::size_t>(4 * rule->counts.x * rule->counts.x, 1);
    return estimate;
  });
}

UnitRule unit_rule(std::size_t nodes) { return rule_of(nodes, std::make_index_sequence<12>()); }

std::optional<FarSeen> far_seen(const Emitter& emitter, const LocalFrame& frame, const Horizons& horizons, const Vec3d& view,
                                double alpha) {
  FarSeen seen;
  if (seen.flat = flat_patch(emitter, frame); seen.flat) {
    const FlatPatch& patch = *seen.flat;
    const double d = length(patch.centre);
    if (!(d > 0)) return std::nullopt;
    const Vec3d towards = patch.centre / d;
    seen.facing = patch.height_area / (4 * d * length(cross(patch.half_x, patch.half_y)));
    if (!(seen.facing > 0)) return std::nullopt;
    // Its corners are clear of the horizons.
    for (const Vec3d& up : {Vec3d{0, 0, 1}, horizons.surface}) {
      const double reach = std::abs(dot(patch.half_x, up)) + std::abs(dot(patch.half_y, up));
      if (!(dot(patch.centre, up) > reach)) return std::nullopt;
      if (!horizons.distinct) break;
    }
    const double pole = nearest_singularity(towards, view, alpha), x = length(patch.half_x) / d, y = length(patch.half_y) / d;
    if (!(x * x + y * y < pole * pole)) return std::nullopt;
    // Rows lie off the middle by as much as the other half side.
    seen.x = x / std::sqrt(pole * pole - y * y), seen.y = y / std::sqrt(pole * pole - x * x);
    return seen;
  }
  seen.round = clear_round_light(emitter, frame, horizons);
  if (!seen.round) return std::nullopt;
  const Vec3d towards = seen.round->cap ? seen.round->centre : normalised(seen.round->centre);
  if (!seen.round->cap) seen.facing = seen.round->weight / (length(seen.round->centre) * dot(seen.round->u, seen.round->u));
  seen.x = seen.round->widest / nearest_singularity(towards, view, alpha);
  if (!(seen.x < 1)) return std::nullopt;
  return seen;
}

}  // namespace etendue::eval
