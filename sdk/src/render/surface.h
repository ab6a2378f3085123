// What a ray meets: a point of a surface with its frame, and the material there.
#pragma once

#include "rays.h"

#include "etendue/eval.h"
#include "etendue/material.h"
#include "etendue/picture.h"
#include "etendue/scene.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace etendue::rendering {

// A material with its textures decoded; null where there is none.
struct Paint {
  Material material;
  const DecodedImage* base_colour = nullptr;
  const DecodedImage* metal_rough = nullptr;
  const DecodedImage* specular_gloss = nullptr;
  const DecodedImage* normal = nullptr;
  bool coarse_holes = false;  // cut on the exporter's grid
  bool textured() const { return base_colour != nullptr || metal_rough != nullptr || specular_gloss != nullptr || normal != nullptr; }
  // Textures change the base colour alone, and reflected light is an affine function of that.
  bool coloured() const;
  bool has_holes() const { return material.alpha_cutoff.has_value(); }
};

// A mesh in the world. `group` tells parts apart whose shading is not continuous: parts that share no vertex, or planes if flat-shaded.
struct WorldMesh {
  Triangles triangles;
  std::vector<Vec3d> normals;  // unit; empty: flat-shaded
  std::vector<Vec2d> uvs;
  std::vector<std::uint64_t> group;  // by triangle
};
// `flat`: vertex normals are not used.
WorldMesh to_world(const Mesh& mesh, const Transform& transform, bool flat);

// Something that rays can meet.
struct Thing {
  std::optional<std::uint32_t> object, light;  // index into the scene's; one of both
  const Paint* paint = nullptr;                // none: black
  WorldMesh mesh;
  std::optional<Shape> shape;  // instead of the mesh
  Transform shape_frame;       // of a sphere object: its columns are unit vectors
  bool convex = false;         // its front cannot see itself
};

struct SurfacePoint {
  std::uint32_t thing = no_index;
  double distance = 0;
  Vec3d position;
  Vec3d geometric_normal;  // unit, of the true surface, on its front
  Vec3d normal;            // unit, interpolated, on the front
  Vec3d tangent;           // the position's derivative by u, not normalised
  Vec2d uv;
  std::uint64_t part = 0;  // the mesh's group
  bool flat = false;       // the normal does not vary over the triangle
};
SurfacePoint surface_point(const Thing& thing, const Ray& ray, const Hit& hit);

// True where the paint leaves a hole.
bool is_hole(const Paint& paint, Vec2d uv);
Rgb base_colour_at(const Paint& paint, Vec2d uv);

// Radians over which the normal may turn while what is reflected from one direction stays about the same: alpha, the width of GGX's half
// vectors, or 1 for matt surfaces.
double lobe_width(const SurfaceModel& model);

// What light falls on, or nothing: the back of a one-sided surface, or a black one. `base_colour` replaces the paint's own.
std::optional<eval::ShadingPoint> shading_point(const Paint* paint, const SurfacePoint& point, const Vec3d& view,
                                                const std::optional<Rgb>& base_colour = std::nullopt);

}  // namespace etendue::rendering
