// KHR_draco_mesh_compression, through Draco's own library where the project was built with it.
#pragma once

#include "asset.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace etendue::gltf {

struct DracoMesh {
  struct Attribute {
    std::size_t width = 0;
    std::vector<float> numbers;  // `width` a vertex
  };
  std::map<std::string, Attribute> attributes;  // by their names in glTF
  std::vector<std::uint32_t> indices;           // of triangles
};

bool draco_is_built();

// `extension` is the primitive's object of that name, `pointer` its place. Errors: DRACO_INVALID, LIMIT_EXCEEDED, and those of a
// bufferView.
Result<DracoMesh> decode_draco(Asset& asset, const nlohmann::json& extension, const std::string& pointer);

}  // namespace etendue::gltf
