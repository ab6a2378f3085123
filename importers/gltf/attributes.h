// What an attribute of a primitive may be called and hold (3.7.2.1, 3.7.2.2, KHR_mesh_quantization).
#pragma once

#include "records.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace etendue::gltf {

// "TEXCOORD_12" is TEXCOORD and 12; POSITION, NORMAL, TANGENT and names with a leading "_" have no set.
struct Semantic {
  std::string base;
  int set = -1;
  bool is_custom() const { return base.empty(); }
};
// None where glTF knows no such attribute.
std::optional<Semantic> semantic_of(std::string_view name);

enum class Role { vertex, morph_target };
// nullptr for custom attributes, which may be anything but UNSIGNED_INT.
const std::vector<Format>* formats_of(const std::string& base, Role role, bool quantised);

}  // namespace etendue::gltf
