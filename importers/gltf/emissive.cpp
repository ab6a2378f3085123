// Emissive materials as mesh lights.
#include <algorithm>
#include <cmath>
#include <utility>

#include "lights.h"

namespace etendue::gltf {
namespace {

// to_world as a rotation after scales along the axes: the columns are then orthogonal, and of a right-handed system. Cosines below 1e-6
// between them are taken for the rounding of single-precision files; they move no point by more than that fraction of the mesh's size.
bool is_scaled_rotation(const Transform& to_world) {
  const auto& c = to_world.columns;
  if (!(to_world.determinant() > 0)) return false;
  const auto cosine = [](const Vec3d& a, const Vec3d& b) { return std::abs(dot(normalised(a), normalised(b))); };
  return std::max({cosine(c[0], c[1]), cosine(c[1], c[2]), cosine(c[2], c[0])}) < 1e-6;
}

Mesh in_world(const Mesh& mesh, const Transform& to_world) {
  Mesh baked = mesh;
  for (Vec3f& p : baked.positions) p = vec_cast<float>(to_world.point(vec_cast<double>(p)));
  for (Vec3f& n : baked.normals) n = vec_cast<float>(normalised(to_world.normal(vec_cast<double>(n))));
  // A mirrored surface keeps its front (3.5.3): the order of the corners turns round.
  if (to_world.determinant() < 0)
    for (std::size_t i = 0; i + 2 < baked.indices.size(); i += 3) std::swap(baked.indices[i + 1], baked.indices[i + 2]);
  return baked;
}

}  // namespace

Light emissive_surface(Scene& scene, std::uint32_t mesh, const Materials::Entry& entry, const Transform& to_world) {
  const Material& material = entry.material;
  Light light;
  light.emission.given = Emission::Given::luminance;
  light.emission.value = luminance_of(material.emissive);
  light.emission.texture = material.emissive_texture;
  light.colour = RgbColour{material.emissive};
  light.two_sided = material.double_sided;
  if (entry.index != no_index) light.surface_material = entry.index;
  if (is_scaled_rotation(to_world)) {
    const auto& c = to_world.columns;
    light.shape = MeshShape{mesh, {length(c[0]), length(c[1]), length(c[2])}};
    light.transform = {{normalised(c[0]), normalised(c[1]), normalised(c[2])}, to_world.translation};
  } else {
    light.shape = MeshShape{static_cast<std::uint32_t>(scene.meshes.size()), {1, 1, 1}};
    scene.meshes.push_back(in_world(scene.meshes[mesh], to_world));
  }
  return light;
}

}  // namespace etendue::gltf
