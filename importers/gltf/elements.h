// The elements of an accessor where they lie, for the checks of contents: no copy unless some of them are sparse.
#pragma once

#include "etendue/bytes.h"
#include "records.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

namespace etendue::gltf {

struct Elements {
  SharedBytes owner;
  const std::uint8_t* first = nullptr;
  std::size_t stride = 0, count = 0;
  Format format;

  std::size_t components() const { return components_of(format.shape); }
  // Of a component in its element: columns of matrices begin at multiples of 4 bytes.
  std::size_t offset_of(std::size_t component) const {
    const std::size_t size = component_bytes(format.component);
    const std::size_t rows = format.shape == Shape::mat2 ? 2 : format.shape == Shape::mat3 ? 3 : 4;
    if (format.shape < Shape::mat2) return component * size;
    return component / rows * ((rows * size + 3) / 4 * 4) + component % rows * size;
  }
};

// glTF is little-endian, as are all machines we build for.
template <class T>
T load(const std::uint8_t* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

// Calls visit(T{}) with the type of the components.
template <class Visit>
void with_type(int component, const Visit& visit) {
  switch (component) {
    case 5120:
      return visit(std::int8_t{});
    case 5121:
      return visit(std::uint8_t{});
    case 5122:
      return visit(std::int16_t{});
    case 5123:
      return visit(std::uint16_t{});
    case 5125:
      return visit(std::uint32_t{});
    case 5126:
      return visit(float{});
    default:
      return;
  }
}

// 3.6.2.2: normalised unsigned c / (2^n - 1), signed max(c / (2^(n-1) - 1), -1).
template <class T>
double value_at(const Elements& elements, std::size_t element, std::size_t component) {
  const auto value = static_cast<double>(load<T>(elements.first + element * elements.stride + component * sizeof(T)));
  if constexpr (std::is_integral_v<T>) {
    if (elements.format.normalised) return std::max(value / static_cast<double>(std::numeric_limits<T>::max()), -1.0);
  }
  return value;
}

}  // namespace etendue::gltf
