#include "contours.h"

#include <algorithm>
#include <array>
#include <unordered_map>

namespace etendue::cli {

ContourGrid::ContourGrid(std::size_t size, const std::function<double(double, double)>& value) : size_(size) {
  values_.reserve(size * size);
  for (std::size_t row = 0; row < size; ++row)
    for (std::size_t column = 0; column < size; ++column) {
      values_.push_back(value(static_cast<double>(column), static_cast<double>(row)));
      largest_ = std::max(largest_, values_.back());
    }
}

double ContourGrid::at(std::ptrdiff_t column, std::ptrdiff_t row) const {
  const auto size = static_cast<std::ptrdiff_t>(size_);
  if (column < 0 || row < 0 || column >= size || row >= size) return 0;
  return values_[static_cast<std::size_t>(row * size + column)];
}

double ContourGrid::largest_on_border() const {
  double most = 0;
  const auto last = static_cast<std::ptrdiff_t>(size_) - 1;
  for (std::ptrdiff_t i = 0; i <= last; ++i) most = std::max({most, at(i, 0), at(i, last), at(0, i), at(last, i)});
  return most;
}

// Marching squares with one node of nothing around. Each crossed edge of a cell has a number of its own; a cell joins two of its edges, or
// two pairs where opposite corners alone are above, which are kept apart or joined by the mean of the cell. Every crossed edge lies between
// two cells, so the pieces chain into closed loops.
std::vector<std::vector<Vec2d>> ContourGrid::loops(double level) const {
  const auto size = static_cast<std::ptrdiff_t>(size_);
  const std::ptrdiff_t row_of_edges = 2 * (size + 2);
  struct Ends {
    std::array<std::ptrdiff_t, 2> next{-1, -1};
  };
  std::unordered_map<std::ptrdiff_t, Ends> joined;
  std::unordered_map<std::ptrdiff_t, Vec2d> place;
  const auto join = [&](std::ptrdiff_t a, std::ptrdiff_t b) {
    Ends& from = joined[a];
    from.next[from.next[0] < 0 ? 0 : 1] = b;
    Ends& to = joined[b];
    to.next[to.next[0] < 0 ? 0 : 1] = a;
  };
  for (std::ptrdiff_t row = -1; row < size; ++row) {
    for (std::ptrdiff_t column = -1; column < size; ++column) {
      const std::array<double, 4> v{at(column, row), at(column + 1, row), at(column + 1, row + 1), at(column, row + 1)};
      int above = 0;
      for (int k = 0; k < 4; ++k) above |= v[static_cast<std::size_t>(k)] > level ? 1 << k : 0;
      if (above == 0 || above == 15) continue;
      const auto x = static_cast<double>(column), y = static_cast<double>(row);
      // Edges: top, right, bottom, left; the top and the left one are the cell's own, the others its neighbours'.
      const std::array<std::ptrdiff_t, 4> edge{(row + 1) * row_of_edges + 2 * (column + 1), (row + 1) * row_of_edges + 2 * (column + 2) + 1,
                                               (row + 2) * row_of_edges + 2 * (column + 1),
                                               (row + 1) * row_of_edges + 2 * (column + 1) + 1};
      const auto between = [&](std::size_t a, std::size_t b) { return (level - v[a]) / (v[b] - v[a]); };
      const auto crossed = [&](int a, int b) { return ((above >> a) & 1) != ((above >> b) & 1); };
      if (crossed(0, 1)) place[edge[0]] = {x + between(0, 1), y};
      if (crossed(1, 2)) place[edge[1]] = {x + 1, y + between(1, 2)};
      if (crossed(2, 3)) place[edge[2]] = {x + between(3, 2), y + 1};
      if (crossed(3, 0)) place[edge[3]] = {x, y + between(0, 3)};
      if (above == 5 || above == 10) {
        const bool middle_above = (v[0] + v[1] + v[2] + v[3]) / 4 > level;
        const bool around_0_and_2 = (above == 5) != middle_above;
        join(edge[3], around_0_and_2 ? edge[0] : edge[2]);
        join(edge[1], around_0_and_2 ? edge[2] : edge[0]);
        continue;
      }
      std::array<std::ptrdiff_t, 2> ends{-1, -1};
      std::size_t found = 0;
      for (int k = 0; k < 4; ++k)
        if (crossed(k, (k + 1) % 4)) ends[found++] = edge[static_cast<std::size_t>(k)];
      join(ends[0], ends[1]);
    }
  }
  std::vector<std::ptrdiff_t> order;
  order.reserve(joined.size());
  for (const auto& entry : joined) order.push_back(entry.first);
  std::sort(order.begin(), order.end());
  std::vector<std::vector<Vec2d>> loops;
  for (const std::ptrdiff_t start : order) {
    if (joined[start].next[0] < 0) continue;
    std::vector<Vec2d> loop;
    for (std::ptrdiff_t here = start, from = -1; here >= 0;) {
      Ends& ends = joined[here];
      if (ends.next[0] < 0) break;
      const std::ptrdiff_t next = ends.next[0] == from ? ends.next[1] : ends.next[0];
      loop.push_back(place[here]);
      ends.next = {-1, -1};
      from = here;
      here = next;
    }
    if (loop.size() > 2) loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace etendue::cli
