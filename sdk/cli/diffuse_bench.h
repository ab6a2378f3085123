// Run time against error of every method for the diffuse light of one shape, measured: lights and points at random, exact light in double.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "etendue/result.h"

namespace etendue::cli {

// Lights of a luminance of 1 cd/m2, wholly above the horizon or across it.
struct DiffuseFigures {
  double ns = 0;              // a point, on the best instruction set
  std::vector<double> ns_on;  // on each of the table's instruction sets
  double agg = 0;             // sum |error| / sum of the exact values
  double mean_rel = 0;        // of the relative error
  double p99 = 0;
  double max_abs = 0;
  bool exact = false;  // but for about the rounding of floats
  // Of a published method: the quickest of ours that errs no more, by agg and p99, and its time over this one's.
  std::string ours;
  double ratio = 0;
};
struct DiffuseRow {
  std::string_view method, note;
  bool is_ours = false;
  DiffuseFigures above, across;
};
struct InstructionSet {
  std::string name;
  std::int64_t target;     // Highway's
  double peak_gflops = 0;  // of multiply-adds in floats, fused where the set has such, measured in the same turns as the methods
};
struct DiffuseTable {
  std::string shape;
  std::uint64_t samples, seed;                   // samples: points a side of the horizon
  std::vector<InstructionSet> instruction_sets;  // the best first
  std::vector<DiffuseRow> rows;
};

// A published method is matched where one of ours that errs no more costs at most this many times as much.
inline constexpr double matched_ratio = 1.05;

// Of a line and a point light there is the closed form alone.
inline constexpr std::array<const char*, 6> bench_shapes{"rect", "sphere", "disk", "tube", "line", "point"};
struct DiffuseBench {
  std::string shape = "rect";  // one of bench_shapes
  std::uint64_t samples = 131072, seed = 1;
  int rounds = 21;
};
// `report` says how much is done, 0 to 1; false cancels. Errors: CANCELLED.
Result<DiffuseTable> run_diffuse_bench(const DiffuseBench& bench, const std::function<bool(double)>& report);

// The machine's best, and AVX2 and SSE4 where they are others that it has.
std::vector<InstructionSet> measured_instruction_sets();
// While it lives, kernels run on that set. Not for several threads.
class OnInstructionSet {
 public:
  explicit OnInstructionSet(const InstructionSet& set);
  ~OnInstructionSet();
  OnInstructionSet(const OnInstructionSet&) = delete;
  OnInstructionSet& operator=(const OnInstructionSet&) = delete;
};

// Floating-point operations, a multiplication and an addition each counted, of a loop of independent fused multiply-adds.
double multiply_adds(std::size_t turns);

// Time against the aggregate error of both sides of the horizon, each a panel.
std::string diffuse_scatter(const DiffuseTable& table);

}  // namespace etendue::cli
