// Run time against error of methods for the specular light of one shape: GGX, height-correlated masking, Schlick's Fresnel, against the
// adaptive reference in double.
#pragma once

#include <array>

#include "bench_table.h"
#include "etendue/result.h"

namespace etendue::cli {

inline constexpr std::array<const char*, 4> specular_bench_shapes{"rect", "sphere", "disk", "tube"};
struct SpecularBench {
  std::string shape = "rect";  // one of specular_bench_shapes
  double f0 = 1;
  std::vector<double> alphas{0.01, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1};  // of the points, in turn
  std::uint64_t samples = 16384, seed = 1;
  int rounds = 21;
};
// Half of the views have the mirror direction within the light, half are uniform with a cosine from .05 on. `report` says how much is done,
// 0 to 1; false cancels. Errors: CANCELLED.
Result<MethodTable> run_specular_bench(const SpecularBench& bench, const std::function<bool(double)>& report);

}  // namespace etendue::cli
