#include "accessors.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <functional>
#include <limits>
#include <optional>
#include <type_traits>

#include <fmt/format.h>

namespace etendue::gltf {
namespace {

std::size_t component_size(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

template <class T>
T load(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

// Where the numbers of an element stand. The columns of a matrix begin at multiples of 4 bytes (3.6.2.4).
struct Format {
  std::size_t rows = 1, columns = 1, component_size = 4;

  std::size_t width() const { return rows * columns; }
  std::size_t column_stride() const { return columns == 1 ? rows * component_size : (rows * component_size + 3) / 4 * 4; }
  std::size_t element_size() const { return columns * column_stride(); }
};

Format format_of(int type, int component_type) {
  const std::size_t size = component_size(component_type);
  switch (type) {
    case TINYGLTF_TYPE_MAT2:
      return {2, 2, size};
    case TINYGLTF_TYPE_MAT3:
      return {3, 3, size};
    case TINYGLTF_TYPE_MAT4:
      return {4, 4, size};
    default:
      return {static_cast<std::size_t>(std::max(1, tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)))), 1, size};
  }
}

// `count` elements of T, `stride` bytes apart, as numbers. glTF is little-endian, as are all machines we build for.
// 3.6.2.2: normalised unsigned c / (2^n - 1), signed max(c / (2^(n-1) - 1), -1).
template <class T>
void convert(const std::byte* from, std::size_t stride, std::size_t count, const Format& format, bool normalised, float* out) {
  if constexpr (std::is_same_v<T, float>) {
    if (stride == format.width() * sizeof(float)) {
      std::memcpy(out, from, count * stride);
      return;
    }
  }
  for (std::size_t i = 0; i < count; ++i, from += stride) {
    for (std::size_t column = 0; column < format.columns; ++column) {
      for (std::size_t row = 0; row < format.rows; ++row) {
        const T value = load<T>(from + column * format.column_stride() + row * sizeof(T));
        if constexpr (std::is_same_v<T, float>) {
          *out++ = value;
        } else {
          constexpr double scale = std::numeric_limits<T>::max();
          *out++ = static_cast<float>(normalised ? std::max(value / scale, -1.0) : static_cast<double>(value));
        }
      }
    }
  }
}

using Convert = void (*)(const std::byte*, std::size_t, std::size_t, const Format&, bool, float*);
Convert conversion_of(int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return convert<std::int8_t>;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return convert<std::uint8_t>;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return convert<std::int16_t>;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return convert<std::uint16_t>;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return convert<std::uint32_t>;
    default:
      return convert<float>;
  }
}

std::uint32_t unsigned_at(const std::byte* from, int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load<std::uint8_t>(from);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(from);
    default:
      return load<std::uint32_t>(from);
  }
}

template <class T>
void widen(const std::byte* from, std::size_t stride, std::vector<std::uint32_t>& out) {
  if (stride == sizeof(T)) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = load<T>(from + i * sizeof(T));
  } else {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = load<T>(from + i * stride);
  }
}

// A run of equally spaced elements inside a bufferView.
struct Elements {
  SharedBytes owner;
  std::span<const std::byte> bytes;
  std::size_t stride = 0;
  const std::byte* operator[](std::size_t i) const { return bytes.data() + i * stride; }
};

struct Layout {
  std::size_t count, element_size, component_size, offset;
};

Result<Elements> elements_in(Asset& asset, int view, const Layout& layout, const std::string& pointer) {
  auto bytes = asset.view(view);
  if (!bytes) return bytes.error();
  const tinygltf::BufferView& record = asset.model().bufferViews[static_cast<std::size_t>(view)];
  const std::size_t stride = record.byteStride != 0 ? record.byteStride : layout.element_size;
  if (stride < layout.element_size)
    return asset.failure("ACCESSOR_SMALL_BYTESTRIDE",
                         fmt::format("expected a byteStride of at least {} in bufferView {}, found {}", layout.element_size, view, stride),
                         pointer);
  // Components are copied from wherever they are: tolerance costs nothing here.
  if (!asset.options().tolerant && (record.byteOffset + layout.offset) % layout.component_size != 0)
    return asset.failure("ACCESSOR_TOTAL_OFFSET_ALIGNMENT", fmt::format("components are not aligned to {} bytes", layout.component_size),
                         pointer);
  // offset + (count - 1) stride + element_size <= size, without a sum or product that could overflow.
  const std::size_t size = bytes->size();
  if (layout.offset > size || layout.element_size > size - layout.offset ||
      (layout.count - 1) > (size - layout.offset - layout.element_size) / stride)
    return asset.failure("ACCESSOR_TOO_LONG",
                         fmt::format("{} elements of {} bytes from byte {} on go beyond bufferView {} of {} bytes", layout.count,
                                     layout.element_size, layout.offset, view, size),
                         pointer);
  return Elements{*bytes, bytes->bytes().subspan(layout.offset), stride};
}

Result<std::reference_wrapper<const tinygltf::Accessor>> accessor_at(Asset& asset, int index, const std::string& pointer) {
  if (index < 0 || static_cast<std::size_t>(index) >= asset.model().accessors.size())
    return asset.failure("UNRESOLVED_REFERENCE", fmt::format("there is no accessor {}", index), pointer);
  const tinygltf::Accessor& accessor = asset.model().accessors[static_cast<std::size_t>(index)];
  if (component_size(accessor.componentType) == 0)
    return asset.failure("VALUE_NOT_IN_LIST", fmt::format("glTF has no componentType {}", accessor.componentType), pointer);
  if (accessor.count < 1) return asset.failure("VALUE_NOT_IN_RANGE", "expected at least one element, found none", pointer + "/count");
  if (accessor.count > asset.options().max_items)
    return asset.over_limit(fmt::format("an array of {} elements", accessor.count), "max_items", asset.options().max_items, pointer);
  return std::cref(accessor);
}

// The elements of sparse.indices and sparse.values, checked: put(target, source) for each.
using Put = std::function<void(std::size_t, const std::byte*)>;
Status apply_sparse(Asset& asset, const tinygltf::Accessor& accessor, const Layout& layout, const std::string& pointer, const Put& put) {
  const auto& sparse = accessor.sparse;
  const std::size_t index_size = component_size(sparse.indices.componentType);
  if (sparse.count < 1 || static_cast<std::size_t>(sparse.count) > layout.count || index_size == 0)
    return asset.failure("ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE",
                         fmt::format("expected 1 to {} sparse elements, found {}", layout.count, sparse.count), pointer + "/sparse");
  const auto count = static_cast<std::size_t>(sparse.count);
  const auto indices =
      elements_in(asset, sparse.indices.bufferView, {count, index_size, index_size, static_cast<std::size_t>(sparse.indices.byteOffset)},
                  pointer + "/sparse/indices");
  if (!indices) return indices.error();
  const auto values = elements_in(asset, sparse.values.bufferView,
                                  {count, layout.element_size, layout.component_size, static_cast<std::size_t>(sparse.values.byteOffset)},
                                  pointer + "/sparse/values");
  if (!values) return values.error();
  std::uint32_t previous = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t target = unsigned_at((*indices)[i], sparse.indices.componentType);
    const bool rising = i == 0 || target > previous;
    if (!rising || target >= layout.count)
      return asset.failure(rising ? "ACCESSOR_SPARSE_INDEX_OOB" : "ACCESSOR_SPARSE_INDICES_NON_INCREASING",
                           fmt::format("expected rising indices below {}, found {} at {}", layout.count, target, i),
                           pointer + "/sparse/indices");
    previous = target;
    put(target, (*values)[i]);
  }
  return Done{};
}

// Vector: of floats, or of vectors of `width` floats without anything between them.
template <class Vector>
Result<std::vector<Vector>> read(Asset& asset, int index, std::size_t width, const char* expected) {
  const std::string pointer = fmt::format("/accessors/{}", index);
  const auto found = accessor_at(asset, index, pointer);
  if (!found) return found.error();
  const tinygltf::Accessor& accessor = *found;
  const Format format = format_of(accessor.type, accessor.componentType);
  if (format.width() != width)
    return asset.failure("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT",
                         fmt::format("not read: its record has an error, or it holds no {} elements", expected), pointer);

  const Layout layout{accessor.count, format.element_size(), format.component_size, accessor.byteOffset};
  const Convert put = conversion_of(accessor.componentType);
  std::optional<Elements> elements;
  if (accessor.bufferView >= 0) {
    auto there = elements_in(asset, accessor.bufferView, layout, pointer);
    if (!there) return there.error();
    elements = std::move(*there);
  }
  if (auto room = asset.claim_memory(std::uint64_t{accessor.count} * width * sizeof(float), pointer); !room) return room.error();
  std::vector<Vector> values(accessor.count * width * sizeof(float) / sizeof(Vector));  // zeros, unless somebody says more
  auto* const numbers = reinterpret_cast<float*>(values.data());
  if (elements) put(elements->bytes.data(), elements->stride, layout.count, format, accessor.normalized, numbers);
  if (accessor.sparse.isSparse) {
    const auto substitute = [&](std::size_t target, const std::byte* source) {
      put(source, format.element_size(), 1, format, accessor.normalized, numbers + target * width);
    };
    if (const Status done = apply_sparse(asset, accessor, layout, pointer, substitute); !done) return done.error();
  }
  if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT && !all_finite({numbers, accessor.count * width}))
    return asset.failure("ACCESSOR_INVALID_FLOAT", "expected finite numbers, found infinite ones or NaN", pointer);
  return values;
}

}  // namespace

// All bits of the exponent are set in infinities and NaN alone. Without a branch, so that compilers make vectors of it.
bool all_finite(std::span<const float> values) {
  constexpr std::uint32_t exponent = 0x7F800000;
  std::uint32_t worst = 0;
  for (const float value : values) worst = std::max(worst, std::bit_cast<std::uint32_t>(value) & exponent);
  return worst < exponent;
}

Result<std::vector<float>> read_numbers(Asset& asset, int accessor, int components) {
  return read<float>(asset, accessor, static_cast<std::size_t>(components),
                     components == 1    ? "SCALAR"
                     : components == 16 ? "MAT4"
                                        : "other");
}
Result<std::vector<Vec2f>> read_vec2(Asset& asset, int accessor) { return read<Vec2f>(asset, accessor, 2, "VEC2"); }
Result<std::vector<Vec3f>> read_vec3(Asset& asset, int accessor) { return read<Vec3f>(asset, accessor, 3, "VEC3"); }
Result<std::vector<Vec4f>> read_vec4(Asset& asset, int accessor) { return read<Vec4f>(asset, accessor, 4, "VEC4"); }

Result<std::vector<Vec4f>> read_colours(Asset& asset, int index) {
  const auto& accessors = asset.model().accessors;
  const bool rgb = index >= 0 && static_cast<std::size_t>(index) < accessors.size() &&
                   accessors[static_cast<std::size_t>(index)].type == TINYGLTF_TYPE_VEC3;
  if (!rgb) return read_vec4(asset, index);
  const auto colours = read_vec3(asset, index);
  if (!colours) return colours.error();
  std::vector<Vec4f> out(colours->size());
  std::transform(colours->begin(), colours->end(), out.begin(), [](const Vec3f& c) { return Vec4f{c.x, c.y, c.z, 1}; });
  return out;
}

Result<std::vector<std::uint32_t>> read_indices(Asset& asset, int index) {
  const std::string pointer = fmt::format("/accessors/{}", index);
  const auto found = accessor_at(asset, index, pointer);
  if (!found) return found.error();
  const tinygltf::Accessor& accessor = *found;
  const int type = accessor.componentType;
  const bool is_unsigned = type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_unsigned || accessor.normalized)
    return asset.failure("MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT", "expected unsigned SCALAR elements that are not normalised",
                         pointer);

  const std::size_t size = component_size(type);
  const Layout layout{accessor.count, size, size, accessor.byteOffset};
  std::optional<Elements> elements;
  if (accessor.bufferView >= 0) {
    auto there = elements_in(asset, accessor.bufferView, layout, pointer);
    if (!there) return there.error();
    elements = std::move(*there);
  }
  if (auto room = asset.claim_memory(std::uint64_t{accessor.count} * sizeof(std::uint32_t), pointer); !room) return room.error();
  std::vector<std::uint32_t> values(accessor.count);
  if (elements) {
    const auto put = size == 1 ? widen<std::uint8_t> : size == 2 ? widen<std::uint16_t> : widen<std::uint32_t>;
    put(elements->bytes.data(), elements->stride, values);
  }
  if (accessor.sparse.isSparse) {
    const auto substitute = [&](std::size_t target, const std::byte* source) { values[target] = unsigned_at(source, type); };
    if (const Status done = apply_sparse(asset, accessor, layout, pointer, substitute); !done) return done.error();
  }
  return values;
}

}  // namespace etendue::gltf
