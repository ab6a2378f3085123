#include "stage.h"
#include "emitters.h"
#include "etendue/unshown.h"

#include <algorithm>
#include <cmath>

namespace etendue::rendering {
namespace {

constexpr int most_holes_along_a_ray = 256;
constexpr std::size_t most_triangles_summed = 200;  // of a mesh light; a larger one is sampled

std::optional<Shape> visible_shape(const eval::EmitterShape& shape) {
  return std::visit(
      [](const auto& s) -> std::optional<Shape> {
        if constexpr (std::is_constructible_v<Shape, decltype(s)>)
          return Shape(s);
        else
          return std::nullopt;
      },
      shape);
}

bool is_delta(const eval::EmitterShape& shape) {
  if (const auto* distant = std::get_if<eval::DistantEmitter>(&shape)) return distant->radius_rad == 0;
  return std::holds_alternative<eval::PunctualEmitter>(shape);
}

bool is_analytic(const eval::Emitter& emitter) {
  if (emitter.pattern && !is_delta(emitter.shape)) return false;
  if (const auto* mesh = std::get_if<eval::MeshEmitter>(&emitter.shape)) return mesh->triangles.size() <= most_triangles_summed;
  return !std::holds_alternative<eval::EnvironmentEmitter>(emitter.shape);
}

double largest_coordinate(const Bounds& bounds) {
  double most = 0;
  for (int i = 0; i < 3; ++i) most = std::max({most, std::abs(bounds.min[i]), std::abs(bounds.max[i])});
  return most;
}

std::string unused_layer(const std::vector<StageLight>& lights, const std::string& name) {
  const std::string base = "light." + layer_safe(name);
  std::string layer = base;
  for (int n = 2; std::any_of(lights.begin(), lights.end(), [&](const StageLight& l) { return l.layer == layer; }); ++n) {
    layer = base + "_" + std::to_string(n);
  }
  return layer;
}

}  // namespace

Result<std::unique_ptr<Stage>> Stage::build(const Scene& scene, const RenderOptions& options, Diagnostics& diagnostics) {
  std::unique_ptr<Stage> stage(new Stage);
  if (Status done = stage->add_objects(scene, options); !done) return done.error();
  if (Status done = stage->add_lights(scene, options); !done) return done.error();
  if (Status done = stage->rays_.commit(); !done) return done.error();
  // Embree's vertices and origins are floats: half a unit in the last place of the largest coordinate, a few times over.
  const Bounds bounds = bounds_of(scene);
  stage->offset_ = 5e-7 * (bounds.empty() ? 1.0 : std::max(largest_coordinate(bounds), 1e-3));
  stage->mitsuba_rays_ = options.mitsuba_model;
  for (const NamedPaint& known : stage->paints_) {
    const Material& material = known.paint.material;
    for (const Loss& loss : unshown_losses(material))
      diagnostics.warning("NOT_SHOWN", "material '" + material.name + "': " + loss.what + ": " + loss.effect,
                          {scene.file, 0, 0, material.source});
  }
  if (stage->lights_.empty()) diagnostics.warning("NO_LIGHT", "no light of the scene emits: the picture is black", {scene.file, 0, 0, {}});
  return stage;
}

Thing& Stage::add_thing() {
  things_.emplace_back();
  return things_.back();
}

Result<const DecodedImage*> Stage::image(const Scene& scene, const Texture& texture) {
  for (const Image& known : images_) {
    if (known.index == texture.image && known.encoding == texture.encoding) return known.pixels.get();
  }
  Result<DecodedImage> decoded = decode(scene.images[texture.image], texture.encoding);
  if (!decoded) return decoded.error();
  images_.push_back({texture.image, texture.encoding, std::make_unique<DecodedImage>(std::move(*decoded))});
  return images_.back().pixels.get();
}

Result<const Paint*> Stage::paint(const Scene& scene, std::uint32_t material, const RenderOptions& options) {
  for (const NamedPaint& known : paints_) {
    if (known.material == material) return &known.paint;
  }
  Paint paint;
  if (material != no_index) {
    const Material& authored = scene.materials[material];
    paint.material = options.mitsuba_model ? mitsuba_twin(authored, options.mitsuba_parts) : authored;
  }
  const auto want = [&](const std::optional<Texture>& texture, const DecodedImage*& pixels) -> Status {
    if (!texture) return Done{};
    const Result<const DecodedImage*> decoded = image(scene, *texture);
    if (!decoded) return decoded.error();
    pixels = *decoded;
    return Done{};
  };
  if (Status done = want(paint.material.base_colour_texture, paint.base_colour); !done) return done.error();
  const bool rough_matters =
      !std::holds_alternative<Lambert>(paint.material.model) && !std::holds_alternative<Conductor>(paint.material.model);
  if (rough_matters) {
    if (Status done = want(paint.material.metal_rough_texture, paint.metal_rough); !done) return done.error();
    if (Status done = want(paint.material.specular_gloss_texture, paint.specular_gloss); !done) return done.error();
  }
  if (paint.material.normal_map) {
    if (Status done = want(paint.material.normal_map->texture, paint.normal); !done) return done.error();
  }
  paint.coarse_holes = options.mitsuba_model;
  holes_ = holes_ || paint.has_holes();
  paints_.push_back({material, std::move(paint)});
  return &paints_.back().paint;
}

Status Stage::add_objects(const Scene& scene, const RenderOptions& options) {
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    const Result<const Paint*> looks = paint(scene, object.material, options);
    if (!looks) return looks.error();
    Thing& thing = add_thing();
    thing.object = i;
    thing.paint = *looks;
    thing.convex = !std::holds_alternative<MeshGeometry>(object.geometry);
    const auto* sphere = std::get_if<SphereGeometry>(&object.geometry);
    // Mitsuba's sphere has other texture coordinates than ours: a textured one is exported as triangles, and is the same triangles here.
    if (sphere != nullptr && !thing.paint->textured()) {
      const auto& columns = object.transform.columns;
      thing.shape = eval::SphereEmitter{object.transform.translation, sphere->radius * length(columns[0])};
      thing.shape_frame = {{normalised(columns[0]), normalised(columns[1]), normalised(columns[2])}, {}};
      rays_.add(*thing.shape);
    } else {
      thing.mesh = to_world(tessellated(object.geometry, scene.meshes), object.transform, false);
      rays_.add(thing.mesh.triangles);
    }
  }
  return Done{};
}

Status Stage::add_lights(const Scene& scene, const RenderOptions& options) {
  std::vector<bool> lit(scene.lights.size(), options.lit.empty());
  for (const std::uint32_t i : options.lit) {
    if (i >= scene.lights.size()) {
      return Error{
          "SCENE_INVALID", "light " + std::to_string(i) + " was asked for, there are " + std::to_string(scene.lights.size()), {}, {}, {}};
    }
    lit[i] = true;
  }
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i) {
    if (Status done = add_light(scene, i, lit[i], options); !done) return done;
  }
  return Done{};
}

Result<PicturedEmitter> Stage::emitter(const Scene& scene, const Light& light, bool with_picture) {
  const auto texture_of = [&](const Texture& texture) -> Result<std::shared_ptr<const DecodedImage>> {
    const Result<const DecodedImage*> decoded = image(scene, texture);
    if (!decoded) return decoded.error();
    return std::shared_ptr<const DecodedImage>(std::shared_ptr<const DecodedImage>{}, *decoded);  // the stage owns it
  };
  return emitter_in(scene, light, texture_of, with_picture);
}

Status Stage::add_light(const Scene& scene, std::uint32_t index, bool lit, const RenderOptions& options) {
  const Light& light = scene.lights[index];
  Result<PicturedEmitter> made = emitter(scene, light, lit);
  if (!made) return made.error();
  StageLight staged;
  staged.index = index;
  staged.emitter = std::move(made->emitter);
  staged.picture = std::move(made->picture);
  if (options.mitsuba_model && options.mitsuba_parts == MitsubaParts::built_in) staged.emitter.window = {};
  staged.as_seen = staged.emitter;
  staged.as_seen.window = {};
  staged.delta = is_delta(staged.emitter.shape);
  staged.analytic = staged.picture != nullptr || is_analytic(staged.emitter);
  const auto* distant = std::get_if<eval::DistantEmitter>(&staged.emitter.shape);
  staged.background = std::holds_alternative<eval::EnvironmentEmitter>(staged.emitter.shape) || (distant != nullptr && !staged.delta);
  const auto* mesh = std::get_if<MeshShape>(&light.shape);
  staged.convex = mesh == nullptr;
  const std::optional<Shape> shape = visible_shape(staged.emitter.shape);
  if (shape) {
    const Box box = box_of(*shape);
    staged.extent = Ball{(box.min + box.max) * 0.5, 0.5 * length(box.max - box.min)};
  }
  // Mitsuba has no invisible area lights.
  if ((light.visible || options.mitsuba_model) && (shape || mesh != nullptr)) {
    staged.thing = static_cast<std::uint32_t>(things_.size());
    Thing& thing = add_thing();
    thing.light = index;
    if (light.surface_material) {
      const Result<const Paint*> looks = paint(scene, *light.surface_material, options);
      if (!looks) return looks.error();
      thing.paint = *looks;
    }
    if (shape) {
      thing.shape = shape;
      rays_.add(*thing.shape);
    } else {
      Transform scale;
      scale.columns = {Vec3d{mesh->scale.x, 0, 0}, Vec3d{0, mesh->scale.y, 0}, Vec3d{0, 0, mesh->scale.z}};
      thing.mesh = to_world(scene.meshes[mesh->mesh], light.transform * scale, thing.paint == nullptr || options.mitsuba_model);
      rays_.add(thing.mesh.triangles);
    }
  }
  if (!lit) return Done{};
  staged.layer = unused_layer(lights_, light.name);
  lights_.push_back(std::move(staged));
  return Done{};
}

std::optional<SurfacePoint> Stage::first(const Ray& ray) const {
  double from = 0;
  for (int i = 0; i < most_holes_along_a_ray; ++i) {
    const Hit hit = rays_.closest(ray, from, infinite);
    if (!hit.something()) return std::nullopt;
    const Thing& met = things_[hit.thing];
    const SurfacePoint point = surface_point(met, ray, hit);
    if (!holes_ || met.paint == nullptr || !is_hole(*met.paint, point.uv)) return point;
    from = hit.t + offset_;
  }
  return std::nullopt;
}

// Mitsuba's shadow rays (Interaction::offset_p, spawn_ray_to) start RayEpsilon = 1500 x 2^-24 times 1 + |p|_inf above the surface, in the
// scene's unit, and end ten RayEpsilon of their length before the light: in a scene of centimetres its shadows are visibly short.
Ray Stage::shadow_ray(const SurfacePoint& from, const Vec3d& direction, double& distance) const {
  const double side = dot(from.geometric_normal, direction) < 0 ? -1 : 1;
  if (!mitsuba_rays_) {
    distance *= 1 - 1e-4;
    return {from.position + from.geometric_normal * (side * offset_), direction};
  }
  constexpr double epsilon = 1500.0 / (1 << 24);
  const Vec3d& p = from.position;
  const double above = epsilon * (1 + std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}));
  const Vec3d origin = p + from.geometric_normal * (side * above);
  if (!std::isfinite(distance)) return {origin, direction};
  const Vec3d to_light = p + direction * distance - origin;
  distance = length(to_light) * (1 - 10 * epsilon);
  return {origin, normalised(to_light)};
}

bool Stage::blocked(const SurfacePoint& from, const Vec3d& direction, double distance, std::uint32_t skip) const {
  // A ray ends a little before the light, whose own triangles are not in the way.
  double end = distance;
  const Ray ray = shadow_ray(from, direction, end);
  if (!holes_) return rays_.blocked(ray, 0, end, skip);
  double begin = 0;
  for (int i = 0; i < most_holes_along_a_ray; ++i) {
    const Hit hit = rays_.closest(ray, begin, end, skip);
    if (!hit.something()) return false;
    const Thing& met = things_[hit.thing];
    if (met.paint == nullptr || !is_hole(*met.paint, surface_point(met, ray, hit).uv)) return true;
    begin = hit.t + offset_;
  }
  return true;
}

bool Stage::can_be_blocked(const StageLight& light) const {
  std::size_t others = 0;
  bool convex = light.convex;
  for (std::uint32_t i = 0; i < things_.size(); ++i) {
    if (i == light.thing) continue;
    ++others;
    convex = convex && things_[i].convex;
  }
  // One convex thing is above no horizon of its own front.
  return others > 1 || !convex;
}

}  // namespace etendue::rendering
