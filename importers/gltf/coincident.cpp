#include "coincident.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace etendue::gltf {
namespace {

struct Place {
  Bounds bounds;
  Vec3d middle;  // of the surface
};

Place place_of(const Mesh& mesh, const MeshShape& shape, const Transform& to_world) {
  Place place;
  double area = 0;
  const auto corner = [&](std::size_t i) { return to_world.point(vec_cast<double>(mesh.positions[mesh.indices[i]]) * shape.scale); };
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Vec3d p[3] = {corner(i), corner(i + 1), corner(i + 2)};
    const double twice = length(cross(p[1] - p[0], p[2] - p[0]));
    area += twice;
    place.middle += (p[0] + p[1] + p[2]) * (twice / 3);
    for (const Vec3d& point : p) {
      for (int c = 0; c < 3; ++c) {
        place.bounds.min[c] = i == 0 && &point == &p[0] ? point[c] : std::min(place.bounds.min[c], point[c]);
        place.bounds.max[c] = i == 0 && &point == &p[0] ? point[c] : std::max(place.bounds.max[c], point[c]);
      }
    }
  }
  if (area > 0) place.middle = place.middle / area;
  return place;
}

bool stands_in(const Place& place, const Vec3d& at) {
  if (place.bounds.empty()) return false;
  const double diagonal = length(place.bounds.max - place.bounds.min), room = 0.01 * diagonal;  // for flat meshes, and rounding
  for (int c = 0; c < 3; ++c)
    if (at[c] < place.bounds.min[c] - room || at[c] > place.bounds.max[c] + room) return false;
  return length(at - place.middle) <= diagonal / 4;
}

double flux_of(const Scene& scene, const Light& light) {
  const Result<Resolved> resolved = resolve(light, mesh_area_of(scene, light));
  return resolved ? resolved->flux_lm : 0;
}

bool has_a_place(const Light& light) {
  return std::holds_alternative<PointShape>(light.shape) || std::holds_alternative<SpotShape>(light.shape) ||
         std::holds_alternative<RectShape>(light.shape) || std::holds_alternative<DiskShape>(light.shape);
}

}  // namespace

void count_lamps_once(Asset& asset, Scene& scene) {
  std::vector<bool> gone(scene.lights.size(), false);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    Light& surface = scene.lights[i];
    const auto* shape = std::get_if<MeshShape>(&surface.shape);
    if (shape == nullptr || scene.meshes[shape->mesh].indices.empty()) continue;
    const Place place = place_of(scene.meshes[shape->mesh], *shape, surface.transform);
    std::vector<std::size_t> inside;
    double flux = 0;
    for (std::size_t j = 0; j < scene.lights.size(); ++j) {
      if (gone[j] || !has_a_place(scene.lights[j]) || !stands_in(place, scene.lights[j].transform.translation)) continue;
      inside.push_back(j);
      flux += flux_of(scene, scene.lights[j]);
    }
    if (inside.empty()) continue;
    const double of_surface = flux_of(scene, surface);
    const std::string both =
        fmt::format("the emissive mesh \"{}\" ({:.4g} lm) stands where the light \"{}\" does ({:.4g} lm{})", surface.name, of_surface,
                    scene.lights[inside[0]].name, flux, inside.size() > 1 ? ", with others there" : "");
    if (of_surface > 2 * flux) {
      asset.note("EMISSIVE_MESH_AND_LIGHT", both + ": it sends much more, and both are taken for lights", surface.source);
    } else if (of_surface >= flux / 2) {
      asset.warning("EMISSIVE_MESH_AND_LIGHT", both + ": one lamp, which counts once, as the surface", surface.source);
      for (const std::size_t j : inside) gone[j] = true;
      surface.name = scene.lights[inside[0]].name;
    } else {
      asset.warning("EMISSIVE_MESH_AND_LIGHT", both + ": one lamp, which counts once, as the light; the mesh's own light is not shown",
                    surface.source);
      gone[i] = true;
      Transform to_world = surface.transform;
      for (int c = 0; c < 3; ++c)
        to_world.columns[static_cast<std::size_t>(c)] = to_world.columns[static_cast<std::size_t>(c)] * shape->scale[c];
      scene.objects.push_back(
          {surface.name, MeshGeometry{shape->mesh}, surface.surface_material.value_or(no_index), to_world, surface.source});
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    if (gone[i]) continue;
    if (kept != i) scene.lights[kept] = std::move(scene.lights[i]);
    ++kept;
  }
  scene.lights.resize(kept);
}

}  // namespace etendue::gltf
