// The scene: plain vectors and indices. Metres, right-handed, +Y up, linear Rec.709. Values as authored.
#pragma once

#include "etendue/image.h"
#include "etendue/light.h"
#include "etendue/material.h"
#include "etendue/result.h"
#include "etendue/vec.h"

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace etendue {

inline constexpr std::uint32_t no_index = 0xffffffffu;

// Indexed triangles. What stands per vertex may be empty; without normals the mesh is flat-shaded. Where a file has several sets of texture
// coordinates, `uvs` is the one that the mesh's material uses. A mirroring transform does not swap the sides: what was the front stays the
// front (glTF).
struct Mesh {
  std::string name;
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;
  std::vector<Vec2f> uvs;
  std::vector<Vec4f> tangents;  // w: the sign of the bitangent cross(normal, tangent). Carried: normal maps take their frame from the uvs
  std::vector<Vec4f> colours;   // linear, with alpha, to multiply the base colour by (glTF's COLOR_0). Carried: no picture shows them
  std::vector<std::uint32_t> indices;  // 3 a triangle, counter-clockwise is the front
  std::string source;
};
// Surface area after `to_world`.
double area_of(const Mesh& mesh, const Transform& to_world);

struct PlaneGeometry {
  double size = 1;  // a square in XZ, centred, facing +Y
};
struct BoxGeometry {
  Vec3d size{1, 1, 1};  // centred
};
struct SphereGeometry {
  double radius = 1;  // centred
};
struct MeshGeometry {
  std::uint32_t mesh = 0;
};
using Geometry = std::variant<PlaneGeometry, BoxGeometry, SphereGeometry, MeshGeometry>;

// A surface in the world. A sphere's transform must be a similarity.
struct Object {
  std::string name;
  Geometry geometry;
  std::uint32_t material = no_index;  // no_index: Lambert .5
  Transform transform;
  std::string source;
};

// A plane, box or sphere as triangles with normals and uvs; a mesh as itself (copied).
Mesh tessellated(const Geometry& geometry, const std::vector<Mesh>& meshes);

struct Camera {
  std::string name;
  Transform transform;                  // rigid, looks along -Z, +Y up
  double vfov_rad = 40 * pi / 180;      // full vertical angle
  std::optional<double> ev100;          // exposure, if the file states one
  double aspect = 0;                    // authored width / height, 0 if not stated
  std::optional<double> near_m, far_m;  // authored; nothing is cut off at them here
  std::string source;
};
Camera look_at(const Vec3d& position, const Vec3d& target, double vfov_rad);

// What a JSON format says beyond the scene, kept so that it can be written back (sdk/docs/decisions, "carried"). The
// whole document, since its parts refer to one another by position; the scene's `source` members point into the same document.
struct Carried {
  SharedBytes document;              // the JSON text, as it stood in the file
  std::vector<SharedBytes> buffers;  // what its buffers hold, in their order; none for those that the text itself or nobody holds
  std::vector<std::string> parts;    // JSON pointers to what no other member of the scene represents
};

struct Scene {
  std::vector<Light> lights;
  std::vector<Camera> cameras;
  std::vector<Material> materials;
  std::vector<Object> objects;
  std::vector<Mesh> meshes;
  std::vector<ImageRef> images;
  std::string file;    // what was read
  std::string format;  // id of the importer: "rig", "gltf"
  Carried carried;
};

// Everything an evaluator or exporter may rely on: indices in range, finite numbers, ranges of parameters, shapes with a size, resolvable
// lights. Errors name the thing by its name and source.
Diagnostics validate(const Scene& scene);

// Mesh area of a light for resolve(); 0 for other shapes.
double mesh_area_of(const Scene& scene, const Light& light);

// Bounds of objects and of lights with a place in the world; empty (min > max) for an empty scene.
struct Bounds {
  Vec3d min{1, 1, 1}, max{-1, -1, -1};
  bool empty() const { return min.x > max.x; }
};
Bounds bounds_of(const Scene& scene);

// A camera that sees the whole of `bounds` from the front, a little above (used where a file has none).
Camera framing_camera(const Bounds& bounds, double aspect);

}  // namespace etendue
