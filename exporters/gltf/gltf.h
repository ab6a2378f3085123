// glTF 2.0, .gltf and .glb. What is written as it stood, what anew: README.md beside this file.
#pragma once
#include <memory>

#include "etendue/io.h"

namespace etendue {
std::unique_ptr<Exporter> make_gltf_exporter();
}
