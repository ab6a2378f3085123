// The methods for many points by name, and the lights as they take them.
#include "method_batch.h"

#include "batch_error.h"
#include "views.h"

#include <string>
#include <variant>

namespace etendue::eval {
namespace {

constexpr BatchMethod methods[] = {
    {.name = "frostbite-12",
     .ours = false,
     .note = "solid angle times the mean cosine of five points",
     .rule = BatchRule::structured_sampling,
     .rect = true},
    {.name = "frostbite-e1-mended",
     .ours = false,
     .note = "Lambert's sum, what is below the horizon counts negative",
     .rule = BatchRule::form_factor,
     .rect = true},
    {.name = "frostbite-e2",
     .ours = false,
     .note = "solid angle times the cosine of a representative point",
     .rule = BatchRule::simplified_point,
     .rect = true},
    {.name = "frostbite-light-position",
     .ours = false,
     .note = "solid angle times the centre's cosine",
     .rule = BatchRule::light_position,
     .rect = true},
    {.name = "drobot-point",
     .ours = false,
     .note = "solid angle times the cosine of a representative point",
     .rule = BatchRule::drobot_point,
     .rect = true},
    {.name = "drobot-point-horizon",
     .ours = false,
     .note = "the same with the solid angle above the horizon",
     .rule = BatchRule::drobot_point_horizon,
     .rect = true},
    {.name = "drobot-simplified",
     .ours = false,
     .note = "the point from the plane instead of the light",
     .rule = BatchRule::drobot_simplified,
     .rect = true},
    {.name = "drobot-simplified-horizon",
     .ours = false,
     .note = "the same with the solid angle above the horizon",
     .rule = BatchRule::drobot_simplified_horizon,
     .rect = true},
    {.name = "hill-heitz-acos", .ours = false, .note = "clipped polygon, edges by acos", .rule = BatchRule::hill_acos, .rect = true},
    {.name = "hill-heitz-rational",
     .ours = false,
     .note = "clipped polygon, edges by a cubic rational fit",
     .rule = BatchRule::hill_rational,
     .rect = true},
    {.name = "hill-heitz-quadratic",
     .ours = false,
     .note = "clipped polygon, edges by a quadratic fit",
     .rule = BatchRule::hill_quadratic,
     .rect = true},
    {.name = "hill-heitz-ratio-table",
     .ours = false,
     .note = "the horizon clips a sphere of the same form factor, from a table",
     .rule = BatchRule::hill_ratio_table,
     .rect = true},
    {.name = "hill-heitz-cheap", .ours = false, .note = "the same by (l^2 + F.n) / (l + 1)", .rule = BatchRule::hill_cheap, .rect = true},
    {.name = "frostbite-7-without-horizon",
     .ours = false,
     .note = "as its centre, as long as that is up",
     .rule = BatchRule::patch_without_horizon,
     .sphere = true},
    {.name = "frostbite-7", .ours = false, .note = "tilted patch to sphere", .rule = BatchRule::patch, .sphere = true},
    {.name = "frostbite-8-without-horizon",
     .ours = false,
     .note = "facing disk times the cosine at the light",
     .rule = BatchRule::patch_without_horizon,
     .disk = true},
    {.name = "frostbite-8",
     .ours = false,
     .note = "facing disk over the horizon times the cosine at the light",
     .rule = BatchRule::patch,
     .disk = true},
    {.name = "frostbite-10",
     .ours = false,
     .note = "a cap over the horizon",
     .rule = BatchRule::sphere_or_disk,
     .disk = true,
     .sphere = true},
    {.name = "frostbite-13", .ours = false, .note = "a facing rectangle and a sphere", .rule = BatchRule::capsule, .tube = true},
    {.name = "karis-sphere", .ours = false, .note = "a point of the same intensity", .rule = BatchRule::karis_sphere, .sphere = true},
    {.name = "karis-sphere-9",
     .ours = false,
     .note = "a point that falls off by 1 / (d^2 + 1)",
     .rule = BatchRule::karis_sphere_9,
     .sphere = true},
    {.name = "karis-15-mended",
     .ours = false,
     .note = "a line that emits alike in all directions",
     .rule = BatchRule::karis_line,
     .tube = true},
    {.name = "karis-16", .ours = false, .note = "the same, falling off by 1 / (d^2 + 1)", .rule = BatchRule::karis_line_16, .tube = true},
    {.name = "eden-sphere", .ours = false, .note = "a point closest to the mirrored view", .rule = BatchRule::eden_sphere, .sphere = true},
    {.name = "eden-tube", .ours = false, .note = "a line, falling off twice", .rule = BatchRule::eden_tube, .tube = true},
    {.name = "eden-tube-mended", .ours = false, .note = "a line, falling off once", .rule = BatchRule::karis_line_16, .tube = true},
    {.name = "eden-rect",
     .ours = false,
     .note = "solid angle times the mean cosine of five points",
     .rule = BatchRule::structured_sampling,
     .rect = true},
    {.name = "nodes-1",
     .ours = true,
     .note = "the middle, above the horizon",
     .rule = BatchRule::nodes_1,
     .rect = true,
     .disk = true,
     .sphere = true,
     .tube = true},
    {.name = "nodes-2",
     .ours = true,
     .note = "two places a side, each above the horizon",
     .rule = BatchRule::nodes_2,
     .rect = true,
     .tube = true},
    {.name = "nodes-3",
     .ours = true,
     .note = "three places a side, each above the horizon",
     .rule = BatchRule::nodes_3,
     .rect = true,
     .tube = true},
    {.name = "vector",
     .ours = true,
     .note = "the exact vector of illuminance; what is below the horizon counts negative",
     .rule = BatchRule::vector,
     .disk = true},
    {.name = "edges",
     .ours = true,
     .note = "clipped, edges in the light's frame by a polynomial within 8e-8",
     .rule = BatchRule::edges,
     .rect = true},
};

Vec3f single(const Vec3d& v) { return vec_cast<float>(v); }

}  // namespace

// From the origin; the place in double, as each batch has an origin of its own.
class MethodBatch::Light {
 public:
  std::variant<FlatRect, FlatDisk, Ball, Capsule> shape;
  Vec3d place;
};

namespace {

std::shared_ptr<const MethodBatch::Light> light_of(const BatchMethod& method, const Emitter& emitter) {
  using Light = MethodBatch::Light;
  if (const auto* s = std::get_if<SphereEmitter>(&emitter.shape); s != nullptr && method.sphere)
    return std::make_shared<Light>(Light{Ball{{}, static_cast<float>(s->radius)}, s->centre});
  if (const auto* t = std::get_if<TubeEmitter>(&emitter.shape); t != nullptr && method.tube && t->caps == Caps::round) {
    const Vec3d span = t->b - t->a;
    if (!(length(span) > 0)) return nullptr;
    return std::make_shared<Light>(
        Light{Capsule{{}, single(span), single(normalised(span)), static_cast<float>(length(span)), static_cast<float>(t->radius)}, t->a});
  }
  if (emitter.two_sided) return nullptr;
  if (const auto* d = std::get_if<DiskEmitter>(&emitter.shape); d != nullptr && method.disk)
    return std::make_shared<Light>(Light{FlatDisk{{}, single(d->normal), static_cast<float>(d->radius)}, d->centre});
  if (const auto* polygon = std::get_if<PolygonEmitter>(&emitter.shape); polygon != nullptr && method.rect) {
    const std::optional<RectView> view = rect_view(*polygon, false, {});
    if (!view) return nullptr;
    const FlatRect rect{
        {}, single(view->x), single(view->y), single(view->normal), static_cast<float>(view->half_x), static_cast<float>(view->half_y)};
    return std::make_shared<Light>(Light{rect, view->centre});
  }
  return nullptr;
}

struct Evaluate {
  BatchRule rule;
  Vec3f place;
  const PointBatch& points;
  std::span<float> sr;
  float where_none;
  std::size_t operator()(FlatRect light) const {
    light.centre = place;
    return rect_by(rule, light, points, sr, where_none);
  }
  std::size_t operator()(FlatDisk light) const {
    light.centre = place;
    return disk_by(rule, light, points, sr, where_none);
  }
  std::size_t operator()(Ball light) const {
    light.centre = place;
    return sphere_by(rule, light, points, sr, where_none);
  }
  std::size_t operator()(Capsule light) const {
    light.b += place;
    light.a = place;
    return tube_by(rule, light, points, sr, where_none);
  }
};

}  // namespace

std::span<const BatchMethod> batch_methods() { return methods; }

const BatchMethod* find_batch_method(std::string_view name) {
  const auto found = std::find_if(std::begin(methods), std::end(methods), [&](const BatchMethod& m) { return m.name == name; });
  return found == std::end(methods) ? nullptr : found;
}

Result<MethodBatch> MethodBatch::of(const BatchMethod& method, const Emitter& emitter) {
  std::shared_ptr<const Light> light = light_of(method, emitter);
  if (!light) return Error{"METHOD_SHAPE", std::string(method.name) + " does not take this light", {}, {}, {}};
  return MethodBatch(method.rule, std::move(light));
}

BatchOutcome MethodBatch::projected_solid_angles(const PointBatch& points, std::span<float> values, float where_none) const {
  for (const std::span<const float>& s : {points.px, points.py, points.pz, points.nx, points.ny, points.nz})
    if (s.size() != values.size()) return batch_sizes_differ(s.size(), values.size());
  return std::visit(Evaluate{rule_, single(light_->place - points.origin), points, values, where_none}, light_->shape);
}

}  // namespace etendue::eval
