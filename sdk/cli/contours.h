// Lines of equal value through a grid of values.
#pragma once

#include <functional>
#include <vector>

#include "etendue/vec.h"

namespace etendue::cli {

// Values on a square of `size` x `size` nodes, in node coordinates: column, row.
class ContourGrid {
 public:
  ContourGrid(std::size_t size, const std::function<double(double column, double row)>& value);
  double largest() const { return largest_; }
  double largest_on_border() const;
  // Closed loops around everything above `level`, linear between the nodes; outside of the square nothing is above. With even-odd filling
  // they bound that area.
  std::vector<std::vector<Vec2d>> loops(double level) const;

 private:
  double at(std::ptrdiff_t column, std::ptrdiff_t row) const;  // also one node outside of the square
  std::size_t size_;
  double largest_ = 0;
  std::vector<double> values_;
};

}  // namespace etendue::cli
