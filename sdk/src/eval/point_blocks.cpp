#include "point_blocks.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace etendue::eval {
namespace {

struct Extent {
  std::array<float, 3> low, high;
  explicit Extent(std::span<const PlacedPoint> points) : low{points[0].at[0], points[0].at[1], points[0].at[2]}, high(low) {
    for (const PlacedPoint& p : points) {
      for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], p.at[k]);
        high[k] = std::max(high[k], p.at[k]);
      }
    }
  }
};

constexpr int most_halvings = 11;

// Cells of a box that is halved across its longest edge, again and again: the halves that a point falls into are the digits of its key.
class Cells {
 public:
  Cells(const Extent& box, int halvings) : low_(box.low) {
    std::array<float, 3> edge;
    std::array<int, 3> bits{};
    std::array<int, 16> order{};
    for (std::size_t i = 0; i < 3; ++i) edge[i] = 0.5f * box.high[i] - 0.5f * box.low[i];
    const std::array<float, 3> half = edge;
    for (int k = 0; k < halvings; ++k) {
      const auto longest = static_cast<std::size_t>(std::max_element(edge.begin(), edge.end()) - edge.begin());
      edge[longest] *= 0.5f;
      order[static_cast<std::size_t>(k)] = static_cast<int>(longest);
      ++bits[longest];
    }
    for (std::size_t i = 0; i < 3; ++i) {
      last_[i] = (1 << bits[i]) - 1;
      per_metre_[i] = half[i] > 0 ? 0.5f * static_cast<float>(last_[i] + 1) / half[i] : 0;
      if (!std::isfinite(per_metre_[i])) per_metre_[i] = 0;
    }
    std::array<int, 3> place{};
    for (int k = halvings - 1; k >= 0; --k) {
      const auto axis = static_cast<std::size_t>(order[static_cast<std::size_t>(k)]);
      const std::uint32_t digit = 1u << (halvings - 1 - k);
      for (std::size_t cell = 0; cell <= static_cast<std::size_t>(last_[axis]); ++cell)
        if ((cell >> place[axis]) & 1) part_[axis][cell] |= digit;
      ++place[axis];
    }
  }
  std::uint32_t operator()(const PlacedPoint& p) const { return part(0, p.at[0]) | part(1, p.at[1]) | part(2, p.at[2]); }

 private:
  std::uint32_t part(std::size_t axis, float x) const {
    const float cell = (x - low_[axis]) * per_metre_[axis];
    return part_[axis][static_cast<std::size_t>(cell < static_cast<float>(last_[axis]) ? cell : static_cast<float>(last_[axis]))];
  }
  std::array<float, 3> low_, per_metre_;
  std::array<int, 3> last_;
  std::array<std::array<std::uint32_t, 1 << most_halvings>, 3> part_{};
};

// A face of a cube and one of nine squares on it, the middle one around the axis.
constexpr std::uint32_t directions = 54;
std::uint32_t direction_of(const PlacedPoint& p) {
  const float nx = p.at[3], ny = p.at[4], nz = p.at[5], x = std::abs(nx), y = std::abs(ny), z = std::abs(nz);
  const auto third = [](float a, float longest) { return 3 * a > longest ? 2u : 3 * a < -longest ? 0u : 1u; };
  if (x >= y && x >= z) return (nx < 0 ? 9u : 0u) + 3 * third(ny, x) + third(nz, x);
  if (y >= z) return 18 + (ny < 0 ? 9u : 0u) + 3 * third(nx, y) + third(nz, y);
  return 36 + (nz < 0 ? 9u : 0u) + 3 * third(nx, z) + third(ny, z);
}

// Counting sort by the keys below starts.size() - 1; starts[k] is then the place of the first with key k, the last the number of all.
void sort_by_key(std::span<const PlacedPoint> from, PlacedPoint* to, std::span<std::uint32_t> starts) {
  std::fill(starts.begin(), starts.end(), 0u);
  for (const PlacedPoint& p : from) ++starts[p.key + 1];
  for (std::size_t k = 1; k < starts.size(); ++k) starts[k] += starts[k - 1];
  for (const PlacedPoint& p : from) to[starts[p.key]++] = p;
  for (std::size_t k = starts.size() - 1; k > 0; --k) starts[k] = starts[k - 1];
  starts[0] = 0;
}

}  // namespace

void PointBlocks::arrange(const PointBatch& points, std::size_t first, std::size_t count) {
  points_.clear();
  groups_.clear();
  not_finite_.clear();
  points_.reserve(count);
  for (std::size_t i = first; i < first + count; ++i) {
    const PlacedPoint p{
        {points.px[i], points.py[i], points.pz[i], points.nx[i], points.ny[i], points.nz[i]}, static_cast<std::uint32_t>(i - first), 0};
    const bool finite = std::all_of(p.at.begin(), p.at.end(), [](float x) { return std::isfinite(x); });
    if (finite)
      points_.push_back(p);
    else
      not_finite_.push_back(p.index);
  }
  other_.resize(points_.size());
  if (!points_.empty()) divide({0, points_.size()}, false, 0);
}

void PointBlocks::divide(Range range, bool moved, int depth) {
  const auto finish = [&](Range group, bool in_other) {
    for (; group.count > longest_group; group.first += longest_group, group.count -= longest_group)
      groups_.push_back({{group.first, longest_group}, in_other});
    groups_.push_back({group, in_other});
  };
  // Deeper only where points lie at ever smaller scales.
  if (range.count <= longest_group || depth > 40) return finish(range, moved);
  const std::span<PlacedPoint> all(buffer(moved) + range.first, range.count);
  const int halvings = std::clamp(static_cast<int>(std::bit_width(2 * range.count / longest_group)), 1, most_halvings);
  const Cells cells(Extent(all), halvings);
  for (PlacedPoint& p : all) p.key = cells(p);
  std::array<std::uint32_t, (1u << most_halvings) + 1> places;
  const std::span<std::uint32_t> starts(places.data(), (std::size_t{1} << halvings) + 1);
  sort_by_key(all, buffer(!moved) + range.first, starts);
  Range pending{range.first, 0};
  for (std::size_t k = 0; k + 1 < starts.size(); ++k) {
    const Range cell{range.first + starts[k], starts[k + 1] - starts[k]};
    if (pending.count > 0 && pending.count + cell.count > longest_group) {
      finish(pending, !moved);
      pending = {cell.first, 0};
    }
    if (cell.count > longest_group) {
      divide(cell, !moved, depth + 1);
      pending = {cell.first + cell.count, 0};
    } else {
      pending.count += cell.count;
    }
  }
  if (pending.count > 0) finish(pending, !moved);
}

std::span<const PlacedPoint> PointBlocks::runs_of(const Group& group, std::vector<Range>& runs) {
  constexpr int halvings = 6;
  const std::span<PlacedPoint> all(buffer(group.moved) + group.range.first, group.range.count);
  PlacedPoint* const ordered = buffer(!group.moved) + group.range.first;
  starts_.resize((directions << halvings) + 1);
  const Cells cells(Extent(all), halvings);
  for (PlacedPoint& p : all) p.key = (direction_of(p) << halvings) + cells(p);
  sort_by_key(all, ordered, starts_);
  runs.clear();
  for (std::uint32_t direction = 0; direction < directions; ++direction) {
    const std::size_t first = starts_[direction << halvings], end = starts_[(direction + 1) << halvings];
    if (end > first) runs.push_back({first, end - first});
  }
  return {ordered, all.size()};
}

}  // namespace etendue::eval
