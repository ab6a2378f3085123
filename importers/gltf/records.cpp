#include "records.h"

#include <algorithm>

#include <fmt/format.h>

namespace etendue::gltf {
namespace {

constexpr const char* shape_names[] = {"unknown", "SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};

struct Component {
  int code;
  const char* name;
  std::size_t bytes;
};
constexpr Component component_types[] = {{5120, "BYTE", 1},           {5121, "UNSIGNED_BYTE", 1}, {5122, "SHORT", 2},
                                         {5123, "UNSIGNED_SHORT", 2}, {5125, "UNSIGNED_INT", 4},  {5126, "FLOAT", 4}};

const Component* component_of(std::uint64_t code) {
  for (const Component& component : component_types)
    if (static_cast<std::uint64_t>(component.code) == code) return &component;
  return nullptr;
}

Shape shape_of(const std::string* name) {
  if (name != nullptr)
    for (int i = 1; i < 8; ++i)
      if (*name == shape_names[i]) return static_cast<Shape>(i);
  return Shape::unknown;
}

// Rows, which are the length of a column, of a matrix; 0 for other shapes.
std::size_t rows_of(Shape shape) { return shape == Shape::mat2 ? 2 : shape == Shape::mat3 ? 3 : shape == Shape::mat4 ? 4 : 0; }

Accessor accessor_of(const Json& source) {
  Accessor accessor;
  accessor.view = index_of(source, "bufferView");
  accessor.offset = accessor.view < 0 ? 0 : uint_of(source, "byteOffset").value_or(0);
  accessor.count = uint_of(source, "count").value_or(0);
  accessor.format.shape = shape_of(text_of(source, "type"));
  if (const Component* found = component_of(uint_of(source, "componentType").value_or(0))) accessor.format.component = found->code;
  accessor.format.normalised = is_true(source, "normalized");
  accessor.has_bounds = !array_at(source, "min").empty() && !array_at(source, "max").empty();
  accessor.is_sparse = source.is_object() && source.contains("sparse");
  return accessor;
}

View view_of(const Json& source) {
  View view;
  view.buffer = index_of(source, "buffer");
  view.offset = uint_of(source, "byteOffset").value_or(0);
  view.length = uint_of(source, "byteLength").value_or(0);
  const std::uint64_t stride = uint_of(source, "byteStride").value_or(0);
  view.stride = stride >= 4 && stride <= 252 ? stride : 0;
  const std::uint64_t target = uint_of(source, "target").value_or(0);
  view.usage = target == 34962 ? Usage::vertices : target == 34963 ? Usage::indices : Usage::none;
  return view;
}

}  // namespace

std::size_t components_of(Shape shape) {
  constexpr std::size_t counts[] = {0, 1, 2, 3, 4, 4, 9, 16};
  return counts[static_cast<int>(shape)];
}

std::string to_string(const Format& format) {
  const Component* component = component_of(static_cast<std::uint64_t>(format.component));
  return fmt::format("{} of {}{}", shape_names[static_cast<int>(format.shape)], component != nullptr ? component->name : "unknown",
                     format.normalised ? ", normalised" : "");
}

std::size_t component_bytes(int component) {
  const Component* found = component_of(static_cast<std::uint64_t>(component));
  return found != nullptr ? found->bytes : 0;
}

std::size_t tight_stride(const Format& format) {
  const std::size_t size = component_bytes(format.component), rows = rows_of(format.shape);
  return rows == 0 ? components_of(format.shape) * size : rows * ((rows * size + 3) / 4 * 4);
}

std::size_t element_bytes(const Format& format) {
  const std::size_t size = component_bytes(format.component), rows = rows_of(format.shape);
  const std::size_t padding = rows == 0 ? 0 : (4 - rows * size % 4) % 4;
  return tight_stride(format) - padding;
}

const char* name_of(Usage usage) {
  constexpr const char* names[] = {"nothing",         "vertex attributes", "vertex indices", "an image", "inverse bind matrices",
                                   "animation input", "animation output",  "other data"};
  return names[static_cast<int>(usage)];
}

Records::Records(const Json& root) {
  for (const Json& source : array_at(root, "buffers")) buffers.push_back({uint_of(source, "byteLength").value_or(0)});
  for (const Json& source : array_at(root, "bufferViews")) views.push_back(view_of(source));
  for (const Json& source : array_at(root, "accessors")) accessors.push_back(accessor_of(source));
}

}  // namespace etendue::gltf
