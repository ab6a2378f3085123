// glTF 2.0, .gltf and .glb. What is read, carried and named as lost: README.md beside this file.
#pragma once
#include <memory>

#include "etendue/io.h"

namespace etendue {
std::unique_ptr<Importer> make_gltf_importer();
}
