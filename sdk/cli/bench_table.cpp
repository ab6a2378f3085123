// Errors and times of methods, and who of ours is as good as a published one.
#include "bench_table.h"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace etendue::cli {
namespace {

// What closed forms in floats have left: an error below these is none.
constexpr double exact_agg = 1e-6, exact_p99 = 1e-5;
// Those that are closed forms but for fits of single precision and clamps are named so too.
constexpr double exact_named = 3e-6;
// Relative errors of less light than this say nothing.
constexpr double least_light = 1e-3;

bool errs_no_more(const MethodFigures& ours, const MethodFigures& published) {
  constexpr double rounding = 1 + 1e-6;
  return ours.agg <= std::max(published.agg * rounding, exact_agg) && ours.p99 <= std::max(published.p99 * rounding, exact_p99);
}

// Of the processor's time, of which what else runs on the machine takes none.
double seconds_of(const std::function<void()>& run) {
  const std::clock_t begin = std::clock();
  run();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

}  // namespace

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

MethodFigures errors_of(std::span<const double> values, std::span<const double> exact) {
  MethodFigures f;
  double errors = 0, sum = 0;
  std::vector<double> relative;
  relative.reserve(exact.size());
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double error = std::abs(values[i] - exact[i]);
    errors += error, sum += exact[i];
    f.max_abs = std::max(f.max_abs, error);
    if (exact[i] < least_light && error > 0) continue;
    relative.push_back(error > 0 ? error / exact[i] : 0);  // set: nothing, and exactly so
    f.mean_rel += relative.back();
  }
  f.agg = sum > 0 ? errors / sum : 0;
  f.exact = f.agg < exact_named;
  if (relative.empty()) return f;
  f.mean_rel /= static_cast<double>(relative.size());
  const auto rank = relative.begin() + static_cast<std::ptrdiff_t>(relative.size() * 99 / 100);
  std::nth_element(relative.begin(), rank, relative.end());
  f.p99 = *rank;
  return f;
}

void find_matches(std::vector<MethodRow>& rows, MethodFigures MethodRow::*side) {
  for (MethodRow& row : rows) {
    if (row.is_ours || row.one_by_one) continue;
    MethodFigures& published = row.*side;
    for (const MethodRow& candidate : rows) {
      const MethodFigures& ours = candidate.*side;
      if (!candidate.is_ours || candidate.one_by_one || !errs_no_more(ours, published)) continue;
      const double ratio = ours.ns / published.ns;
      if (published.ours.empty() || ratio < published.ratio) published.ours = candidate.method, published.ratio = ratio;
    }
  }
}

std::optional<std::vector<std::vector<double>>> measured_seconds(std::span<const MethodCall> calls, std::size_t lights,
                                                                 std::span<const InstructionSet> sets, int rounds,
                                                                 std::vector<std::vector<double>>& gflops,
                                                                 const std::function<bool(double)>& report) {
  constexpr std::size_t turns_a_light = 4;
  std::vector<std::vector<std::vector<double>>> seconds(calls.size(), std::vector<std::vector<double>>(sets.size()));
  for (int round = 0; round < rounds; ++round) {
    if (!report(static_cast<double>(round) / rounds)) return std::nullopt;
    for (std::size_t k = 0; k < sets.size(); ++k) {
      const OnInstructionSet on(sets[k]);
      constexpr std::size_t turns = 20000;
      multiply_adds(turns);  // the first call pays for the choice of the set and for waking wide registers
      double operations = 0;
      const double taken = seconds_of([&] { operations = multiply_adds(turns); });
      gflops[k].push_back(1e-9 * operations / taken);
      for (std::size_t c = 0; c < calls.size(); ++c) {
        seconds[c][k].push_back(seconds_of([&] {
          for (std::size_t i = 0; i < lights; ++i) {
            for (std::size_t turn = 0; turn < turns_a_light; ++turn) calls[c](i);
          }
        }));
      }
    }
  }
  std::vector<std::vector<double>> medians(calls.size());
  for (std::size_t c = 0; c < calls.size(); ++c) {
    for (const std::vector<double>& s : seconds[c])
      medians[c].push_back(median(s) / static_cast<double>(turns_a_light * lights * bench_batch));
  }
  return medians;
}

}  // namespace etendue::cli
