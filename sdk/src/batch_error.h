// What batches say when an output does not fit its input.
#pragma once

#include "etendue/result.h"

#include <fmt/format.h>

#include <cstddef>

namespace etendue {

inline Error batch_sizes_differ(std::size_t in, std::size_t out) {
  return {"BATCH_SIZES_DIFFER", fmt::format("expected an output of {} elements, as many as the input has, found {}", in, out), {}, {}, {}};
}

}  // namespace etendue
