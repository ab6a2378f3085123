// Results as Python has them: the value, or etendue.Error raised.
#pragma once

#include "etendue/result.h"

#include <nanobind/nanobind.h>

#include <cstddef>
#include <span>
#include <utility>

namespace etendue::python {

// Raises etendue.Error. `index`: of the element that it is about, where that is one of an array.
[[noreturn]] void raise(const Error& error, std::span<const std::size_t> index = {});

template <class T>
T unwrap(Result<T> result) {
  if (!result) raise(result.error());
  return std::move(*result);
}

}  // namespace etendue::python
