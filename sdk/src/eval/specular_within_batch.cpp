// Adaptive evaluation of many points at once: where cells begin and which are halved, as specular_light.cpp does it for one.
#include "etendue/specular_within_batch.h"

#include "batch_error.h"
#include "etendue/specular_light.h"
#include "lobe_grading.h"
#include "specular_far.h"
#include "specular_layout.h"
#include "views.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace etendue::eval {

class SpecularWithinBatch::Light {
 public:
  Light(const Emitter& emitter, const RectView& seen, bool separable_masking, double least_floor)
      : white(emitter), view(seen), separable(separable_masking), least(least_floor) {}

  Emitter white;  // of 1 cd/m2
  RectView view;
  bool separable;
  double least;  // RectWithin
};

namespace {

// Part of what is allowed that is left to what no cell is laid out for.
constexpr double neglected = 0.25;

struct CellPlan {
  double tolerance;
  float negligible;  // part of the light that no cell is laid out for
  FarOrders far;
};

// One side of one point, in floats.
struct SideAt {
  const SideBlock& block;
  std::size_t side, point;

  float of(SideBlock::OfSide k) const { return block.side[k][side]; }
  float of(SideBlock::OfPoint k) const { return block.point[k][point]; }
  float tau_of(float x) const { return of(SideBlock::kappa) * x / ((1 - x) * (1 + x)); }
  float x_of(float tau) const {
    const float kappa = of(SideBlock::kappa);
    return 2 * tau / (kappa + std::sqrt(kappa * kappa + 4 * tau * tau));
  }
  struct Q {
    float x, y;
    float length() const { return std::sqrt(x * x + y * y); }
    float p() const { return length() / (1 + std::sqrt(1 + x * x + y * y)); }
  };
  Q at(float tau) const {
    const float over = 1 / (of(SideBlock::z0) + tau * (of(SideBlock::z1) + tau * of(SideBlock::z2)));
    return {(of(SideBlock::x0) + tau * (of(SideBlock::x1) + tau * of(SideBlock::x2))) * over,
            (of(SideBlock::y0) + tau * (of(SideBlock::y1) + tau * of(SideBlock::y2))) * over};
  }
};

// Lists of a block, 1.4 MB, kept by each thread: to ask for their pages takes longer than a few points do.
struct Lists {
  CellList cells, next;
  PartList parts;
};
thread_local std::unique_ptr<Lists> own_lists;
Lists& lists() {
  if (own_lists == nullptr) own_lists = std::make_unique_for_overwrite<Lists>();
  return *own_lists;
}

// First cells, as specular_light.cpp lays them out: sides are cut into parts, rays of those that reach a layer into cells.
class CellLayout {
 public:
  explicit CellLayout(const CellPlan& plan) : plan_(plan) {}

  // Of the points that are asked for, whose cells come one after the other.
  template <class Wanted>
  void lay(const SideBlock& block, std::size_t count, const Wanted& wanted, CellList& cells) {
    find_ends(block, plan_.negligible, ends_);
    parts_.clear(), reaching_->count = 0;
    for (std::size_t point = 0; point < count; ++point) {
      if (!wanted(point)) continue;
      const float layer = std::min(block.point[SideBlock::alpha][point], block.point[SideBlock::view_z][point]);
      for (std::size_t side = 0; side < most_sides; ++side) {
        const SideAt at{block, side * points_at_once + point, point};
        const float x0 = at.of(SideBlock::begin), x1 = at.of(SideBlock::end);
        if (x1 > x0) cut_side(at, x0, x1, layer, side == most_sides - 1);
      }
    }
    find_rays(block, *reaching_);
    for (const Part& part : parts_) lay_cells(part, block, cells);
  }

 private:
  struct Part {
    std::int32_t point, side;
    float x0, x1;
    std::int32_t reaching = -1;  // where it is in that list
  };
  template <std::size_t N>
  struct Marks {
    std::array<float, N> at;
    std::size_t count = 1;
    explicit Marks(float first) { at[0] = first; }
    void close(float last) {
      if (count > 2) std::sort(at.begin(), at.begin() + static_cast<std::ptrdiff_t>(count));
      at[count++] = last;
    }
  };
  static constexpr std::size_t most_marks = 24;

  void cut_side(const SideAt& at, float x0, float x1, float layer, bool horizon) {
    constexpr float far = 0.5f, long_way = 0.8f;
    const bool low = ends_.side[SideEnds::low][at.side] > 0, rim = ends_.side[SideEnds::rim][at.side] > 0;
    Marks<most_marks> xs(x0);
    const auto mark = [&](float x) {
      if (x > x0 && x < x1 && xs.count < most_marks - 1) xs.at[xs.count++] = x;
    };
    if (x1 > long_way) mark(far);
    if (x0 < -long_way) mark(-far);
    if (x1 > 0.6f && x0 < -0.6f) mark(0);
    if (low && !horizon) {
      const float tau0 = at.tau_of(x0), tau1 = at.tau_of(x1);
      const auto grade = [&](float from, float way, float height, float slope) {
        if (height > std::max(2 * layer, std::sqrt(plan_.negligible)) || !(slope > 0)) return;
        grade_heights(layer, plan_.negligible, height, slope, false, [&](float h) { mark(at.x_of(from + (h - height) / slope * way)); });
      };
      grade(tau0, tau1 - tau0, ends_.side[SideEnds::height_begin][at.side], ends_.side[SideEnds::slope_begin][at.side]);
      grade(tau1, tau0 - tau1, ends_.side[SideEnds::height_end][at.side], ends_.side[SideEnds::slope_end][at.side]);
    }
    xs.close(x1);
    for (std::size_t k = 0; k + 1 < xs.count; ++k) {
      if (!(xs.at[k + 1] > xs.at[k])) continue;
      Part part{static_cast<std::int32_t>(at.point), static_cast<std::int32_t>(at.side), xs.at[k], xs.at[k + 1]};
      if (low || rim) {
        part.reaching = static_cast<std::int32_t>(reaching_->count);
        reaching_->add(part.point, part.side, part.x0, part.x1);
      }
      parts_.push_back(part);
    }
  }
  void lay_cells(const Part& part, const SideBlock& block, CellList& cells) const {
    if (part.reaching < 0) return cells.add(part.point, part.side, part.x0, part.x1, 0, 1);
    const auto found = static_cast<std::size_t>(part.reaching);
    const auto side = static_cast<std::size_t>(part.side);
    const SideAt at{block, side, static_cast<std::size_t>(part.point)};
    const float base = at.of(SideBlock::base), alpha = at.of(SideBlock::alpha), p = reaching_->p[found], length = p - base;
    const float layer = std::min(alpha, at.of(SideBlock::view_z));
    Marks<most_marks> ts(0);
    const auto mark = [&](float t) {
      if (t > 0 && t < 1 && ts.count < most_marks - 1) ts.at[ts.count++] = t;
    };
    const float low = reaching_->low[found], slope = reaching_->slope[found];
    if (ends_.side[SideEnds::low][side] > 0 && slope > 0)
      grade_heights(layer, plan_.negligible, low, slope, reaching_->highest[found] < 4 * layer,
                    [&](float v) { mark(1 - (v - low) / slope); });
    if (ends_.side[SideEnds::rim][side] > 0)
      grade_rim(alpha, 1 - base, 1 - p, plan_.negligible, plan_.tolerance, [&](float away) { mark((1 - away - base) / length); });
    ts.close(1);
    for (std::size_t k = 0; k + 1 < ts.count; ++k)
      if (ts.at[k + 1] > ts.at[k]) cells.add(part.point, part.side, part.x0, part.x1, ts.at[k], ts.at[k + 1]);
  }

  const CellPlan& plan_;
  SideEnds ends_;
  std::vector<Part> parts_;
  PartList* reaching_ = &lists().parts;
};

struct Sums {
  float shape = 0, risen = 0, shape_error = 0, risen_error = 0;
  float rounding = 0;  // relative
  void add(const CellList& cells, std::size_t i) {
    shape += cells.shape[i], risen += cells.risen[i], shape_error += cells.shape_error[i], risen_error += cells.risen_error[i];
  }
};

// All cells of a block of points, round after round.
class BlockWithin {
 public:
  BlockWithin(const RectWithin& rect, const CellPlan& plan) : rect_(rect), plan_(plan), layout_(plan) {}

  std::array<Sums, points_at_once> sums;
  std::array<bool, points_at_once> kept;  // to the tolerance

  // Of as many of the places.
  PlaceBlock places;
  void run(std::size_t count) {
    constexpr int most_rounds = 8;
    far_shares(rect_, places, count, plan_.far, far);
    lay_sides(rect_, places, count, block_);
    cells_->full = next_->full = false;
    cells_->clear();
    for (std::size_t i = 0; i < count; ++i) {
      sums[i] = {};
      const bool sure = block_.point[SideBlock::doubt][i] == 0, lit = block_.point[SideBlock::floor][i] > 0;
      kept[i] = is_far(i) || (sure && !lit);
    }
    layout_.lay(
        block_, count, [&](std::size_t i) { return !is_far(i) && block_.point[SideBlock::doubt][i] == 0 && floor(i) > 0; }, *cells_);
    for (int round = 0; round < most_rounds && cells_->count > 0; ++round) {
      measure(block_, plan_.tolerance, *cells_);
      next_->clear();
      for (std::size_t from = 0, to = 0; from < cells_->count; from = to) {
        const std::int32_t point = cells_->point[from];
        while (to < cells_->count && cells_->point[to] == point) ++to;
        judge(static_cast<std::size_t>(point), from, to);
      }
      std::swap(cells_, next_);
    }
    // Whose cells are missing is not known.
    if (cells_->full || next_->full)
      for (std::size_t i = 0; i < count; ++i) kept[i] = kept[i] && (is_far(i) || !(floor(i) > 0));
  }
  FarShares far;
  bool is_far(std::size_t i) const { return far.bound[i] >= 0; }
  float floor(std::size_t i) const { return block_.point[SideBlock::floor][i]; }

 private:
  // Of cells that have been measured, those of one point: all are taken, or the worst are halved.
  void judge(std::size_t point, std::size_t from, std::size_t to) {
    constexpr std::size_t most_cells = 200;
    constexpr auto least_f0 = static_cast<float>(SpecularWithinBatch::least_f0);
    Sums all = sums[point];
    for (std::size_t i = from; i < to; ++i) all.add(*cells_, i);
    const auto dark = [](float shape, float risen) { return least_f0 * shape + (1 - least_f0) * risen; };
    const auto tolerance = static_cast<float>((1 - neglected) * plan_.tolerance);
    // A float's digits of n.v + n.l, which half vectors are divided by, and of slopes, which alpha divides.
    const float least = floor(point),
                rounding = (2e-7f + 5e-10f / block_.point[SideBlock::alpha][point]) / block_.point[SideBlock::view_z][point];
    all.rounding = rounding;
    const float bright_aim = tolerance * std::max(all.shape, least) - rounding * all.shape;
    const float dark_value = dark(all.shape, all.risen), dark_aim = tolerance * std::max(dark_value, least) - rounding * dark_value;
    if (!(bright_aim > 0 && dark_aim > 0)) return;
    // A ratio of what is linear in f0 is largest at one of both ends.
    const auto excess = [&](float shape_error, float risen_error) {
      return std::max(shape_error / bright_aim, dark(shape_error, risen_error) / dark_aim);
    };
    if (excess(all.shape_error, all.risen_error) <= 1) {
      sums[point] = all;
      kept[point] = true;
      return;
    }
    if (to - from > most_cells) return;
    // Cells that are left as they are take half of what those before have not taken.
    const float left = 1 - excess(sums[point].shape_error, sums[point].risen_error),
                acceptable = 0.5f * left / static_cast<float>(to - from);
    for (std::size_t i = from; i < to; ++i) {
      if (excess(cells_->shape_error[i], cells_->risen_error[i]) <= acceptable) {
        sums[point].add(*cells_, i);
      } else {
        halve(point, i);
      }
    }
  }
  void halve(std::size_t point, std::size_t i) {
    const float x0 = cells_->x0[i], x1 = cells_->x1[i], t0 = cells_->t0[i], t1 = cells_->t1[i];
    const auto add = [&](float xa, float xb, float ta, float tb) { next_->add(cells_->point[i], cells_->side[i], xa, xb, ta, tb); };
    if (cells_->along_t[i] > 0) {
      const SideAt at{block_, static_cast<std::size_t>(cells_->side[i]), point};
      const float base = at.of(SideBlock::base), length = at.at(at.tau_of(0.5f * (x0 + x1))).p() - base;
      const float middle = split_towards_rim(t0, t1, length > 1e-6f ? std::max((1 - base) / length, 1.0f) : 1e30f);
      add(x0, x1, t0, middle), add(x0, x1, middle, t1);
    } else {
      const float middle = split_towards_rim(x0, x1, 1.0f);
      add(x0, middle, t0, t1), add(middle, x1, t0, t1);
    }
  }

  const RectWithin& rect_;
  const CellPlan& plan_;
  SideBlock block_;
  CellLayout layout_;
  CellList *cells_ = &lists().cells, *next_ = &lists().next;
};

}  // namespace

namespace {

struct BoundedShare {
  double of_f0 = 0, of_f90 = 0, bound_f0 = 0, bound_f90 = 0;
};
BoundedShare bounded(const Sums& s, double floor, double tolerance) {
  const double shape = s.shape, risen = s.risen, told = neglected * tolerance;
  const double off = s.shape_error + s.rounding * shape, risen_off = s.risen_error + s.rounding * risen;
  return {std::max(shape - risen, 0.0), std::max(risen, 0.0), off + told * shape, risen_off + told * (risen + floor)};
}

// specular_luminance takes one f0 a channel: the whole lobe, and what f90 alone has of it.
BoundedShare in_double(const Emitter& white, const RectWithin& rect, const Vec3d& origin, const PlaceBlock& places, std::size_t i,
                       double tolerance) {
  const auto at = [&](std::size_t k) { return Vec3d{places.numbers[k][i], places.numbers[k + 1][i], places.numbers[k + 2][i]}; };
  const Vec3d normal = at(3), view = at(6);
  if (!(length(normal) > 0 && length(view) > 0)) return {};
  ShadingPoint point{at(0) + origin, normalised(normal), normalised(normal), normalised(view), Lambert{}};
  const Masking masking = rect.separable ? Masking::separable : Masking::correlated;
  point.brdf = GgxLobe{places.numbers[9][i], {1, SpecularWithinBatch::least_f0, 1}, 1, masking};
  const Estimate found = specular_luminance(white, point, tolerance, rect.least).value_or(Estimate{});
  const double whole = found.value.x, dark = found.value.y, least = SpecularWithinBatch::least_f0;
  const double risen = std::clamp((dark - least * whole) / (1 - least), 0.0, whole);
  return {whole - risen, risen, found.error.x, found.error.y};
}

CellPlan plan_for(double tolerance) {
  // Facets may send four times as much of the light elsewhere as at the middle of the lobe (specular_light.cpp).
  return {tolerance, static_cast<float>(neglected * tolerance / 4), FarOrders(tolerance)};
}

}  // namespace

Result<SpecularWithinBatch> SpecularWithinBatch::of(const Emitter& emitter, double tolerance, Masking masking, double least) {
  if (!(tolerance >= least_tolerance && tolerance <= most_tolerance)) {
    const std::string expected = fmt::format("expected a tolerance from {} to {}, found {}", least_tolerance, most_tolerance, tolerance);
    return Error{"TOLERANCE_OUT_OF_RANGE", expected, {}, {}, {}};
  }
  if (masking != Masking::correlated && masking != Masking::separable)
    return Error{"METHOD_LOBE", "expected height-correlated or separable masking", {}, {}, {}};
  Emitter white = emitter;
  white.radiance = {1, 1, 1};
  const auto* polygon = std::get_if<PolygonEmitter>(&white.shape);
  const bool uniform = !white.pattern && !is_window(white.window);
  const std::optional<RectView> view = polygon != nullptr && uniform ? rect_view(*polygon, false, {}) : std::nullopt;
  if (!view) return Error{"METHOD_SHAPE", "expected a uniform rectangle without a window", {}, {}, {}};
  const double brightest = std::max({emitter.radiance.x, emitter.radiance.y, emitter.radiance.z});
  const double floor = least > 0 && brightest > 0 ? least / brightest : 0;
  return SpecularWithinBatch(tolerance, std::make_shared<const Light>(white, *view, masking == Masking::separable, floor),
                             emitter.radiance);
}

template <class Fill>
std::size_t SpecularWithinBatch::over(std::size_t count, const Vec3d& origin, const Fill& fill, const BoundedShares& to,
                                      float where_none) const {
  const RectView& view = light_->view;
  const auto corner = [&](double x, double y) { return view.at(x * view.half_x, y * view.half_y) - origin; };
  const RectWithin rect{
      {corner(-1, -1), corner(-1, 1), corner(1, 1), corner(1, -1)}, view.normal, light_->white.two_sided, light_->separable, light_->least};
  const CellPlan plan = plan_for(tolerance_);
  const auto block = std::make_unique<BlockWithin>(rect, plan);
  std::size_t without = 0;
  const auto write = [&](std::size_t index, const BoundedShare& share) {
    to.of_f0[index] = static_cast<float>(share.of_f0), to.of_f90[index] = static_cast<float>(share.of_f90);
    if (!to.bound_f0.empty()) to.bound_f0[index] = static_cast<float>(share.bound_f0);
    if (!to.bound_f90.empty()) to.bound_f90[index] = static_cast<float>(share.bound_f90);
  };
  for (std::size_t first = 0; first < count; first += points_at_once) {
    const std::size_t number = std::min(points_at_once, count - first);
    PlaceBlock& places = block->places;
    for (auto& numbers : places.numbers) std::fill(numbers.begin() + static_cast<std::ptrdiff_t>(number), numbers.end(), 1.0);
    fill(first, number, places);
    block->run(number);
    for (std::size_t i = 0; i < number; ++i) {
      const std::size_t index = first + i;
      if (block->is_far(i)) {
        const FarShares& far = block->far;
        write(index, {far.of_f0[i], far.of_f90[i], far.bound[i] * far.of_f0[i], far.bound[i] * far.of_f90[i]});
      } else if (block->kept[i]) {
        write(index, bounded(block->sums[i], block->floor(i), tolerance_));
      } else if (std::all_of(places.numbers.begin(), places.numbers.end(),
                             [&](const auto& numbers) { return std::isfinite(numbers[i]); })) {
        write(index, in_double(light_->white, rect, origin, places, i, tolerance_));
      } else {
        write(index, {where_none, where_none, 0, 0});
        ++without;
      }
    }
  }
  return without;
}

namespace {

std::optional<std::size_t> other_size(const BoundedShares& to) {
  const std::size_t count = to.of_f0.size();
  if (to.of_f90.size() != count) return to.of_f90.size();
  for (const std::span<float>& bounds : {to.bound_f0, to.bound_f90})
    if (!bounds.empty() && bounds.size() != count) return bounds.size();
  return std::nullopt;
}

}  // namespace

BatchOutcome SpecularWithinBatch::shares(const SpecularPoints& points, const BoundedShares& to, float where_none) const {
  const PointBatch& s = points.surface;
  const std::size_t count = to.of_f0.size();
  const std::array<std::span<const float>, 10> in{s.px, s.py, s.pz, s.nx, s.ny, s.nz, points.vx, points.vy, points.vz, points.alpha};
  for (const std::span<const float>& numbers : in)
    if (numbers.size() != count) return batch_sizes_differ(numbers.size(), count);
  if (const auto other = other_size(to)) return batch_sizes_differ(count, *other);
  const auto fill = [&](std::size_t first, std::size_t number, PlaceBlock& places) {
    for (std::size_t k = 0; k < in.size(); ++k)
      std::copy_n(in[k].begin() + static_cast<std::ptrdiff_t>(first), number, places.numbers[k].begin());
  };
  return over(count, s.origin, fill, to, where_none);
}

BatchOutcome SpecularWithinBatch::shares(std::span<const SpecularPlace> points, const BoundedShares& to, float where_none) const {
  if (points.size() != to.of_f0.size()) return batch_sizes_differ(points.size(), to.of_f0.size());
  if (const auto other = other_size(to)) return batch_sizes_differ(points.size(), *other);
  const auto fill = [&](std::size_t first, std::size_t number, PlaceBlock& places) {
    for (std::size_t i = 0; i < number; ++i) {
      const SpecularPlace& p = points[first + i];
      const std::array<double, 10> all{p.position.x, p.position.y, p.position.z, p.normal.x, p.normal.y,
                                       p.normal.z,   p.view.x,     p.view.y,     p.view.z,   p.alpha};
      for (std::size_t k = 0; k < all.size(); ++k) places.numbers[k][i] = all[k];
    }
  };
  return over(points.size(), {}, fill, to, where_none);
}

}  // namespace etendue::eval
