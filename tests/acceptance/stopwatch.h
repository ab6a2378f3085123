// Time of many pieces of work together.
#pragma once

#include <chrono>

class Stopwatch {
 public:
  template <class Work>
  auto operator()(Work work) {
    const auto start = std::chrono::steady_clock::now();
    auto result = work();
    total_ += std::chrono::steady_clock::now() - start;
    return result;
  }
  double seconds() const { return std::chrono::duration<double>(total_).count(); }

 private:
  std::chrono::steady_clock::duration total_{};
};
