// Tolerant reading: which errors have a harmless repair.
#pragma once

#include <string>

namespace etendue::gltf {

// What is done instead of refusing the file; nullptr where nothing is harmless.
const char* repair_of(const std::string& code);

}  // namespace etendue::gltf
