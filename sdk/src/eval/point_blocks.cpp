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

// A face of a cube and one of nine squares on it, the middle one around the axis; and what is not finite.
constexpr std::uint8_t directions = 54, not_a_number = directions;
std::uint8_t direction_of(float nx, float ny, float nz) {
  const float x = std::abs(nx), y = std::abs(ny), z = std::abs(nz);
  const auto square = [](int face, float a, float b, float longest) {
    const auto third = [longest](float c) { return (3 * c > -longest ? 1 : 0) + (3 * c > longest ? 1 : 0); };
    return static_cast<std::uint8_t>(9 * face + 3 * third(a) + third(b));
  };
  if (x >= y && x >= z) return square(nx < 0 ? 1 : 0, ny, nz, x);
  if (y >= z) return square(ny < 0 ? 3 : 2, nx, nz, y);
  return square(nz < 0 ? 5 : 4, nx, ny, z);
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
  groups_.clear();
  not_finite_.clear();
  directions_.resize(count);
  std::array<std::size_t, directions + 1> places{};
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = first + i;
    const float nx = points.nx[k], ny = points.ny[k], nz = points.nz[k];
    const bool finite = std::isfinite(points.px[k]) && std::isfinite(points.py[k]) && std::isfinite(points.pz[k]) && std::isfinite(nx) &&
                        std::isfinite(ny) && std::isfinite(nz);
    directions_[i] = finite ? direction_of(nx, ny, nz) : not_a_number;
    ++places[directions_[i]];
    if (!finite) not_finite_.push_back(static_cast<std::uint32_t>(i));
  }
  points_.resize(count);
  other_.resize(count);
  std::array<Group, directions> whole{};
  for (std::size_t d = 0, at = 0; d < directions; ++d) {
    whole[d] = {at, places[d], false};
    at += std::exchange(places[d], at);
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (directions_[i] == not_a_number) continue;
    const std::size_t k = first + i;
    points_[places[directions_[i]]++] = {
        {points.px[k], points.py[k], points.pz[k], points.nx[k], points.ny[k], points.nz[k]}, static_cast<std::uint32_t>(i), 0};
  }
  for (const Group& alike : whole)
    if (alike.count > 0) divide(alike, 0);
}

void PointBlocks::divide(const Group& points, int depth) {
  const auto finish = [&](Group group) {
    for (; group.count > longest_group; group.first += longest_group, group.count -= longest_group)
      groups_.push_back({group.first, longest_group, group.moved});
    groups_.push_back(group);
  };
  // Deeper only where points lie at ever smaller scales.
  if (points.count <= longest_group || depth > 40) return finish(points);
  const std::span<PlacedPoint> all(buffer(points.moved) + points.first, points.count);
  const int halvings = std::clamp(static_cast<int>(std::bit_width(2 * points.count / longest_group)), 1, most_halvings);
  const Cells cells(Extent(all), halvings);
  for (PlacedPoint& p : all) p.key = cells(p);
  std::array<std::uint32_t, (1u << most_halvings) + 1> places;
  const std::span<std::uint32_t> starts(places.data(), (std::size_t{1} << halvings) + 1);
  sort_by_key(all, buffer(!points.moved) + points.first, starts);
  Group pending{points.first, 0, !points.moved};
  for (std::size_t k = 0; k + 1 < starts.size(); ++k) {
    const Group cell{points.first + starts[k], starts[k + 1] - starts[k], !points.moved};
    if (pending.count > 0 && pending.count + cell.count > longest_group) {
      finish(pending);
      pending = {cell.first, 0, cell.moved};
    }
    if (cell.count > longest_group) {
      divide(cell, depth + 1);
      pending = {cell.first + cell.count, 0, cell.moved};
    } else {
      pending.count += cell.count;
    }
  }
  if (pending.count > 0) finish(pending);
}

std::span<const PlacedPoint> PointBlocks::ordered(const Group& group) {
  constexpr int halvings = 7;
  const std::span<PlacedPoint> all(buffer(group.moved) + group.first, group.count);
  const Cells cells(Extent(all), halvings);
  for (PlacedPoint& p : all) p.key = cells(p);
  std::array<std::uint32_t, (1u << halvings) + 1> starts;
  PlacedPoint* const to = buffer(!group.moved) + group.first;
  sort_by_key(all, to, starts);
  return {to, all.size()};
}

}  // namespace etendue::eval
