#include "rows.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>
#include <vector>

namespace etendue::rendering {

RowRunner::RowRunner(std::uint32_t height, unsigned threads, std::size_t passes, Progress* progress)
    : height_(height),
      threads_(std::clamp(threads == 0 ? std::thread::hardware_concurrency() : threads, 1u, 256u)),
      passes_(std::max<std::size_t>(passes, 1)),
      progress_(progress) {}

bool RowRunner::run(const std::function<void(std::uint32_t, RayCounts&)>& work) {
  std::atomic<std::uint32_t> next = 0;
  std::atomic<bool> cancelled = false;
  std::mutex mutex;
  std::uint32_t done = 0;  // guarded by mutex, as is counts_
  const auto serve = [&] {
    for (std::uint32_t row = next++; row < height_ && !cancelled; row = next++) {
      RayCounts counts;
      work(row, counts);
      const std::lock_guard lock(mutex);
      counts_ += counts;
      ++done;
      const double fraction = (static_cast<double>(done_passes_) + static_cast<double>(done) / height_) / static_cast<double>(passes_);
      if (progress_ != nullptr && !cancelled && !progress_->report("rendering", std::min(fraction, 1.0))) cancelled = true;
    }
  };
  std::vector<std::thread> helpers;
  for (unsigned i = 1; i < threads_; ++i) helpers.emplace_back(serve);
  serve();
  for (std::thread& helper : helpers) helper.join();
  ++done_passes_;
  return !cancelled;
}

}  // namespace etendue::rendering
