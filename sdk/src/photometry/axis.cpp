#include <algorithm>
#include <cmath>

#include "etendue/intensity_web.h"

namespace etendue {

// Cells as narrow as the narrowest interval answer at once; eight cells an interval are the most, then a few steps follow.
AngleAxis::AngleAxis(std::vector<double> nodes) : nodes_(std::move(nodes)) {
  if (nodes_.empty()) return;
  start_ = nodes_.front();
  end_ = nodes_.back();
  if (nodes_.size() < 2) return;
  const std::size_t intervals = nodes_.size() - 1;
  for (std::size_t i = 0; i < intervals; ++i) intervals_.push_back({nodes_[i], 1 / (nodes_[i + 1] - nodes_[i]), nodes_[i + 1]});
  intervals_.back().upper = HUGE_VAL;
  const double step = (end_ - start_) / static_cast<double>(intervals);
  uniform_ = true;
  for (std::size_t i = 0; i <= intervals; ++i) {
    constexpr double rounding = 1e-15;
    uniform_ = uniform_ && std::abs(nodes_[i] - (start_ + static_cast<double>(i) * step)) <= rounding * 720;
  }
  double narrowest = nodes_[1] - nodes_[0];
  for (std::size_t i = 0; i < intervals; ++i) narrowest = std::min(narrowest, nodes_[i + 1] - nodes_[i]);
  const double range = nodes_.back() - nodes_.front();
  const auto cells =
      uniform_ ? intervals : static_cast<std::size_t>(std::clamp(std::ceil(range / narrowest), 1.0, 8.0 * static_cast<double>(intervals)));
  cells_per_unit_ = static_cast<double>(cells) / range;
  last_cell_ = static_cast<double>(cells - 1);
  first_.resize(cells);
  std::uint32_t interval = 0;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const double lower = nodes_.front() + static_cast<double>(cell) / cells_per_unit_;
    while (intervals_[interval].upper <= lower) ++interval;
    first_[cell] = interval;
  }
}

}  // namespace etendue
