// Arrays of a new document in one buffer.
#pragma once

#include "etendue/scene.h"
#include "json_edit.h"

#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace etendue::gltf {

class BufferWriter {
 public:
  explicit BufferWriter(Json& document) : document_(document) {}

  // The attributes and indices of a primitive, each array written once a mesh.
  Json primitive(const Mesh& mesh);
  // The bytes; the document's "buffers" say their length.
  std::vector<std::uint8_t> finish();

 private:
  static constexpr int array_buffer = 34962, element_array_buffer = 34963;
  std::size_t view(std::span<const std::byte> bytes, int target);
  template <class Element>
  std::size_t floats(const std::vector<Element>& elements, const char* type);

  Json& document_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace etendue::gltf
