// Polygons of any outline at many points: the edges' closed form, cut at the horizon, in vectors.
#include "light_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/polygon_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>
#include <vector>

#include "eval/edge_batch-inl.h"
#include "eval/light_batch-inl.h"
#include "eval/quadrature.h"
#include "eval/sector_rule.h"

#ifndef ETENDUE_POLYGON_BATCH_SHARED
#define ETENDUE_POLYGON_BATCH_SHARED
namespace etendue::eval {

// In units of the batch, on the polygon's plane from its middle; x leads to the farthest corner, so that a narrow outline keeps its digits.
struct Corner {
  Constant x, y;
  Constant beyond;  // squared distance from the middle less the mean of all corners'
};
// The sum of both corners of an edge.
struct CornerSum {
  Constant x, y, beyond;
};
struct Outline {
  std::vector<Corner> corners;
  std::vector<CornerSum> sums;  // of each and the one before
  Vec3d first, middle;          // m; the middle from the first corner
  Direction x{{}}, y{{}}, normal{{}};
  Constant reach2;  // the mean squared distance
  Constant twice_area;
  Constant area, longer;  // as Cancellation's
  double scale = 1;       // units a metre
  bool convex = true;
};
// 1 - w = x^4 (1 - x^4 / 2) 2 or x^4 of x = d / range, `range` in units of the batch.
struct PolynomialWindow {
  bool squared;
  double range, per_fourth;  // of the range
  double farthest;           // corner from the middle
};
struct PlacedPolygon {
  const Outline& outline;
  Place middle;
  const Emitter& white;
  std::optional<PolynomialWindow> window = {};
};

}  // namespace etendue::eval
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

// A place on the outline.
template <class V>
struct Spot {
  V x, y;
  V rest;  // (a^2 - r^2) / r^2
};

// What a window takes over h r^-4 of an outline wholly within the range: the integral of n.y (1, or 2 - (d/r)^4) over it, a polynomial of
// the degree 1 or 5 in the plane, as a fan from the middle: with dA = t (s x ds) dt Gauss's three nodes for the weight t and Gauss and
// Legendre's three along an edge are exact.
struct NoLoss {
  template <class D, class V, class Sum>
  HWY_INLINE void add(D, const Sum&, V, V, V, V, V) {}
};
template <class V>
struct WindowLoss {
  const PolynomialWindow& window;
  V taken;  // so far
  template <class D, class Sum>
  HWY_INLINE void add(D d, const Sum& sum, V from_x, V from_y, V dx, V dy, V turn) {
    const V up = hn::MulAdd(sum.normal.x, sum.middle.x, hn::MulAdd(sum.normal.y, sum.middle.y, hn::Mul(sum.normal.z, sum.middle.z)));
    if (!window.squared) {
      const V third = number(d, 1.0 / 3), mean_x = hn::Mul(hn::MulAdd(from_x, number(d, 2), dx), third),
              mean_y = hn::Mul(hn::MulAdd(from_y, number(d, 2), dy), third);
      const V height = hn::MulAdd(sum.normal.x, mean_x, hn::MulAdd(sum.normal.y, mean_y, up));
      taken = hn::MulAdd(hn::Mul(turn, number(d, 0.5)), height, taken);
      return;
    }
    const V z2 = hn::Mul(sum.middle.z, sum.middle.z), per_fourth = number(d, window.per_fourth);
    V all = hn::Zero(d);
    for (const GaussNode& along : gauss3) {
      const V share = number(d, 0.5 + 0.5 * along.x), x = hn::MulAdd(dx, share, from_x), y = hn::MulAdd(dy, share, from_y);
      const V rise = hn::MulAdd(sum.normal.x, x, hn::Mul(sum.normal.y, y));
      for (const SectorNode& across : nodes_across(3)) {
        const V t = number(d, across.x), at_x = hn::MulAdd(x, t, sum.middle.x), at_y = hn::MulAdd(y, t, sum.middle.y);
        const V d2 = hn::MulAdd(at_x, at_x, hn::MulAdd(at_y, at_y, z2)), fourth = hn::Mul(hn::Mul(d2, d2), per_fourth);
        const V weight = number(d, 0.5 * along.weight * across.weight);
        all = hn::MulAdd(hn::Mul(weight, hn::MulAdd(rise, t, up)), hn::Sub(number(d, 2), fourth), all);
      }
    }
    taken = hn::MulAdd(turn, all, taken);
  }
};

// Lambert's sum over edges, each without its part of the area's; see edge_batch-inl.h.
template <class Loss, class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
struct PolygonSum {
  D d;
  Vector<V> middle, normal;  // in the polygon's frame, relative to the point
  V reach2, r2, per_r2;
  V sum, closest, least, twice_area;
  bool convex;
  M unsure;  // which way half a turn goes
  Loss loss;

  // An edge, or a part of the horizon that closes a gap. rests: the sum of both.
  template <bool Horizon = false>
  HWY_INLINE void add(const Spot<V>& from, const Spot<V>& to, V rests, M counted) {
    const V dx = hn::Sub(to.x, from.x), dy = hn::Sub(to.y, from.y), ax = hn::Add(middle.x, from.x), ay = hn::Add(middle.y, from.y);
    const V z = middle.z, length2 = hn::MulAdd(dx, dx, hn::Mul(dy, dy)), beside = hn::MulSub(ax, dy, hn::Mul(ay, dx));
    // n.(a x b)
    const V m = hn::MulAdd(z, hn::MulSub(normal.y, dx, hn::Mul(normal.x, dy)), hn::Mul(normal.z, beside));
    const V lower = hn::Min(from.rest, to.rest);
    const auto products = [&](auto) ETENDUE_INLINE_LAMBDA {
      const V bx = hn::Add(middle.x, to.x), by = hn::Add(middle.y, to.y), z2 = hn::Mul(z, z);
      const V a2 = hn::MulAdd(ax, ax, hn::MulAdd(ay, ay, z2)), b2 = hn::MulAdd(bx, bx, hn::MulAdd(by, by, z2));
      return Products<V>{hn::Mul(hn::Mul(a2, per_r2), hn::Mul(b2, per_r2)), hn::Mul(hn::MulAdd(ax, bx, hn::MulAdd(ay, by, z2)), per_r2)};
    };
    const Edge<V> ends{from.rest, to.rest, rests, hn::Mul(hn::Mul(length2, number(d, 0.5)), per_r2)};
    const EdgeRests<1, V, M> edge = edge_rests(d, std::array<Edge<V>, 1>{ends}, special_at(d, lower, r2, reach2), products);
    V part = hn::Mul(edge.rest[0], m);
    if (edge.any_obtuse) {
      const M obtuse = hn::And(edge.obtuse[0], counted);
      const V half_turn = hn::IfThenElseZero(obtuse, hn::Mul(number(d, pi), r2));
      if constexpr (Horizon) {
        // Along it |a x b| = |m|, of which half a turn from a to b leaves no digit. What is seen lies on the normal's side, so that of a
        // convex outline m has the sign of z; that of others may come back along the horizon.
        part = hn::Add(part, hn::CopySign(half_turn, convex ? z : m));
        if (!convex) {
          const V one = number(d, 1), ends2 = hn::Mul(hn::Add(one, from.rest), hn::Add(one, to.rest)), over = hn::Mul(m, per_r2);
          const M lost = hn::Lt(hn::Mul(over, over), hn::Mul(ends2, number(d, in_floats<D> ? 1e-10 : 1e-26)));
          unsure = hn::Or(unsure, hn::And(obtuse, lost));
        }
      } else {
        const V across2 = hn::MulAdd(beside, beside, hn::Mul(hn::Mul(z, z), length2));
        const V per_across = inverse_sqrt(d, hn::Max(across2, number(d, 1e-36)));
        closest = hn::Max(closest, hn::IfThenElseZero(obtuse, hn::Mul(hn::Sqrt(length2), per_across)));
        part = hn::MulAdd(hn::Mul(half_turn, m), per_across, part);
      }
    }
    sum = hn::Add(sum, hn::IfThenElseZero(counted, part));
    least = hn::Min(least, hn::IfThenElseZero(counted, lower));
    const V turn = hn::IfThenElseZero(counted, hn::MulSub(from.x, dy, hn::Mul(from.y, dx)));
    twice_area = hn::Add(twice_area, turn);
    loss.add(d, *this, from.x, from.y, dx, dy, turn);
  }
};

// The edges are cut at the horizon as they come: where the outline goes below, the horizon closes it from there to where it comes up again.
template <class Loss, class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE V over_polygon(D d, const PlacedPolygon& light, const Point<V>& point, M& doubtful, const Loss& loss) {
  const V zero = hn::Zero(d);
  const Outline& outline = light.outline;
  const Vector<V> to_middle = towards(d, light.middle, point.position);
  const Vector<V> x = numbers(d, outline.x), y = numbers(d, outline.y), facing = numbers(d, outline.normal);
  const Vector<V> middle{dot(to_middle, x), dot(to_middle, y), dot(to_middle, facing)};
  const Vector<V> n{dot(point.normal, x), dot(point.normal, y), dot(point.normal, facing)};
  const V reach2 = number(d, outline.reach2), r2 = hn::Add(dot(to_middle, to_middle), reach2), per_r2 = inverse(d, r2);
  const V middle_up = dot(to_middle, point.normal);
  const auto rest_of = [&](V px, V py, V beyond) ETENDUE_INLINE_LAMBDA {
    const V along = hn::MulAdd(middle.x, px, hn::Mul(middle.y, py));
    return hn::Mul(hn::Add(hn::Add(along, along), beyond), per_r2);
  };
  const auto corner = [&](std::size_t i) ETENDUE_INLINE_LAMBDA {
    const Corner& c = outline.corners[i];
    const V px = number(d, c.x), py = number(d, c.y);
    return Spot<V>{px, py, rest_of(px, py, number(d, c.beyond))};
  };
  const auto up_of = [&](const Spot<V>& s) ETENDUE_INLINE_LAMBDA { return hn::Add(middle_up, hn::MulAdd(s.x, n.x, hn::Mul(s.y, n.y))); };
  const M none = hn::FirstN(d, 0), all = hn::Not(none);
  PolygonSum<Loss, D> sum{d, middle, n, reach2, r2, per_r2, zero, zero, zero, zero, outline.convex, none, loss};
  const Spot<V> first = corner(0);
  const V first_up = up_of(first);
  Spot<V> a = first, gone = first, risen = first;
  V a_up = first_up, highest = first_up, lowest = first_up;
  M below = hn::Lt(first_up, zero), was_gone = none, came_first = none;
  const auto either = [](M mask, const Spot<V>& yes, const Spot<V>& no) ETENDUE_INLINE_LAMBDA {
    return Spot<V>{hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y), hn::IfThenElse(mask, yes.rest, no.rest)};
  };
  const std::size_t count = outline.corners.size();
  for (std::size_t i = 1; i <= count; ++i) {
    const Spot<V> b = i == count ? first : corner(i);
    const V b_up = i == count ? first_up : up_of(b);
    highest = hn::Max(highest, b_up);
    lowest = hn::Min(lowest, b_up);
    const M b_below = hn::Lt(b_up, zero), down = hn::AndNot(below, b_below), up = hn::AndNot(b_below, below);
    const M either_below = hn::Or(below, b_below);
    const CornerSum& both = outline.sums[i == count ? 0 : i];
    const V rests = rest_of(number(d, both.x), number(d, both.y), number(d, both.beyond));
    if (hn::AllFalse(d, either_below)) {
      sum.add(a, b, rests, all);
    } else {
      const V t = hn::IfThenElseZero(hn::Or(down, up), hn::Div(a_up, hn::Sub(a_up, b_up)));
      Spot<V> at{hn::MulAdd(hn::Sub(b.x, a.x), t, a.x), hn::MulAdd(hn::Sub(b.y, a.y), t, a.y), zero};
      at.rest = rest_of(at.x, at.y, hn::Sub(hn::MulAdd(at.x, at.x, hn::Mul(at.y, at.y)), reach2));
      const Spot<V> from = either(below, at, a), to = either(b_below, at, b);
      sum.add(from, to, hn::IfThenElse(either_below, hn::Add(from.rest, to.rest), rests), hn::Not(hn::And(below, b_below)));
      // Up after a gap, or up before any: that one is closed at the end.
      const M closes = hn::And(up, was_gone);
      if (!hn::AllFalse(d, closes)) sum.template add<true>(gone, at, hn::Add(gone.rest, at.rest), closes);
      const M opens = hn::AndNot(was_gone, up);
      risen = either(opens, at, risen);
      came_first = hn::Or(came_first, opens);
      was_gone = hn::Or(hn::AndNot(up, was_gone), down);
      gone = either(down, at, gone);
    }
    a = b;
    a_up = b_up;
    below = b_below;
  }
  if (!hn::AllFalse(d, came_first)) sum.template add<true>(gone, risen, hn::Add(gone.rest, risen.rest), came_first);
  const V twice_area = hn::IfThenElse(hn::Lt(lowest, zero), sum.twice_area, number(d, outline.twice_area));
  const V value = hn::Mul(hn::Mul(number(d, -0.5), per_r2), hn::MulAdd(twice_area, n.z, sum.sum));
  const Sides<M> side = sides_of(d, middle.z, r2, light.white.two_sided);
  const M above = hn::Gt(highest, zero), lit = hn::And(side.seen, above);
  const V area = number(d, outline.area), longer = number(d, outline.longer);
  const Cancellation<V> terms{value, n.z, middle.z, r2, per_r2, area, longer, sum.closest, sum.least};
  doubtful = hn::Or(hn::And(side.unsure, above), hn::And(lit, hn::Or(sum.unsure, cancels(d, terms))));
  const V open = hn::IfThenElseZero(lit, hn::Max(hn::IfThenElse(side.front, value, hn::Neg(value)), zero));
  if constexpr (std::is_same_v<Loss, NoLoss>) {
    return open;
  } else {
    // Of a light that the range cuts there is no such polynomial: those are left to the definition. Where little is left floats have lost
    // its digits.
    const PolynomialWindow& window = *light.window;
    const auto square = [](double x) { return std::min(x * x, 1e37); };
    const V distance2 = dot(to_middle, to_middle),
            rest = hn::NegMulAdd(hn::Mul(hn::Abs(middle.z), number(d, window.per_fourth)), sum.loss.taken, open);
    const M beyond = hn::Gt(distance2, number(d, square((window.range + window.farthest) * (1 + 1e-5))));
    const M within = hn::Lt(distance2, number(d, square(std::max(window.range - window.farthest, 0.0) * (1 - 1e-5))));
    const M unclear = in_floats<D> ? hn::Or(hn::Not(within), hn::Lt(rest, hn::Mul(open, number(d, 0.5)))) : hn::Not(within);
    doubtful = hn::AndNot(beyond, hn::Or(doubtful, hn::And(hn::Gt(open, zero), unclear)));
    return hn::IfThenElseZero(within, hn::Min(hn::Max(rest, zero), open));
  }
}

struct PolygonKernel {
  const PlacedPolygon& light;
  template <class D, class V, class M>
  HWY_INLINE V operator()(D d, const Point<V>& point, M& doubtful) const {
    return over_polygon(d, light, point, doubtful, NoLoss{});
  }
};
struct WindowedKernel {
  const PlacedPolygon& light;
  template <class D, class V, class M>
  HWY_INLINE V operator()(D d, const Point<V>& point, M& doubtful) const {
    return over_polygon(d, light, point, doubtful, WindowLoss<V>{*light.window, hn::Zero(d)});
  }
};
std::size_t OverPolygon(const PlacedPolygon& light, const PointBatch& points, std::span<float> sr, float where_none) {
  if (light.window) return at_every_point(light.white, light.outline.scale, points, sr, where_none, WindowedKernel{light});
  return at_every_point(light.white, light.outline.scale, points, sr, where_none, PolygonKernel{light});
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {
namespace {

HWY_EXPORT(OverPolygon);

Outline outline_of(const PolygonEmitter& polygon) {
  Outline outline;
  const std::vector<Vec3d>& v = polygon.vertices;
  const double count = static_cast<double>(v.size());
  Vec3d middle;  // from the first corner: far from the origin the sum of both would be rounded
  for (const Vec3d& p : v) middle += (p - v[0]) / count;
  middle -= polygon.normal * dot(middle, polygon.normal);
  Vec3d farthest;
  double reach2 = 0;
  for (const Vec3d& p : v) {
    const Vec3d offset = p - v[0] - middle;
    reach2 += dot(offset, offset) / count;
    if (dot(offset, offset) > dot(farthest, farthest)) farthest = offset;
  }
  const Vec3d on_plane = farthest - polygon.normal * dot(farthest, polygon.normal);
  const Vec3d x = dot(on_plane, on_plane) > 0 ? normalised(on_plane) : basis_around(polygon.normal).tangent, y = cross(polygon.normal, x);
  outline.first = v[0];
  outline.middle = middle;
  outline.x = Direction(x);
  outline.y = Direction(y);
  outline.normal = Direction(polygon.normal);
  outline.scale = unit_for(length(farthest));
  double twice = 0, area = 0;
  std::vector<Vec2d> flat;
  for (const Vec3d& p : v) {
    const Vec3d offset = (p - v[0] - middle) * outline.scale;
    flat.push_back({dot(offset, x), dot(offset, y)});
  }
  const double scaled_reach2 = reach2 * outline.scale * outline.scale;
  for (std::size_t i = 0; i < flat.size(); ++i) {
    const Vec2d &a = flat[i], &b = flat[(i + 1) % flat.size()];
    twice += a.x * b.y - a.y * b.x;
    area += 0.5 * std::abs(a.x * b.y - a.y * b.x);
    const Vec2d& c = flat[(i + 2) % flat.size()];
    if ((b.x - a.x) * (c.y - b.y) < (b.y - a.y) * (c.x - b.x)) outline.convex = false;
    const Vec2d& before = flat[(i + flat.size() - 1) % flat.size()];
    const double beyond = a.x * a.x + a.y * a.y - scaled_reach2;
    outline.corners.push_back({a.x, a.y, beyond});
    outline.sums.push_back({a.x + before.x, a.y + before.y, beyond + before.x * before.x + before.y * before.y - scaled_reach2});
  }
  outline.reach2 = scaled_reach2;
  outline.twice_area = twice;
  outline.area = area;
  outline.longer = 2 * length(farthest) * outline.scale;
  return outline;
}

class PolygonBatch final : public LightBatch::Shape {
 public:
  explicit PolygonBatch(const Emitter& white) : white_(white), outline_(outline_of(std::get<PolygonEmitter>(white.shape))) {
    if (!is_window(white.window)) return;
    const double range = white.window.range_m * outline_.scale, per_range = 1 / range;
    window_ = {white.window.falloff == Falloff::frostbite, range, std::min(std::pow(per_range, 4), 1e37), 0.5 * outline_.longer.whole};
  }
  std::size_t over(const PointBatch& points, std::span<float> sr, float where_none) const override {
    const Place middle((outline_.first - points.origin + outline_.middle) * outline_.scale);
    return HWY_DYNAMIC_DISPATCH(OverPolygon)({outline_, middle, white_, window_}, points, sr, where_none);
  }

 private:
  Emitter white_;
  Outline outline_;
  std::optional<PolynomialWindow> window_;
};

}  // namespace

std::shared_ptr<const LightBatch::Shape> polygon_batch(const Emitter& white) {
  if (std::get<PolygonEmitter>(white.shape).vertices.size() < 3) return nullptr;
  return std::make_shared<PolygonBatch>(white);
}

}  // namespace etendue::eval
#endif
