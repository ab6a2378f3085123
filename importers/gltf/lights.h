// Lights of glTF's extensions, and emissive surfaces, as ours.
#pragma once

#include "asset.h"
#include "materials.h"

#include <cstdint>
#include <optional>

namespace etendue::gltf {

// Light `index` of KHR_lights_punctual or EXT_lights_area at a node; errors are reported and give none.
std::optional<Light> punctual_light(Asset& asset, int index, const Transform& node_to_world);
std::optional<Light> area_light(Asset& asset, int index, const Transform& node_to_world);

// A primitive with an emissive material: one light that is the surface as well (Light::surface_material). `mesh` is its index in the
// scene; where the transform is no rotation with scales along the mesh's own axes, a copy in world space is appended and used.
Light emissive_surface(Scene& scene, std::uint32_t mesh, const Materials::Entry& material, const Transform& to_world);

}  // namespace etendue::gltf
