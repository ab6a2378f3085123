// Rows of a picture, shared out to threads. The result must not depend on who does which row.
#pragma once

#include "probe.h"

#include "etendue/io.h"

#include <functional>

namespace etendue::rendering {

class RowRunner {
 public:
  // `passes`: how often run() will be called, for the progress shown.
  RowRunner(std::uint32_t height, unsigned threads, std::size_t passes, Progress* progress);

  // Calls `work` once for each row. False: cancelled, and rows are missing.
  bool run(const std::function<void(std::uint32_t row, RayCounts& counts)>& work);
  const RayCounts& counts() const { return counts_; }

 private:
  std::uint32_t height_;
  unsigned threads_;
  std::size_t passes_, done_passes_ = 0;
  Progress* progress_;
  RayCounts counts_;
};

}  // namespace etendue::rendering
