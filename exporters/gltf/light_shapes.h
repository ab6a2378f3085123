// What a light looks like: its surface as triangles in its own frame.
#pragma once

#include "etendue/scene.h"

#include <optional>

namespace etendue::gltf {

// The front emits. None for lights without a surface: points, spots, suns, lines, files, skies. Flat ones have the texture coordinates of
// Emission::texture.
std::optional<Mesh> visible_shape(const Light& light, const std::vector<Mesh>& meshes);

}  // namespace etendue::gltf
