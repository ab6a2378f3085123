// Lights of glTF's extensions, and emissive surfaces, as ours.
#pragma once

#include "asset.h"
#include "materials.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace etendue::gltf {

// Lights as nodes refer to them: `use` is the extension's object there. Errors are reported and give none.
std::optional<Light> punctual_light(Asset& asset, const nlohmann::json& use, const Transform& node_to_world);
std::optional<Light> area_light(Asset& asset, const nlohmann::json& use, const Transform& node_to_world);
std::optional<Light> ies_light(Asset& asset, const nlohmann::json& use, const Transform& node_to_world);

// Light `index` of EXT_lights_image_based: the images of its finest cube, six or none; and the light with them as images of the scene.
std::vector<int> image_based_cube(Asset& asset, int index);
Light image_based_light(Asset& asset, int index, std::vector<std::uint32_t> faces);

// A primitive with an emissive material: one light that is the surface as well (Light::surface_material). `mesh` is its index in the
// scene; where the transform is no rotation with scales along the mesh's own axes, a copy in world space is appended and used.
Light emissive_surface(Scene& scene, std::uint32_t mesh, const Materials::Entry& material, const Transform& to_world);

}  // namespace etendue::gltf
