// What the compiler makes of plain loops for this very machine: compiled with -march=native.
#include "units_rows.h"

namespace etendue::bench {

void bare_multiply(std::span<const float> in, float factor, std::span<float> out) {
  const float* __restrict from = in.data();
  float* __restrict to = out.data();
  const std::size_t count = in.size();
  for (std::size_t i = 0; i < count; ++i) to[i] = from[i] * factor;
}

}  // namespace etendue::bench
