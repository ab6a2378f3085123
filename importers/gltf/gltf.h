// glTF 2.0, .gltf and .glb. What is read, carried and named as lost: README.md beside this file.
#pragma once
#include <memory>

#include "etendue/io.h"

namespace etendue {
// `default_scene`: the materials that its surfaces show. `all`: every material of the document, for whoever converts them.
enum class GltfMaterials { default_scene, all };
std::unique_ptr<Importer> make_gltf_importer(GltfMaterials materials = GltfMaterials::default_scene);
}  // namespace etendue
