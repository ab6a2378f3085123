#include "surface.h"

#include "etendue/textured_surface.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace etendue::rendering {
namespace {

template <class T>
T interpolated(const std::vector<T>& values, const std::array<std::uint32_t, 3>& corner, double u, double v) {
  return values[corner[0]] * (1 - u - v) + values[corner[1]] * u + values[corner[2]] * v;
}

// Solves p_b - p_a = du1 dp/du + dv1 dp/dv and the same for c; without usable texture coordinates there is no tangent.
Vec3d tangent_of(const Vec3d& e1, const Vec3d& e2, Vec2d a, Vec2d b, Vec2d c) {
  const double du1 = b.x - a.x, dv1 = b.y - a.y, du2 = c.x - a.x, dv2 = c.y - a.y;
  const double determinant = du1 * dv2 - dv1 * du2;
  if (determinant == 0) return {};
  return (e1 * dv2 - e2 * dv1) / determinant;
}

void fill_from_mesh(const WorldMesh& mesh, const Hit& hit, SurfacePoint& out) {
  const auto& corner = mesh.triangles.corners[hit.triangle];
  const auto& positions = mesh.triangles.positions;
  const Vec3d a = positions[corner[0]];
  const Vec3d e1 = positions[corner[1]] - a, e2 = positions[corner[2]] - a;
  out.geometric_normal = normalised(cross(e1, e2));
  out.normal = out.geometric_normal;
  out.flat = true;
  if (!mesh.normals.empty()) {
    const Vec3d smooth = normalised(interpolated(mesh.normals, corner, hit.u, hit.v));
    if (dot(smooth, smooth) > 0) out.normal = smooth;
    for (const std::uint32_t i : corner) out.flat = out.flat && dot(mesh.normals[i], out.geometric_normal) > 1 - 1e-12;
  }
  if (!mesh.uvs.empty()) {
    const Vec2d ua = mesh.uvs[corner[0]], ub = mesh.uvs[corner[1]], uc = mesh.uvs[corner[2]];
    const double w = 1 - hit.u - hit.v;
    out.uv = {ua.x * w + ub.x * hit.u + uc.x * hit.v, ua.y * w + ub.y * hit.u + uc.y * hit.v};
    out.tangent = tangent_of(e1, e2, ua, ub, uc);
  }
  out.part = mesh.group[hit.triangle];
}

// u turns from +Z to +X around +Y, v falls from +Y, as in a tessellated sphere.
void fill_from_shape(const Thing& thing, SurfacePoint& out) {
  out.geometric_normal = out.normal = normal_at(*thing.shape, out.position);
  out.flat = !std::holds_alternative<eval::SphereEmitter>(*thing.shape) && !std::holds_alternative<eval::TubeEmitter>(*thing.shape);
  if (!thing.object) return;
  const auto& frame = thing.shape_frame.columns;
  const Vec3d n{dot(frame[0], out.normal), dot(frame[1], out.normal), dot(frame[2], out.normal)};
  const double azimuth = std::atan2(n.x, n.z);
  out.uv = {(azimuth < 0 ? azimuth + 2 * pi : azimuth) / (2 * pi), std::acos(std::clamp(n.y, -1.0, 1.0)) / pi};
  out.tangent = thing.shape_frame.vector({n.z, 0, -n.x});
}

void set_base_colour(SurfaceModel& model, const Rgb& colour) {
  std::visit(
      [&colour](auto& m) {
        if constexpr (requires { m.base_colour; })
          m.base_colour = colour;
        else if constexpr (requires { m.diffuse; })
          m.diffuse = colour;
      },
      model);
}

// As eval.h evaluates it: specular-glossiness by its two colours.
eval::Brdf brdf_of(const SurfaceModel& model) {
  return std::visit(
      [](const auto& m) -> eval::Brdf {
        if constexpr (std::is_same_v<std::decay_t<decltype(m)>, SpecularGlossiness>)
          return two_colour_of(m);
        else
          return m;
      },
      model);
}

eval::Brdf brdf_at(const Paint& paint, Vec2d uv, const std::optional<Rgb>& base_colour) {
  SurfaceTexels texels;
  if (paint.base_colour != nullptr) {
    const Rgba texel = sample(*paint.base_colour, *paint.material.base_colour_texture, uv);
    texels.base_colour = {texel.r, texel.g, texel.b};
  }
  if (paint.metal_rough != nullptr) {
    const Rgba texel = sample(*paint.metal_rough, *paint.material.metal_rough_texture, uv);
    texels.metallic = texel.b, texels.roughness = texel.g;
  }
  if (paint.specular_gloss != nullptr) {
    const Rgba texel = sample(*paint.specular_gloss, *paint.material.specular_gloss_texture, uv);
    texels.specular = {texel.r, texel.g, texel.b}, texels.glossiness = texel.a;
  }
  SurfaceModel model = textured(paint.material.model, texels);
  if (base_colour) set_base_colour(model, *base_colour);
  return brdf_of(model);
}

// The normal map's vector in the frame (s, t, n): s is the tangent made perpendicular to the interpolated normal, t = n x s. On the back of
// a surface the frame is mirrored in its plane, as Mitsuba's `twosided` does: s and t stay.
Vec3d perturbed(const Paint& paint, const SurfacePoint& point, double side) {
  const Rgba texel = sample(*paint.normal, paint.material.normal_map->texture, point.uv);
  const double scale = paint.material.normal_map->scale;
  const Vec3d local = normalised(Vec3d{(2 * texel.r - 1) * scale, (2 * texel.g - 1) * scale, 2 * texel.b - 1});
  const Vec3d s = normalised(point.tangent - point.normal * dot(point.normal, point.tangent));
  if (dot(s, s) == 0 || dot(local, local) == 0) return point.normal * side;
  return normalised(s * local.x + cross(point.normal, s) * local.y + point.normal * (side * local.z));
}

}  // namespace

bool Paint::coloured() const {
  if (base_colour == nullptr || metal_rough != nullptr || specular_gloss != nullptr || normal != nullptr || has_holes()) return false;
  // Frostbite's f90 = min(1, 49.5 mean f0) bends where a metal's colour is nearly black.
  const auto* standard = std::get_if<Standard>(&material.model);
  return standard == nullptr || standard->metal == 0 ||
         49.5 * 0.16 * standard->reflectance * standard->reflectance * (1 - standard->metal) >= 1;
}

SurfacePoint surface_point(const Thing& thing, const Ray& ray, const Hit& hit) {
  SurfacePoint out;
  out.thing = hit.thing;
  out.distance = hit.t;
  out.position = ray.origin + ray.direction * hit.t;
  if (thing.shape) {
    fill_from_shape(thing, out);
  } else {
    fill_from_mesh(thing.mesh, hit, out);
  }
  return out;
}

bool is_hole(const Paint& paint, Vec2d uv) {
  if (!paint.has_holes()) return false;
  double alpha = paint.material.base_alpha;
  if (paint.base_colour != nullptr) {
    const Texture& texture = *paint.material.base_colour_texture;
    alpha *= (paint.coarse_holes ? sample_cell(*paint.base_colour, texture, uv) : sample(*paint.base_colour, texture, uv)).a;
  }
  return alpha < *paint.material.alpha_cutoff;
}

Rgb base_colour_at(const Paint& paint, Vec2d uv) {
  const Rgb factor = std::visit(
      [](const auto& m) {
        if constexpr (requires { m.base_colour; })
          return m.base_colour;
        else if constexpr (requires { m.diffuse; })
          return m.diffuse;
        else
          return Rgb{1, 1, 1};
      },
      paint.material.model);
  if (paint.base_colour == nullptr) return factor;
  const Rgba texel = sample(*paint.base_colour, *paint.material.base_colour_texture, uv);
  return factor * Rgb{texel.r, texel.g, texel.b};
}

std::optional<eval::ShadingPoint> shading_point(const Paint* paint, const SurfacePoint& point, const Vec3d& view,
                                                const std::optional<Rgb>& base_colour) {
  if (paint == nullptr) return std::nullopt;
  const double cosine = dot(view, point.normal);
  if (cosine == 0 || (cosine < 0 && !paint->material.double_sided)) return std::nullopt;
  const double side = cosine > 0 ? 1 : -1;
  const Vec3d surface_normal = point.normal * side;
  const Vec3d normal = paint->normal != nullptr ? perturbed(*paint, point, side) : surface_normal;
  return eval::ShadingPoint{point.position, normal, surface_normal, view, brdf_at(*paint, point.uv, base_colour)};
}

double lobe_width(const SurfaceModel& model) {
  constexpr double narrowest = 1e-3;
  struct {
    double operator()(const Lambert&) const { return 1; }
    double operator()(const Principled& m) const { return m.roughness * m.roughness; }
    double operator()(const Standard& m) const { return m.roughness * m.roughness; }
    double operator()(const Conductor& m) const { return m.alpha; }
    double operator()(const MetalRough& m) const { return m.roughness * m.roughness; }
    double operator()(const SpecularGlossiness& m) const { return (1 - m.glossiness) * (1 - m.glossiness); }
  } width;
  return std::max(narrowest, std::visit(width, model));
}

}  // namespace etendue::rendering
