// The two wrappings of glTF: JSON alone, or a GLB with JSON and one binary chunk (glTF 2.0, section 4.4).
#pragma once

#include "etendue/result.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace etendue::gltf {

struct Container {
  std::string_view json;
  std::optional<std::span<const std::byte>> binary;  // of a GLB: what a first buffer without uri holds
};

bool is_glb(std::span<const std::byte> head);

// Views into `bytes`. Errors carry the validator's codes: GLB_LENGTH_MISMATCH, GLB_CHUNK_TOO_BIG, ...
Result<Container> open_container(std::span<const std::byte> bytes);

}  // namespace etendue::gltf
