// Room for results that Python owns once it is an array.
#pragma once

#include "elementwise.h"

#include <cstddef>
#include <span>

namespace etendue::python {

template <class T>
struct Owned {
  explicit Owned(std::size_t size)
      : count(size), values(new T[size + 1]), owner(values, [](void* p) noexcept { delete[] static_cast<T*>(p); }) {}
  NewArray<T> array(const Extents& extents) const { return NewArray<T>(values, extents.size(), extents.data(), owner); }
  std::span<T> span() const { return {values, count}; }

  std::size_t count;
  T* values;
  nb::capsule owner;
};

}  // namespace etendue::python
