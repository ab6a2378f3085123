// Adaptive evaluation of many points at once: where cells begin and which are halved, as specular_light.cpp does it for one.
#include "etendue/specular_within_batch.h"

#include "batch_error.h"
#include "etendue/specular_light.h"
#include "lobe_grading.h"
#include "specular_far.h"
#include "specular_first_cells.h"
#include "specular_outline.h"
#include "specular_view.h"
#include "views.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace etendue::eval {

class SpecularWithinBatch::Light {
 public:
  Light(const Emitter& emitter, const OutlinedLight& outline_of) : white(emitter), outline(outline_of) {
    const auto* polygon = std::get_if<PolygonEmitter>(&white.shape);
    if (polygon == nullptr) return;
    if (const std::optional<RectView> view = rect_view(*polygon, false, {}))
      far = FarRectangle{view->corners(), view->normal, outline.two_sided, outline.separable};
  }

  Emitter white;  // of 1 cd/m2
  OutlinedLight outline;
  std::optional<FarRectangle> far;  // of what few places are enough
};

namespace {

// Part of what is allowed that is left to what no cell is laid out for.
constexpr double neglected = 0.25;

struct CellPlan {
  double tolerance;
  float negligible;      // part of the light that no cell is laid out for
  float most_cancelled;  // times the light, beyond which points are left to specular_luminance
  FarOrders far;
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
  BlockWithin(const OutlinedLight& light, const std::optional<FarRectangle>& rectangle, const CellPlan& plan)
      : light_(light), rectangle_(rectangle), plan_(plan), first_cells_(plan.tolerance, lists().parts) {}

  std::array<Sums, points_at_once> sums;
  std::array<bool, points_at_once> kept;  // to the tolerance

  // Of as many of the places.
  PlaceBlock places;
  void run(std::size_t count) {
    if (rectangle_) {
      far_shares(*rectangle_, places, count, plan_.far, far);
    } else {
      far.bound.fill(-1);
    }
    lay_sides(light_, places, count, block_);
    cells_->full = next_->full = false;
    std::array<bool, points_at_once> wanted;
    for (std::size_t i = 0; i < count; ++i) {
      sums[i] = {};
      const bool sure = block_.point[SideBlock::doubt][i] == 0, lit = floor(i) > 0;
      kept[i] = is_far(i) || (sure && !lit);
      wanted[i] = !is_far(i) && sure && lit;
    }
    again_.fill(false);
    refine(std::span(wanted).first(count), plan_.negligible, std::min(little_cancelled, plan_.most_cancelled));
    if (std::find(again_.begin(), again_.end(), true) != again_.end()) {
      wanted = again_;
      refine(std::span(wanted).first(count), plan_.negligible / plan_.most_cancelled, plan_.most_cancelled);
    }
    // Whose cells are missing is not known.
    if (cells_->full || next_->full)
      for (std::size_t i = 0; i < count; ++i) kept[i] = kept[i] && (is_far(i) || !(floor(i) > 0));
  }
  FarShares far;
  bool is_far(std::size_t i) const { return far.bound[i] >= 0; }
  float floor(std::size_t i) const { return block_.point[SideBlock::floor][i]; }

 private:
  // What is negligible is so beside the light, not beside what cancels: up to this part of it.
  static constexpr float little_cancelled = 8;

  // Points whose cells cancel by more than `cancelled` times the light are left: to be looked at `again_`, or in double.
  void refine(std::span<const bool> wanted, float negligible, float cancelled) {
    constexpr int most_rounds = 8;
    cells_->clear();
    first_cells_.lay(block_, wanted, negligible, *cells_);
    for (int round = 0; round < most_rounds && cells_->count > 0; ++round) {
      measure(block_, plan_.tolerance, *cells_);
      next_->clear();
      for (std::size_t from = 0, to = 0; from < cells_->count; from = to) {
        const std::int32_t point = cells_->point[from];
        while (to < cells_->count && cells_->point[to] == point) ++to;
        if (round > 0 || !cancels(static_cast<std::size_t>(point), from, to, cancelled)) judge(static_cast<std::size_t>(point), from, to);
      }
      std::swap(cells_, next_);
    }
  }
  bool cancels(std::size_t point, std::size_t from, std::size_t to, float cancelled) {
    float size = 0, sum = 0;
    for (std::size_t i = from; i < to; ++i) size += std::abs(cells_->shape[i]), sum += cells_->shape[i];
    const float light = std::max(sum, floor(point));
    if (!(size > cancelled * light)) return false;
    again_[point] = size > little_cancelled * light && !(size > plan_.most_cancelled * light);
    return true;
  }
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
    // Those that err least are left as they are, as many as take half of what those before have not taken.
    std::array<std::pair<float, std::size_t>, most_cells> order;
    for (std::size_t i = from; i < to; ++i) order[i - from] = {excess(cells_->shape_error[i], cells_->risen_error[i]), i};
    std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(to - from));
    float left = 0.5f * (1 - excess(sums[point].shape_error, sums[point].risen_error));
    std::size_t halved = to - from;
    for (std::size_t k = 0; k < to - from && (left -= order[k].first) >= 0; ++k) {
      sums[point].add(*cells_, order[k].second);
      --halved;
    }
    for (std::size_t k = to - from - halved; k < to - from; ++k) halve(point, order[k].second);
  }
  void halve(std::size_t point, std::size_t i) {
    const SpanOfX x{cells_->origin[i], cells_->x0[i], cells_->x1[i]};
    const float t0 = cells_->t0[i], t1 = cells_->t1[i];
    const auto add = [&](const SpanOfX& part, float ta, float tb) { next_->add(cells_->point[i], cells_->side[i], part, ta, tb); };
    if (cells_->along_t[i] > 0) {
      const SideAt at{block_, static_cast<std::size_t>(cells_->side[i]), point};
      const float rest = at.of(SideBlock::rest), length = rest - at.middle_of(x).from_rim();
      const float middle = split_towards_rim(t0, t1, length > 1e-6f * rest ? std::max(rest / length, 1.0f) : 1e30f);
      add(x, t0, middle), add(x, middle, t1);
    } else {
      const float middle = middle_towards_rim(x);
      add({x.origin, x.from, middle}, t0, t1), add({x.origin, middle, x.to}, t0, t1);
    }
  }
  // Of |x| = 1.
  static float middle_towards_rim(const SpanOfX& x) {
    if (x.origin == 0) return split_towards_rim(x.from, x.to, 1.0f);
    const float span = x.to - x.from;
    return x.origin > 0 ? x.from + split_towards_rim(0.0f, span, -x.from) : x.to - split_towards_rim(0.0f, span, x.to);
  }

  const OutlinedLight& light_;
  const std::optional<FarRectangle>& rectangle_;
  const CellPlan& plan_;
  SideBlock block_;
  FirstCells first_cells_;
  std::array<bool, points_at_once> again_;
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
BoundedShare in_double(const Emitter& white, const OutlinedLight& light, const Vec3d& origin, const PlaceBlock& places, std::size_t i,
                       double tolerance) {
  const auto at = [&](std::size_t k) { return Vec3d{places.numbers[k][i], places.numbers[k + 1][i], places.numbers[k + 2][i]}; };
  const Vec3d normal = at(3), view = at(6);
  if (!(length(normal) > 0 && length(view) > 0)) return {};
  ShadingPoint point{at(0) + origin, normalised(normal), normalised(normal), normalised(view), Lambert{}};
  const Masking masking = light.separable ? Masking::separable : Masking::correlated;
  point.brdf = GgxLobe{places.numbers[9][i], {1, SpecularWithinBatch::least_f0, 1}, 1, masking};
  const Estimate found = specular_luminance(white, point, tolerance, light.least).value_or(Estimate{});
  const double whole = found.value.x, dark = found.value.y, least = SpecularWithinBatch::least_f0;
  const double risen = std::clamp((dark - least * whole) / (1 - least), 0.0, whole);
  return {whole - risen, risen, found.error.x, found.error.y};
}

// The same light of 1 cd/m2.
Emitter of_one(Emitter emitter) {
  if (auto* sun = std::get_if<DistantEmitter>(&emitter.shape)) {
    const double sine = std::sin(sun->radius_rad);
    sun->illuminance = Rgb{1, 1, 1} * (pi * sine * sine);
  }
  emitter.radiance = {1, 1, 1};
  return emitter;
}

// Fewer at once of a polygon of very many sides, whose cells fill the lists.
std::size_t points_of(const OutlinedLight& light) {
  constexpr std::size_t most_sides = 1024;
  const auto* polygon = std::get_if<CornersSeen>(&light.shape);
  return polygon == nullptr ? points_at_once : std::clamp<std::size_t>(most_sides / polygon->corners.size(), 1, points_at_once);
}

CellPlan plan_for(const OutlinedLight& light, double tolerance) {
  // Places of a great circle share their roundings, those of a smaller one have each its own.
  const float most_cancelled =
      std::holds_alternative<CornersSeen>(light.shape) ? 64.0f : static_cast<float>(std::clamp(4e4 * tolerance, 4.0, 16.0));

  // Facets may send four times as much of the light elsewhere as at the middle of the lobe (specular_light.cpp).
  return {tolerance, static_cast<float>(neglected * tolerance / 4), most_cancelled, FarOrders(tolerance)};
}

}  // namespace

Result<SpecularWithinBatch> SpecularWithinBatch::of(const Emitter& emitter, double tolerance, Masking masking, double least) {
  if (!(tolerance >= least_tolerance && tolerance <= most_tolerance)) {
    const std::string expected = fmt::format("expected a tolerance from {} to {}, found {}", least_tolerance, most_tolerance, tolerance);
    return Error{"TOLERANCE_OUT_OF_RANGE", expected, {}, {}, {}};
  }
  if (masking != Masking::correlated && masking != Masking::separable)
    return Error{"METHOD_LOBE", "expected height-correlated or separable masking", {}, {}, {}};
  std::optional<OutlinedLight> outline = is_uniform_area_light(emitter) ? outlined(emitter) : std::nullopt;
  if (!outline) return Error{"METHOD_SHAPE", "expected a uniform polygon, sphere, disk, sun or tube without a window", {}, {}, {}};
  const Rgb luminance = luminance_of(emitter);
  const double brightest = std::max({luminance.x, luminance.y, luminance.z});
  outline->separable = masking == Masking::separable;
  outline->least = least > 0 && brightest > 0 ? least / brightest : 0;
  return SpecularWithinBatch(tolerance, std::make_shared<const Light>(of_one(emitter), *outline), luminance);
}

template <class Fill>
std::size_t SpecularWithinBatch::over(std::size_t count, const Vec3d& origin, const Fill& fill, const BoundedShares& to,
                                      float where_none) const {
  const OutlinedLight outline = light_->outline.seen_from(origin);
  std::optional<FarRectangle> far_away = light_->far;
  if (far_away)
    for (Vec3d& corner : far_away->corners) corner = corner - origin;
  const CellPlan plan = plan_for(outline, tolerance_);
  const auto block = std::make_unique<BlockWithin>(outline, far_away, plan);
  const std::size_t most = points_of(outline);
  std::size_t without = 0;
  const auto write = [&](std::size_t index, const BoundedShare& share) {
    to.of_f0[index] = static_cast<float>(share.of_f0), to.of_f90[index] = static_cast<float>(share.of_f90);
    if (!to.bound_f0.empty()) to.bound_f0[index] = static_cast<float>(share.bound_f0);
    if (!to.bound_f90.empty()) to.bound_f90[index] = static_cast<float>(share.bound_f90);
  };
  for (std::size_t first = 0; first < count; first += most) {
    const std::size_t number = std::min(most, count - first);
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
        write(index, in_double(light_->white, outline, origin, places, i, tolerance_));
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
