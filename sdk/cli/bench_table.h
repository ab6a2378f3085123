// Run time against error of methods for the light of one shape, measured: what `etendue bench` prints and draws.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace etendue::cli {

// Lights of a luminance of 1 cd/m2, wholly above the horizon or across it.
struct MethodFigures {
  double ns = 0;              // a point, on the best instruction set
  std::vector<double> ns_on;  // on each of the table's instruction sets
  double agg = 0;             // sum |error| / sum of the exact values
  double mean_rel = 0;        // of the relative error
  double p99 = 0;
  double max_abs = 0;
  bool exact = false;  // but for about the rounding of floats
  // Of a published method in vectors: the quickest of ours that errs no more, by agg and p99, and its time over this one's.
  std::string ours;
  double ratio = 0;
};
struct MethodRow {
  std::string_view method, note;
  bool is_ours = false;
  bool one_by_one = false;  // in double, not in vectors: its time is no measure of the method
  MethodFigures above, across;
};
struct InstructionSet {
  std::string name;
  std::int64_t target;     // Highway's
  double peak_gflops = 0;  // of multiply-adds in floats, fused where the set has such, measured in the same turns as the methods
};
struct MethodTable {
  std::string shape, light;                      // light: what of it, as a heading says it
  std::uint64_t samples, seed;                   // samples: points a side of the horizon
  std::vector<InstructionSet> instruction_sets;  // the best first
  std::vector<MethodRow> rows;
  std::optional<MethodRow> yardstick;  // what times are told as multiples of: its times alone count
};

// A published method is matched where one of ours that errs no more costs at most this many times as much.
inline constexpr double matched_ratio = 1.05;
void find_matches(std::vector<MethodRow>& rows, MethodFigures MethodRow::*side);

// Of values in floats or doubles against the exact ones.
MethodFigures errors_of(std::span<const double> values, std::span<const double> exact);

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

constexpr std::size_t bench_batch = 4096;  // points a light, several times in a row: from a cache, and what a light costs once is little
// What a method does for one light.
using MethodCall = std::function<void(std::size_t light)>;
// Median seconds of the processor's time of each call on each instruction set, [call][set], a point of so many lights, in turns; `gflops`
// gets what multiply-adds reach in the same turns, a list for each set. Nothing if `report`, which is told how much is done, says false.
std::optional<std::vector<std::vector<double>>> measured_seconds(std::span<const MethodCall> calls, std::size_t lights,
                                                                 std::span<const InstructionSet> sets, int rounds,
                                                                 std::vector<std::vector<double>>& gflops,
                                                                 const std::function<bool(double)>& report);
double median(std::vector<double> values);

// Time against the aggregate error of both sides of the horizon, each a panel.
std::string method_scatter(const MethodTable& table);

}  // namespace etendue::cli
