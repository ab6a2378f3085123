#include "specular_first_cells.h"

#include "lobe_grading.h"

#include <algorithm>
#include <array>

namespace etendue::eval {
namespace {

constexpr std::size_t most_marks = 24;
template <class T>
struct Marks {
  std::array<T, most_marks> at;
  std::size_t count = 1;
  explicit Marks(T first) { at[0] = first; }
  void close(T last) {
    if (count > 2) std::sort(at.begin(), at.begin() + static_cast<std::ptrdiff_t>(count));
    at[count++] = last;
  }
};

}  // namespace

void FirstCells::lay(const SideBlock& block, std::span<const bool> wanted, float negligible, CellList& cells) {
  negligible_ = negligible;
  find_ends(block, wanted.size(), negligible_, ends_);
  parts_.clear(), reaching_->clear();
  for (std::size_t point = 0; point < wanted.size(); ++point) {
    if (!wanted[point]) continue;
    const float layer = std::min(block.point[SideBlock::alpha][point], block.point[SideBlock::view_z][point]);
    for (std::size_t side = 0; side < block.sides; ++side) {
      const SideAt at{block, side * points_at_once + point, point};
      if (at.of(SideBlock::end) > at.of(SideBlock::begin)) cut_side(at, layer, side >= block.first_horizon);
    }
  }
  find_rays(block, *reaching_);
  cells.full = cells.full || reaching_->full;
  for (const Part& part : parts_) lay_cells(part, block, cells);
}

void FirstCells::cut_side(const SideAt& at, float layer, bool horizon) {
  constexpr double far = 0.5, long_way = 0.8;
  const float tau0 = at.of(SideBlock::begin), tau1 = at.of(SideBlock::end);
  const double x0 = at.x_of(tau0), x1 = at.x_of(tau1);
  const bool low = ends_.side[SideEnds::low][at.side] > 0, rim = ends_.side[SideEnds::rim][at.side] > 0;
  Marks<double> xs(x0);
  const auto mark = [&](double x) {
    if (x > x0 && x < x1 && xs.count < most_marks - 1) xs.at[xs.count++] = x;
  };
  if (x1 > long_way) mark(far);
  if (x0 < -long_way) mark(-far);
  if (x1 > 0.6 && x0 < -0.6) mark(0);
  if (low && !horizon) {
    const auto grade = [&](float from, float way, float height, float slope) {
      if (height > std::max(2 * layer, std::sqrt(negligible_)) || !(slope > 0)) return;
      grade_heights(layer, negligible_, height, slope, false, [&](float h) { mark(at.x_of(from + (h - height) / slope * way)); });
    };
    grade(tau0, tau1 - tau0, ends_.side[SideEnds::height_begin][at.side], ends_.side[SideEnds::slope_begin][at.side]);
    grade(tau1, tau0 - tau1, ends_.side[SideEnds::height_end][at.side], ends_.side[SideEnds::slope_end][at.side]);
  }
  xs.close(x1);
  for (std::size_t k = 0; k + 1 < xs.count; ++k) {
    if (!(xs.at[k + 1] > xs.at[k])) continue;
    Part part{static_cast<std::int32_t>(at.point), static_cast<std::int32_t>(at.side), span_of_x(xs.at[k], xs.at[k + 1])};
    if (low || rim) {
      part.reaching = static_cast<std::int32_t>(reaching_->count);
      reaching_->add(part.point, part.side, part.x);
    }
    parts_.push_back(part);
  }
}
void FirstCells::lay_cells(const Part& part, const SideBlock& block, CellList& cells) const {
  if (part.reaching < 0) return cells.add(part.point, part.side, part.x, 0, 1);
  const auto found = static_cast<std::size_t>(part.reaching);
  const auto side = static_cast<std::size_t>(part.side);
  const SideAt at{block, side, static_cast<std::size_t>(part.point)};
  const float rest = at.of(SideBlock::rest), alpha = at.of(SideBlock::alpha), u = reaching_->u[found], length = rest - u;
  const float layer = std::min(alpha, at.of(SideBlock::view_z));
  Marks<float> ts(0);
  const auto mark = [&](float t) {
    if (t > 0 && t < 1 && ts.count < most_marks - 1) ts.at[ts.count++] = t;
  };
  const float low = reaching_->low[found], slope = reaching_->slope[found];
  if (ends_.side[SideEnds::low][side] > 0 && slope > 0)
    grade_heights(layer, negligible_, low, slope, reaching_->highest[found] < 4 * layer, [&](float v) { mark(1 - (v - low) / slope); });
  if (ends_.side[SideEnds::rim][side] > 0)
    grade_rim(alpha, rest, u, negligible_, tolerance_, [&](float away) { mark((rest - away) / length); });
  ts.close(1);
  for (std::size_t k = 0; k + 1 < ts.count; ++k)
    if (ts.at[k + 1] > ts.at[k]) cells.add(part.point, part.side, part.x, ts.at[k], ts.at[k + 1]);
}

}  // namespace etendue::eval
