// What holds for the elements of any accessor: floats are finite, declared bounds are theirs, sparse indices rise and stay inside.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "data_checks.h"

namespace etendue::gltf {
namespace {

template <class T>
struct Bounds {
  std::array<T, 16> min{}, max{};
  bool finite = true;
};

// One pass. `sum` stays zero as long as all are finite: x * 0 is NaN for infinities and NaN alone.
template <class T, std::size_t n>
void find_bounds(const Elements& elements, Bounds<T>& bounds) {
  std::array<std::size_t, n> offsets;
  std::array<T, n> min, max, sum{};
  for (std::size_t c = 0; c < n; ++c) {
    offsets[c] = elements.offset_of(c);
    min[c] = max[c] = load<T>(elements.first + offsets[c]);
  }
  const std::uint8_t* at = elements.first;
  for (std::size_t i = 0; i < elements.count; ++i, at += elements.stride)
    for (std::size_t c = 0; c < n; ++c) {
      const T x = load<T>(at + offsets[c]);
      min[c] = x < min[c] ? x : min[c];
      max[c] = x > max[c] ? x : max[c];
      if constexpr (std::is_floating_point_v<T>) sum[c] += x * T{0};
    }
  for (std::size_t c = 0; c < n; ++c) {
    bounds.min[c] = min[c];
    bounds.max[c] = max[c];
    if (sum[c] != T{0}) bounds.finite = false;
  }
}

template <class T>
Bounds<T> bounds_of(const Elements& elements) {
  Bounds<T> bounds;
  switch (elements.components()) {
    case 1:
      find_bounds<T, 1>(elements, bounds);
      break;
    case 2:
      find_bounds<T, 2>(elements, bounds);
      break;
    case 3:
      find_bounds<T, 3>(elements, bounds);
      break;
    case 4:
      find_bounds<T, 4>(elements, bounds);
      break;
    case 9:
      find_bounds<T, 9>(elements, bounds);
      break;
    default:
      find_bounds<T, 16>(elements, bounds);
  }
  return bounds;
}

template <class T>
std::size_t first_not_finite(const Elements& elements) {
  for (std::size_t i = 0; i < elements.count; ++i)
    for (std::size_t c = 0; c < elements.components(); ++c)
      if (!std::isfinite(static_cast<double>(load<T>(elements.first + i * elements.stride + elements.offset_of(c))))) return i;
  return elements.count;
}

// The numbers that a document declares, as the accessor's components: floats are rounded to float. None where they are no such numbers.
template <class T>
std::optional<std::array<T, 16>> declared(const Json& accessor, const char* key, std::size_t components) {
  const Json& source = array_at(accessor, key);
  if (source.size() != components) return std::nullopt;
  std::array<T, 16> values{};
  for (std::size_t c = 0; c < components; ++c) {
    if (!source[c].is_number()) return std::nullopt;
    const auto x = source[c].get<double>();
    const bool fits = x >= static_cast<double>(std::numeric_limits<T>::lowest()) && x <= static_cast<double>(std::numeric_limits<T>::max());
    if (!fits && std::is_integral_v<T>) return std::nullopt;  // reported as INVALID_GL_VALUE
    values[c] = fits ? static_cast<T>(x) : static_cast<T>(std::copysign(std::numeric_limits<double>::infinity(), x));
  }
  return values;
}

template <class T>
void check_bounds(DataChecks& checks, const Json& accessor, const Elements& elements, const std::string& pointer) {
  const Bounds<T> found = bounds_of<T>(elements);
  if (!found.finite)
    return checks.asset.error("ACCESSOR_INVALID_FLOAT",
                              fmt::format("expected finite numbers, found others, the first in element {}", first_not_finite<T>(elements)),
                              pointer);
  const std::size_t n = elements.components();
  const auto report = [&](const char* key, std::size_t c, T said, T is, const char* mismatch, const char* outside, bool is_outside) {
    const std::string place = fmt::format("{}/{}/{}", pointer, key, c);
    checks.asset.error(mismatch, fmt::format("the document says {}, the elements {}", said, is), place);
    if (is_outside) checks.asset.error(outside, fmt::format("elements reach {}, beyond {}", is, said), place);
  };
  if (const auto min = declared<T>(accessor, "min", n))
    for (std::size_t c = 0; c < n; ++c)
      if ((*min)[c] != found.min[c])
        report("min", c, (*min)[c], found.min[c], "ACCESSOR_MIN_MISMATCH", "ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND", found.min[c] < (*min)[c]);
  if (const auto max = declared<T>(accessor, "max", n))
    for (std::size_t c = 0; c < n; ++c)
      if ((*max)[c] != found.max[c])
        report("max", c, (*max)[c], found.max[c], "ACCESSOR_MAX_MISMATCH", "ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND", found.max[c] > (*max)[c]);
}

}  // namespace

void check_values(DataChecks& checks) {
  const Json& accessors = array_at(checks.asset.json(), "accessors");
  for (std::size_t i = 0; i < accessors.size(); ++i) {
    const std::string pointer = fmt::format("/accessors/{}", i);
    checks.check_sparse_indices(static_cast<std::int64_t>(i));
    const auto elements = checks.elements(static_cast<std::int64_t>(i));
    if (!elements) continue;
    with_type(elements->format.component, [&](auto type) { check_bounds<decltype(type)>(checks, accessors[i], *elements, pointer); });
  }
}

void DataChecks::check_sparse_indices(std::int64_t index) {
  const Accessor* accessor = records.accessor(index);
  if (accessor == nullptr || !accessor->is_sparse) return;
  const Json& sparse = object_at(array_at(asset.json(), "accessors")[static_cast<std::size_t>(index)], "sparse");
  const Json& part = object_at(sparse, "indices");
  const Format format{Shape::scalar, static_cast<int>(uint_of(part, "componentType").value_or(0) & 0xFFFF)};
  const auto elements = placed(index_of(part, "bufferView"), uint_of(part, "byteOffset").value_or(0), uint_of(sparse, "count").value_or(0),
                               component_bytes(format.component), format);
  if (!elements) return;
  const std::string pointer = fmt::format("/accessors/{}/sparse/indices", index);
  with_type(format.component, [&](auto type) {
    double previous = -1;
    for (std::size_t i = 0; i < elements->count; ++i) {
      const double value = value_at<decltype(type)>(*elements, i, 0);
      if (value <= previous)
        asset.error("ACCESSOR_SPARSE_INDICES_NON_INCREASING", fmt::format("expected rising indices, found {} after {}", value, previous),
                    pointer);
      if (value >= static_cast<double>(accessor->count))
        asset.error("ACCESSOR_SPARSE_INDEX_OOB", fmt::format("expected indices below {}, found {}", accessor->count, value), pointer);
      if (value <= previous || value >= static_cast<double>(accessor->count)) return;
      previous = value;
    }
  });
}

}  // namespace etendue::gltf
