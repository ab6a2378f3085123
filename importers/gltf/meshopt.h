// EXT_meshopt_compression, through meshoptimizer where the project was built with it.
#pragma once

#include "asset.h"

#include <string>

namespace etendue::gltf {

bool meshopt_is_built();

// What the bufferView's bytes become. `extension` is its object of that name, `source` the compressed bytes. Errors: MESHOPT_INVALID,
// LIMIT_EXCEEDED.
Result<SharedBytes> decode_meshopt(Asset& asset, const nlohmann::json& extension, const SharedBytes& source, const std::string& pointer);

}  // namespace etendue::gltf
