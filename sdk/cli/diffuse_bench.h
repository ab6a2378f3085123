// Run time against error of every method for the diffuse light of one shape: lights and points at random, exact light in double.
#pragma once

#include <array>

#include "bench_table.h"
#include "etendue/result.h"

namespace etendue::cli {

// Of a line and a point light there is the closed form alone.
inline constexpr std::array<const char*, 6> bench_shapes{"rect", "sphere", "disk", "tube", "line", "point"};
struct DiffuseBench {
  std::string shape = "rect";  // one of bench_shapes
  std::uint64_t samples = 131072, seed = 1;
  int rounds = 21;
};
// `report` says how much is done, 0 to 1; false cancels. Errors: CANCELLED.
Result<MethodTable> run_diffuse_bench(const DiffuseBench& bench, const std::function<bool(double)>& report);

}  // namespace etendue::cli
