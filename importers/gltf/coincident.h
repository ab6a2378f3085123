// Lamps that a file says twice: a punctual light, and a mesh with an emissive material where it stands.
#pragma once

#include "asset.h"

namespace etendue::gltf {

// An emissive mesh is a light's shape if the light stands within the mesh's bounds, no further from the middle of its surface than a
// quarter of their diagonal, and sends no more than twice, no less than half of what the light does (several lights in one mesh: their
// sum). Then the surface stays, which says more, under the light's name. A mesh that sends less is the light's look: the light stays, and
// the mesh becomes an object. One that sends more is no lamp's shape, and both stay. Each of these is reported.
void count_lamps_once(Asset& asset, Scene& scene);

}  // namespace etendue::gltf
