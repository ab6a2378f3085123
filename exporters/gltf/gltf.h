// glTF 2.0, .gltf and .glb. What is written as it stood, what anew: README.md beside this file.
#pragma once
#include <memory>

#include "etendue/io.h"

namespace etendue {

namespace gltf {
// Of lights of a scene that carries no document: `emissive` gives those with a surface an emissive mesh beside their punctual light.
enum class LightShapes { none, emissive };
}  // namespace gltf

std::unique_ptr<Exporter> make_gltf_exporter(gltf::LightShapes shapes = gltf::LightShapes::none);

}  // namespace etendue
