// Run time against error of every method for the diffuse light of one shape, measured: lights and points at random, exact light in double.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "etendue/result.h"

namespace etendue::cli {

// Lights of a luminance of 1 cd/m2, wholly above the horizon or across it.
struct DiffuseFigures {
  double ns = 0;        // a point
  double agg = 0;       // sum |error| / sum of the exact values
  double mean_rel = 0;  // of the relative error
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
struct DiffuseTable {
  std::string shape;
  std::uint64_t samples, seed;  // samples: points a side of the horizon
  std::string instruction_set;
  double peak_gflops = 0;  // of fused multiply-adds in floats, measured in the same turns
  std::vector<DiffuseRow> rows;
};

// A published method is matched where one of ours that errs no more costs at most this many times as much.
inline constexpr double matched_ratio = 1.05;

struct DiffuseBench {
  std::string shape = "rect";  // rect, sphere, disk or tube
  std::uint64_t samples = 16384, seed = 1;
  int rounds = 41;
};
// `report` says how much is done, 0 to 1; false cancels. Errors: CANCELLED.
Result<DiffuseTable> run_diffuse_bench(const DiffuseBench& bench, const std::function<bool(double)>& report);

// Floating-point operations, a multiplication and an addition each counted, of a loop of independent fused multiply-adds.
double multiply_adds(std::size_t turns);
std::string best_instruction_set();

// Time against the aggregate error of both sides of the horizon, each a panel.
std::string diffuse_scatter(const DiffuseTable& table);

}  // namespace etendue::cli
