// Accessors, bufferViews and buffers of a document as numbers that have been looked at: what is missing or of a wrong type stands out,
// nothing is beyond 2^53, and so no product of a count and a stride (at most 252) and no sum of a few of them overflows 64 bits.
#pragma once

#include "json_values.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace etendue::gltf {

enum class Shape : std::uint8_t { unknown, scalar, vec2, vec3, vec4, mat2, mat3, mat4 };
std::size_t components_of(Shape shape);

// What an accessor's elements are: "VEC3 of UNSIGNED_SHORT, normalised".
struct Format {
  Shape shape = Shape::unknown;
  int component = 0;  // 5120 ... 5126
  bool normalised = false;
  friend bool operator==(const Format&, const Format&) = default;
};
std::string to_string(const Format& format);

std::size_t component_bytes(int component);  // 0 for what is none
// Of one element: columns of matrices start at multiples of 4 bytes (3.6.2.4). The last column's padding counts in the stride alone.
std::size_t element_bytes(const Format& format);
std::size_t tight_stride(const Format& format);

enum class Usage : std::uint8_t { none, vertices, indices, image, inverse_bind_matrices, animation_input, animation_output, other };
const char* name_of(Usage usage);

struct View {
  std::int64_t buffer = -1;
  std::uint64_t offset = 0, length = 0;  // length 0: unknown
  std::uint64_t stride = 0;              // 0: none
  Usage usage = Usage::none;
  std::set<std::int64_t> vertex_accessors;
};

struct Accessor {
  std::int64_t view = -1;
  std::uint64_t offset = 0, count = 0;
  Format format;
  bool has_bounds = false;  // both of them
  bool is_sparse = false;
  Usage usage = Usage::none;
  bool is_valid() const { return count > 0 && format.shape != Shape::unknown && format.component != 0; }
};

struct Buffer {
  std::uint64_t length = 0;  // 0: unknown
};

struct Records {
  explicit Records(const Json& root);
  std::vector<Buffer> buffers;
  std::vector<View> views;
  std::vector<Accessor> accessors;

  // nullptr for what is not there.
  View* view(std::int64_t index) { return at(views, index); }
  Accessor* accessor(std::int64_t index) { return at(accessors, index); }

 private:
  template <class T>
  static T* at(std::vector<T>& all, std::int64_t index) {
    return index >= 0 && static_cast<std::size_t>(index) < all.size() ? &all[static_cast<std::size_t>(index)] : nullptr;
  }
};

// Bytes from the first to the last of `count` elements, count > 0.
inline std::uint64_t extent(std::uint64_t count, std::uint64_t stride, std::size_t element) { return (count - 1) * stride + element; }

}  // namespace etendue::gltf
