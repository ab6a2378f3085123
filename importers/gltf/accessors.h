// Elements of accessors, every index and size checked before a byte is touched (glTF 2.0, sections 3.6.2 and 5.1).
#pragma once

#include "asset.h"

#include <cstdint>
#include <vector>

namespace etendue::gltf {

// `components` numbers an element, one element after the other; normalised integers as numbers in [0, 1] or [-1, 1]. Sparse ones applied.
// Errors name the accessor: UNRESOLVED_REFERENCE, ACCESSOR_TOO_LONG, ACCESSOR_INVALID_FLOAT, LIMIT_EXCEEDED, ...
Result<std::vector<float>> read_floats(Asset& asset, int accessor, int components);

// Unsigned scalars, as they stand in an index buffer.
Result<std::vector<std::uint32_t>> read_indices(Asset& asset, int accessor);

}  // namespace etendue::gltf
