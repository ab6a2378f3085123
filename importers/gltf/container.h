// The two wrappings of glTF: JSON alone, or a GLB with JSON and one binary chunk (glTF 2.0, section 4.4).
#pragma once

#include "etendue/result.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace etendue::gltf {

struct Container {
  std::string_view json;
  std::size_t json_offset = 0;                       // in the file
  std::optional<std::span<const std::byte>> binary;  // of a GLB: what a first buffer without uri holds
  bool is_glb = false;
};

// Views into `bytes`. What is wrong has an offset and the validator's code. No container: what is wrong leaves no JSON to look at.
std::optional<Container> open_container(std::span<const std::byte> bytes, bool named_glb, std::vector<Diagnostic>& diagnostics);

}  // namespace etendue::gltf
