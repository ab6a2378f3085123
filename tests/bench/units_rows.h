// The tasks of bench_units, a function a file.
#pragma once

#include "bench.h"

#include <functional>
#include <span>
#include <string>

namespace etendue::bench {

inline constexpr std::size_t batch_size = 4096;  // 16 KiB of floats

void exposure_rows(Bench& bench);
void colour_rows(Bench& bench);
void pixel_rows(Bench& bench);
void text_rows(Bench& bench);

// Every task's first row: out = in x factor, which no conversion can be faster than, compiled for this machine (native.cpp).
void bare_multiply(std::span<const float> in, float factor, std::span<float> out);
inline void add_bare_multiply(Task& task, std::span<const float> in, std::span<float> out) {
  task.contender("bare multiply", Kind::anchor, "", [in, out] {
    bare_multiply(in, 0.0795774715f, out);
    keep(out.data());
  });
}

}  // namespace etendue::bench
