// Elements of accessors, every index and size checked before a byte is touched (glTF 2.0, sections 3.6.2 and 5.1).
#pragma once

#include "asset.h"

#include <cstdint>
#include <span>
#include <vector>

namespace etendue::gltf {

// Normalised integers as numbers in [0, 1] or [-1, 1]; sparse substitutions applied; matrices column by column without their padding.
// Errors name the accessor: UNRESOLVED_REFERENCE, ACCESSOR_TOO_LONG, ACCESSOR_INVALID_FLOAT, LIMIT_EXCEEDED, ...
Result<std::vector<float>> read_numbers(Asset& asset, int accessor, int components);
Result<std::vector<Vec2f>> read_vec2(Asset& asset, int accessor);
Result<std::vector<Vec3f>> read_vec3(Asset& asset, int accessor);
Result<std::vector<Vec4f>> read_vec4(Asset& asset, int accessor);
// COLOR_n: RGB or RGBA, alpha 1 where there is none.
Result<std::vector<Vec4f>> read_colours(Asset& asset, int accessor);

// Unsigned scalars, as they stand in an index buffer.
Result<std::vector<std::uint32_t>> read_indices(Asset& asset, int accessor);

bool all_finite(std::span<const float> values);

}  // namespace etendue::gltf
