// Polygons of any outline at many points: the edges' closed form, cut at the horizon, in vectors.
#include "light_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/polygon_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <cmath>
#include <vector>

#include "eval/edge_batch-inl.h"
#include "eval/light_batch-inl.h"

#ifndef ETENDUE_POLYGON_BATCH_SHARED
#define ETENDUE_POLYGON_BATCH_SHARED
namespace etendue::eval {

// In units of the batch, from the polygon's middle.
struct Corner {
  Direction offset;
  Constant beyond;  // squared distance from the middle less the mean of all corners'
};
struct Outline {
  std::vector<Corner> corners;
  Vec3d first, middle;  // m; the middle from the first corner
  Direction normal{{}};
  Constant reach2;      // the mean squared distance
  Constant area, bulk;  // as Cancellation's; area of a concave outline's hull's bound: no less than its own
  double scale = 1;     // units a metre
};
struct PlacedPolygon {
  const Outline& outline;
  Place middle;
  const Emitter& white;
};

}  // namespace etendue::eval
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

// A place on the outline.
template <class V>
struct Spot {
  Vector<V> offset;
  V rest;  // (a^2 - r^2) / r^2
};

// Lambert's sum over edges, each without its part of the area's; see edge_batch-inl.h.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
struct PolygonSum {
  D d;
  Vector<V> middle, normal;  // relative to the point
  V reach2, r2, per_r2;
  V sum, closest, least;
  Vector<V> twice_area;

  HWY_INLINE void add(const Spot<V>& from, const Spot<V>& to, M counted) {
    const Vector<V> along = to.offset - from.offset, a = middle + from.offset, across = cross(a, along);
    const V m = dot(across, normal), half_length2 = hn::Mul(hn::Mul(dot(along, along), number(d, 0.5)), per_r2);
    const V lower = hn::Min(from.rest, to.rest);
    const auto products = [&](auto) ETENDUE_INLINE_LAMBDA {
      const Vector<V> b = middle + to.offset;
      return Products<V>{hn::Mul(hn::Mul(dot(a, a), per_r2), hn::Mul(dot(b, b), per_r2)), hn::Mul(dot(a, b), per_r2)};
    };
    const EdgeRests<1, V, M> edge =
        edge_rests(d, std::array<Edge<V>, 1>{Edge<V>{from.rest, to.rest, half_length2}}, special_at(d, lower, r2, reach2), products);
    V part = hn::Mul(edge.rest[0], m);
    if (edge.any_obtuse) {
      const M obtuse = hn::And(edge.obtuse[0], counted);
      const V per_across = inverse_sqrt(d, hn::Max(dot(across, across), number(d, 1e-36)));
      closest = hn::Max(closest, hn::IfThenElseZero(obtuse, hn::Mul(hn::Sqrt(dot(along, along)), per_across)));
      part = hn::MulAdd(hn::IfThenElseZero(obtuse, hn::Mul(hn::Mul(number(d, pi), r2), m)), per_across, part);
    }
    const Vector<V> turned = cross(from.offset, along);
    sum = hn::Add(sum, hn::IfThenElseZero(counted, part));
    least = hn::Min(least, hn::IfThenElseZero(counted, lower));
    twice_area.x = hn::Add(twice_area.x, hn::IfThenElseZero(counted, turned.x));
    twice_area.y = hn::Add(twice_area.y, hn::IfThenElseZero(counted, turned.y));
    twice_area.z = hn::Add(twice_area.z, hn::IfThenElseZero(counted, turned.z));
  }
};

// The edges are cut at the horizon as they come: where the outline goes below, the horizon closes it from there to where it comes up again.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE V over_polygon(D d, const PlacedPolygon& light, const Point<V>& point, M& doubtful) {
  const V zero = hn::Zero(d);
  const Outline& outline = light.outline;
  const Vector<V> middle = towards(d, light.middle, point.position), facing = numbers(d, outline.normal);
  const V reach2 = number(d, outline.reach2), r2 = hn::Add(dot(middle, middle), reach2), per_r2 = inverse(d, r2);
  const V z = dot(middle, facing), n_z = dot(point.normal, facing), middle_up = dot(middle, point.normal);
  const auto rest_of = [&](const Vector<V>& offset, V beyond) ETENDUE_INLINE_LAMBDA {
    const V along = dot(middle, offset);
    return hn::Mul(hn::Add(hn::Add(along, along), beyond), per_r2);
  };
  const auto corner = [&](std::size_t i) ETENDUE_INLINE_LAMBDA {
    const Corner& c = outline.corners[i];
    const Vector<V> offset = numbers(d, c.offset);
    return Spot<V>{offset, rest_of(offset, number(d, c.beyond))};
  };
  const auto up_of = [&](const Spot<V>& s) ETENDUE_INLINE_LAMBDA { return hn::Add(middle_up, dot(s.offset, point.normal)); };
  PolygonSum<D> sum{d, middle, point.normal, reach2, r2, per_r2, zero, zero, zero, {zero, zero, zero}};
  const Spot<V> first = corner(0);
  const V first_up = up_of(first);
  Spot<V> a = first, gone = first, risen = first;
  V a_up = first_up, highest = first_up;
  const M none = hn::FirstN(d, 0), all = hn::Not(none);
  M below = hn::Lt(first_up, zero), was_gone = none, came_first = none;
  const auto either = [](M mask, const Spot<V>& yes, const Spot<V>& no) ETENDUE_INLINE_LAMBDA {
    return Spot<V>{chosen(mask, yes.offset, no.offset), hn::IfThenElse(mask, yes.rest, no.rest)};
  };
  const std::size_t count = outline.corners.size();
  for (std::size_t i = 1; i <= count; ++i) {
    const Spot<V> b = i == count ? first : corner(i);
    const V b_up = i == count ? first_up : up_of(b);
    highest = hn::Max(highest, b_up);
    const M b_below = hn::Lt(b_up, zero), down = hn::AndNot(below, b_below), up = hn::AndNot(b_below, below);
    if (hn::AllFalse(d, hn::Or(below, b_below))) {
      sum.add(a, b, all);
    } else {
      const V t = hn::IfThenElseZero(hn::Or(down, up), hn::Div(a_up, hn::Sub(a_up, b_up)));
      Spot<V> at{between(a.offset, b.offset, t), zero};
      at.rest = rest_of(at.offset, hn::Sub(dot(at.offset, at.offset), reach2));
      sum.add(either(below, at, a), either(b_below, at, b), hn::Not(hn::And(below, b_below)));
      // Up after a gap, or up before any: that one is closed at the end.
      const M closes = hn::And(up, was_gone);
      if (!hn::AllFalse(d, closes)) sum.add(gone, at, closes);
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
  if (!hn::AllFalse(d, came_first)) sum.add(gone, risen, came_first);
  const V value = hn::Mul(hn::Mul(number(d, -0.5), per_r2), hn::Add(dot(sum.twice_area, point.normal), sum.sum));
  const M front = hn::Lt(z, zero), seen = light.white.two_sided ? hn::Or(front, hn::Gt(z, zero)) : front;
  const M lit = hn::And(seen, hn::Gt(highest, zero));
  const V area = number(d, outline.area), bulk = number(d, outline.bulk);
  doubtful = hn::And(lit, cancels(d, Cancellation<V>{value, n_z, z, r2, per_r2, area, bulk, sum.closest, sum.least}));
  return hn::IfThenElseZero(lit, hn::Max(hn::IfThenElse(front, value, hn::Neg(value)), zero));
}

struct PolygonKernel {
  const PlacedPolygon& light;
  template <class D, class V, class M>
  HWY_INLINE V operator()(D d, const Point<V>& point, M& doubtful) const {
    return over_polygon(d, light, point, doubtful);
  }
};
std::size_t OverPolygon(const PlacedPolygon& light, const PointBatch& points, std::span<float> sr, float where_none) {
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
  outline.first = v[0];
  outline.middle = middle;
  double reach2 = 0, farthest2 = 0;
  for (const Vec3d& p : v) {
    const Vec3d offset = p - v[0] - middle;
    reach2 += dot(offset, offset) / count;
    farthest2 = std::max(farthest2, dot(offset, offset));
  }
  outline.scale = unit_for(std::sqrt(farthest2));
  const double s2 = outline.scale * outline.scale;
  double area = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Vec3d a = v[i] - v[0] - middle, b = v[(i + 1) % v.size()] - v[0] - middle;
    area += 0.5 * length(cross(a, b));
    outline.corners.push_back({Direction(a * outline.scale), (dot(a, a) - reach2) * s2});
  }
  outline.normal = Direction(polygon.normal);
  outline.reach2 = reach2 * s2;
  outline.area = area * s2;
  outline.bulk = 1.6 * farthest2 * farthest2 * s2 * s2;
  return outline;
}

class PolygonBatch final : public LightBatch::Shape {
 public:
  explicit PolygonBatch(const Emitter& white) : white_(white), outline_(outline_of(std::get<PolygonEmitter>(white.shape))) {}
  std::size_t over(const PointBatch& points, std::span<float> sr, float where_none) const override {
    const Place middle((outline_.first - points.origin + outline_.middle) * outline_.scale);
    return HWY_DYNAMIC_DISPATCH(OverPolygon)({outline_, middle, white_}, points, sr, where_none);
  }

 private:
  Emitter white_;
  Outline outline_;
};

}  // namespace

std::shared_ptr<const LightBatch::Shape> polygon_batch(const Emitter& white) {
  if (std::get<PolygonEmitter>(white.shape).vertices.size() < 3) return nullptr;
  return std::make_shared<PolygonBatch>(white);
}

}  // namespace etendue::eval
#endif
