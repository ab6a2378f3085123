#include "accessors.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

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

// 3.6.2.2: normalised unsigned c / (2^n - 1), signed max(c / (2^(n-1) - 1), -1). glTF is little-endian, as are all machines we build for.
double component(const std::byte* from, int type, bool normalised) {
  double value = 0, scale = 1;
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      value = load<std::int8_t>(from), scale = 127;
      break;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      value = load<std::uint8_t>(from), scale = 255;
      break;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      value = load<std::int16_t>(from), scale = 32767;
      break;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      value = load<std::uint16_t>(from), scale = 65535;
      break;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      value = load<std::uint32_t>(from), scale = 4294967295.0;
      break;
    default:
      return static_cast<double>(load<float>(from));
  }
  return normalised ? std::max(value / scale, -1.0) : value;
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
    return asset.failure("ACCESSOR_INVALID_STRIDE",
                         fmt::format("expected a byteStride of at least {} in bufferView {}, found {}", layout.element_size, view, stride),
                         pointer);
  if ((record.byteOffset % layout.component_size + layout.offset) % layout.component_size != 0 || stride % layout.component_size != 0)
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
  if (accessor.count < 1 || accessor.count > asset.options().max_items)
    return asset.failure("LIMIT_EXCEEDED", fmt::format("{} elements are outside 1 to {}", accessor.count, asset.options().max_items),
                         pointer);
  return std::cref(accessor);
}

using Put = std::function<void(std::size_t, const std::byte*)>;

// The elements of sparse.indices and sparse.values, checked: put(target, source) for each.
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
  double previous = -1;
  for (std::size_t i = 0; i < count; ++i) {
    const double target = component((*indices)[i], sparse.indices.componentType, false);
    if (target <= previous || target >= static_cast<double>(layout.count))
      return asset.failure(target <= previous ? "ACCESSOR_SPARSE_INDICES_NON_INCREASING" : "ACCESSOR_SPARSE_INDEX_OOB",
                           fmt::format("expected rising indices below {}, found {} after {}", layout.count, target, previous),
                           pointer + "/sparse/indices");
    previous = target;
    put(static_cast<std::size_t>(target), (*values)[i]);
  }
  return Done{};
}

// Calls allocate() once the elements are known to be there, then put(index, source) for all, the sparse ones last.
Status for_each_element(Asset& asset, const tinygltf::Accessor& accessor, const Layout& layout, const std::string& pointer,
                        const std::function<void()>& allocate, const Put& put) {
  if (accessor.bufferView < 0) {
    allocate();  // all zeros
  } else {
    const auto elements = elements_in(asset, accessor.bufferView, layout, pointer);
    if (!elements) return elements.error();
    allocate();
    for (std::size_t i = 0; i < layout.count; ++i) put(i, (*elements)[i]);
  }
  return accessor.sparse.isSparse ? apply_sparse(asset, accessor, layout, pointer, put) : Status(Done{});
}

}  // namespace

Result<std::vector<float>> read_floats(Asset& asset, int index, int components) {
  const std::string pointer = fmt::format("/accessors/{}", index);
  const auto found = accessor_at(asset, index, pointer);
  if (!found) return found.error();
  const tinygltf::Accessor& accessor = *found;
  if (tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)) != components)
    return asset.failure("MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", fmt::format("expected VEC{} elements", components), pointer);

  const std::size_t size = component_size(accessor.componentType), width = static_cast<std::size_t>(components);
  const Layout layout{accessor.count, size * width, size, accessor.byteOffset};
  std::vector<float> values;
  bool finite = true;
  const auto put = [&](std::size_t target, const std::byte* source) {
    for (std::size_t c = 0; c < width; ++c) {
      const auto value = static_cast<float>(component(source + c * size, accessor.componentType, accessor.normalized));
      finite = finite && std::isfinite(value);
      values[target * width + c] = value;
    }
  };
  const auto allocate = [&] { values.resize(accessor.count * width); };
  if (auto done = for_each_element(asset, accessor, layout, pointer, allocate, put); !done) return done.error();
  if (!finite) return asset.failure("ACCESSOR_INVALID_FLOAT", "expected finite numbers, found infinite ones or NaN", pointer);
  return values;
}

Result<std::vector<std::uint32_t>> read_indices(Asset& asset, int index) {
  const std::string pointer = fmt::format("/accessors/{}", index);
  const auto found = accessor_at(asset, index, pointer);
  if (!found) return found.error();
  const tinygltf::Accessor& accessor = *found;
  const bool is_unsigned = accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                           accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                           accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_unsigned || accessor.normalized)
    return asset.failure("MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT", "expected unsigned SCALAR elements that are not normalised",
                         pointer);

  const std::size_t size = component_size(accessor.componentType);
  const Layout layout{accessor.count, size, size, accessor.byteOffset};
  std::vector<std::uint32_t> values;
  const auto put = [&](std::size_t target, const std::byte* source) {
    values[target] = static_cast<std::uint32_t>(component(source, accessor.componentType, false));
  };
  const auto allocate = [&] { values.resize(accessor.count); };
  if (auto done = for_each_element(asset, accessor, layout, pointer, allocate, put); !done) return done.error();
  return values;
}

}  // namespace etendue::gltf
