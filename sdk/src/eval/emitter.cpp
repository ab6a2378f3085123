// From a light as authored to what shines in the world.
#include "etendue/eval.h"
#include "etendue/intensity_web.h"
#include "etendue/photometric_quantities.h"
#include "triangulate.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace etendue::eval {
namespace {

Error unsupported(const Light& light, const std::string& what) {
  return {"EVALUATION_UNSUPPORTED", "light '" + light.name + "': " + what, {light.source, 0, 0, {}}, {}, {}};
}

// Corners of a flat light in its own XY plane, any winding.
PolygonEmitter polygon_of(std::vector<Vec2d> points, const Transform& frame) {
  PolygonEmitter polygon;
  // Counter-clockwise about -Z is clockwise about Z.
  if (signed_area(points) > 0) std::reverse(points.begin(), points.end());
  Vec2d lo{std::numeric_limits<double>::max(), std::numeric_limits<double>::max()}, hi{-lo.x, -lo.y};
  for (const Vec2d& p : points) {
    polygon.vertices.push_back(frame.point({p.x, p.y, 0}));
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
  }
  polygon.normal = -frame.columns[2];
  polygon.uv_frame = {frame.point({hi.x, hi.y, 0}), frame.vector({lo.x - hi.x, 0, 0}), frame.vector({0, lo.y - hi.y, 0})};
  polygon.triangles = triangulate(points);
  return polygon;
}

MeshEmitter mesh_of(const MeshShape& mesh, const EmitterParts& parts, const Transform& frame) {
  const auto& triangles = parts.triangles;
  MeshEmitter emitter;
  if (parts.uvs.size() == triangles.size()) emitter.uvs = parts.uvs;
  emitter.triangles.reserve(triangles.size());
  emitter.running_area.reserve(triangles.size());
  // A mirroring scale swaps the winding; what was the front stays the front.
  const bool mirrored = mesh.scale.x * mesh.scale.y * mesh.scale.z < 0;
  double area = 0;
  if (mirrored) {
    for (auto& uv : emitter.uvs) std::swap(uv[1], uv[2]);
  }
  for (std::array<Vec3d, 3> t : triangles) {
    for (Vec3d& p : t) p = frame.point(p * mesh.scale);
    if (mirrored) std::swap(t[1], t[2]);
    area += 0.5 * length(cross(t[1] - t[0], t[2] - t[0]));
    emitter.triangles.push_back(t);
    emitter.running_area.push_back(area);
  }
  return emitter;
}

Transform inverse_rotation(const Transform& frame) {
  Transform inverse;
  for (int i = 0; i < 3; ++i) {
    inverse.columns[static_cast<std::size_t>(i)] = {frame.columns[0][i], frame.columns[1][i], frame.columns[2][i]};
  }
  return inverse;
}

struct ShapeOf {
  const Light& light;
  const EmitterParts& parts;
  const Rgb& rgb;
  const Transform& frame;

  EmitterShape operator()(const PointShape& s) const { return PunctualEmitter{frame.translation, frame, rgb, s}; }
  EmitterShape operator()(const SpotShape& s) const { return PunctualEmitter{frame.translation, frame, rgb, s}; }
  EmitterShape operator()(const FrustumShape& s) const { return PunctualEmitter{frame.translation, frame, rgb, s}; }
  EmitterShape operator()(const SphereShape& s) const { return SphereEmitter{frame.translation, s.radius}; }
  EmitterShape operator()(const DiskShape& s) const {
    return DiskEmitter{frame.translation, -frame.columns[2], -frame.columns[0], s.radius};
  }
  EmitterShape operator()(const RectShape& s) const {
    const double x = 0.5 * s.width, y = 0.5 * s.height;
    return polygon_of({{-x, -y}, {x, -y}, {x, y}, {-x, y}}, frame);
  }
  EmitterShape operator()(const PolygonShape& s) const { return polygon_of(s.points, frame); }
  EmitterShape operator()(const TubeShape& s) const {
    return TubeEmitter{frame.point({-0.5 * s.length, 0, 0}), frame.point({0.5 * s.length, 0, 0}), s.radius, s.caps};
  }
  EmitterShape operator()(const LineShape& s) const {
    return LineEmitter{frame.point({-0.5 * s.length, 0, 0}), frame.point({0.5 * s.length, 0, 0}), rgb};
  }
  EmitterShape operator()(const MeshShape& s) const { return mesh_of(s, parts, frame); }
  EmitterShape operator()(const EnvironmentShape&) const { return EnvironmentEmitter{parts.environment, inverse_rotation(frame)}; }
  // A disk in the sky is resolved to luminance, a true direction to illuminance on a plane facing it.
  EmitterShape operator()(const DistantShape& s) const {
    const double radius = 0.5 * s.diameter_rad, sine = std::sin(radius);
    return DistantEmitter{frame.columns[2], radius > 0 ? rgb * (pi * sine * sine) : rgb, radius};
  }
  EmitterShape operator()(const PhotometricShape&) const { return EmitterShape{}; }  // profile_of(), which may fail
};

// A stated flux scales what is emitted: `resolved` has it times the luminance of colour and filter, which stand in its rgb as well.
Result<PunctualEmitter> profile_of(const Light& light, const PhotometricShape& shape, const Resolved& resolved, const Transform& frame) {
  if (!shape.distribution) return unsupported(light, "its photometric file was not read");
  Result<IntensityWeb> web = IntensityWeb::of(*shape.distribution);
  if (!web) return web.error();
  ProfileShape profile{std::make_shared<const IntensityWeb>(std::move(*web)), shape.cone};
  double factor = 1;
  if (light.emission.given == Emission::Given::flux) {
    const double own = flux_lm(profile) * luminance_of(resolved.rgb);
    if (!(own > 0) && resolved.flux_lm > 0)
      return unsupported(light, "its photometric file sends no light out and cannot be scaled to a flux");
    factor = own > 0 ? resolved.flux_lm / own : 0;
  }
  return PunctualEmitter{frame.translation, frame, resolved.rgb * factor, std::move(profile)};
}

}  // namespace

double flux_lm(const ProfileShape& profile) {
  if (!profile.cone) return profile.web->flux_lm();
  return flux_through_cone(*profile.web, degrees.of({profile.cone->inner_rad}), degrees.of({profile.cone->outer_rad}));
}

Result<Emitter> emitter_of(const Light& light, const EmitterParts& parts) {
  const auto* sky = std::get_if<EnvironmentShape>(&light.shape);
  if (sky != nullptr && !sky->cube.empty()) return unsupported(light, "environments in the form of a cube cannot be evaluated yet");
  const auto* tube = std::get_if<TubeShape>(&light.shape);
  if (tube != nullptr && tube->caps == Caps::none && light.two_sided) {
    return unsupported(light, "expected caps on a tube that emits on both sides, found none (one would see through it)");
  }
  const Transform frame = light.transform.rigid();
  double mesh_area = 0;
  if (const auto* mesh = std::get_if<MeshShape>(&light.shape)) {
    const MeshEmitter scaled = mesh_of(*mesh, parts, Transform{});
    if (!scaled.running_area.empty()) mesh_area = scaled.running_area.back();
  }
  const Result<Resolved> resolved = resolve(light, mesh_area);
  if (!resolved) return resolved.error();

  Emitter emitter;
  emitter.shape = std::visit(ShapeOf{light, parts, resolved->rgb, frame}, light.shape);
  if (const auto* photometric = std::get_if<PhotometricShape>(&light.shape)) {
    Result<PunctualEmitter> profile = profile_of(light, *photometric, *resolved, frame);
    if (!profile) return profile.error();
    emitter.shape = std::move(*profile);
  }
  emitter.two_sided = light.two_sided;
  emitter.window = {light.falloff, light.range_m.value_or(0)};
  emitter.pattern = parts.pattern;
  if (resolved->kind == Resolved::Kind::luminance) emitter.radiance = resolved->rgb;
  // A map with a stated luminance or illuminance is scaled to have it in the mean over the sphere.
  if (std::holds_alternative<EnvironmentShape>(light.shape) && parts.environment && light.emission.given != Emission::Given::as_file) {
    const double mean = mean_luminance(*parts.environment);
    emitter.radiance = mean > 0 ? emitter.radiance / mean : Rgb{};
  }
  return emitter;
}

}  // namespace etendue::eval
