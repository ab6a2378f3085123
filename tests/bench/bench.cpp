#include "bench.h"

#include <fmt/format.h>
#include <hwy/highway.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <fstream>
#include <string_view>

namespace etendue::bench {
namespace {

double seconds_of(const std::function<void()>& run, long repetitions) {
  const auto begin = std::chrono::steady_clock::now();
  for (long i = 0; i < repetitions; ++i) run();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::string_view word_of(Kind kind) { return kind == Kind::anchor ? "anchor" : kind == Kind::ours ? "ours" : "peer"; }

void print(const std::list<Task>& tasks) {
  fmt::print("{}\nns an element, one thread; medians of interleaved turns; ratio to the first row of each task\n", machine());
  for (const Task& task : tasks) {
    fmt::print("\n{}\n", task.name());
    for (const Contender& c : task.contenders())
      fmt::print("  {:<44} {:>9.3f} ns {:>9.3f} x  {:<6}  {}{}{}\n", c.name, c.ns, c.ratio, word_of(c.kind), c.error,
                 c.note.empty() ? "" : "; ", c.note);
  }
}

void print_json(const std::list<Task>& tasks) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const Task& task : tasks)
    for (const Contender& c : task.contenders()) {
      nlohmann::ordered_json row = {{"task", task.name()}, {"method", c.name}, {"kind", word_of(c.kind)},
                                    {"ns", c.ns},          {"ratio", c.ratio}, {"error", c.error}};
      if (!c.note.empty()) row["note"] = c.note;
      rows.push_back(row);
    }
  const nlohmann::ordered_json document = {{"schema", "etendue.bench/1"}, {"machine", machine()}, {"result", rows}};
  fmt::print("{}\n", document.dump(1));
}

}  // namespace

void Task::contender(std::string name, Kind kind, std::string error, std::function<void()> run, std::string note) {
  contenders_.push_back({std::move(name), kind, std::move(error), std::move(run), std::move(note)});
}

void Task::measure(int rounds, double turn_ms) {
  const auto count = contenders_.size();
  std::vector<long> repetitions(count, 1);
  for (std::size_t i = 0; i < count; ++i) {
    double taken = seconds_of(contenders_[i].run, 1);  // the first run also builds tables
    while (taken < 1e-3 * turn_ms / 4) {
      repetitions[i] *= 2;
      taken = seconds_of(contenders_[i].run, repetitions[i]);
    }
    repetitions[i] = std::max(1L, static_cast<long>(static_cast<double>(repetitions[i]) * 1e-3 * turn_ms / taken));
  }
  std::vector<std::vector<double>> ns(count), ratios(count);
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < count; ++i) {
      const double each = seconds_of(contenders_[i].run, repetitions[i]) / static_cast<double>(repetitions[i]);
      ns[i].push_back(1e9 * each / static_cast<double>(elements_));
      ratios[i].push_back(ns[i].back() / ns[0].back());
    }
  for (std::size_t i = 0; i < count; ++i) {
    contenders_[i].ns = median(ns[i]);
    contenders_[i].ratio = median(ratios[i]);
  }
}

int Bench::run(int argc, char** argv) {
  bool json = false;
  int rounds = 101;
  double turn_ms = 0.25;  // short beside a scheduler's slice: on a busy machine most turns are still undisturbed
  std::string_view only;
  for (int i = 1; i < argc; ++i) {
    const std::string_view option = argv[i];
    const char* value = i + 1 < argc ? argv[i + 1] : nullptr;
    if (option == "--json") {
      json = true;
      continue;
    }
    if (option == "--rounds" && value != nullptr)
      rounds = std::max(1, std::atoi(value));
    else if (option == "--turn-ms" && value != nullptr)
      turn_ms = std::atof(value);
    else if (option == "--only" && value != nullptr)
      only = value;
    else {
      fmt::print(stderr, "usage: {} [--json] [--only TEXT] [--rounds N] [--turn-ms X]\n", argv[0]);
      return 2;
    }
    ++i;
  }
  for (auto task = tasks_.begin(); task != tasks_.end();) {
    const auto next = std::next(task);
    if (task->name().find(only) == std::string::npos) left_out_.splice(left_out_.end(), tasks_, task);
    task = next;
  }
  for (Task& task : tasks_) task.measure(rounds, turn_ms);
  json ? print_json(tasks_) : print(tasks_);
  return 0;
}

std::string machine() {
  std::string processor = "unknown processor";
  std::ifstream cpuinfo("/proc/cpuinfo");  // Linux; elsewhere the processor stays unknown
  for (std::string line; std::getline(cpuinfo, line);)
    if (line.starts_with("model name")) {
      processor = line.substr(line.find(':') + 2);
      break;
    }
  const int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
#if defined(__clang__)
  const char* compiler = "clang " __clang_version__;
#else
  const char* compiler = "g++ " __VERSION__;
#endif
  return fmt::format("{}, {}, {}", processor, hwy::TargetName(supported & -supported), compiler);
}

}  // namespace etendue::bench
