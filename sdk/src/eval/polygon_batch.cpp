// Polygons of any outline at many points: the edges' closed form, cut at the horizon, in vectors.
#include "light_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/polygon_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "eval/light_batch-inl.h"

#ifndef ETENDUE_POLYGON_BATCH_SHARED
#define ETENDUE_POLYGON_BATCH_SHARED
namespace etendue::eval {

// A place of Gauss and Legendre's on the polygon: where, from the first vertex, and how much of the area.
struct AreaNode {
  float x, y, z, weight;
};
// Sizes of the polygon from the first vertex beyond which 3 x 3 or 5 x 5 places are enough.
constexpr double coarse_enough = 4.5, fine_enough = 2.5;
// In units of the batch.
struct Outline {
  std::vector<AreaNode> coarse, fine;
  double size2;  // of the farthest vertex from the first
  double scale;  // units a metre
};
struct PlacedPolygon {
  const PolygonEmitter& polygon;
  const Outline& outline;
  Vec3d origin;
  std::span<const Place> places;  // of the first vertices
  Coordinate plane;               // normal.vertex
  const Emitter& white;
};

}  // namespace etendue::eval
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

// One edge's part of Lambert's sum, twice: angle n.m / |m|, m = a x b across the plane of the edge and the point.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V edge(D d, const Vector<V>& a, const Vector<V>& b, const Vector<V>& normal) {
  const Vector<V> m = cross(a, b - a);
  const V sine = hn::Sqrt(dot(m, m));
  const V angle = angle_of(d, sine, dot(a, b));
  return hn::IfThenElseZero(hn::Gt(sine, hn::Zero(d)), hn::Div(hn::Mul(angle, dot(m, normal)), sine));
}

// The integral over the area: nothing cancels here, as the cosine at the light is height / |q| for all of its plane. `height`: of the point
// above the emitting side.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V over_area(D d, std::span<const AreaNode> nodes, const Vector<V>& first, const Vector<V>& normal, V height) {
  V sum = hn::Zero(d);
  for (const AreaNode& node : nodes) {
    const Vector<V> q{hn::Add(first.x, hn::Set(d, node.x)), hn::Add(first.y, hn::Set(d, node.y)), hn::Add(first.z, hn::Set(d, node.z))};
    const V q2 = dot(q, q);
    sum = hn::MulAdd(hn::Set(d, node.weight), hn::Div(dot(q, normal), hn::Mul(q2, q2)), sum);
  }
  return hn::Mul(sum, height);
}

// Lambert's sum over the edges, cut at the horizon as they come: where the outline goes below, the horizon closes it from there to where it
// comes up again. `doubtful` marks the lanes whose terms cancel to a small part of what each contributes: far lights that the horizon cuts,
// and lights seen edge-on.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE V over_polygon(D d, const PlacedPolygon& light, const Point<V>& point, M& doubtful) {
  const V zero = hn::Zero(d);
  const std::vector<Vec3d>& vertices = light.polygon.vertices;
  const std::size_t count = vertices.size();
  const auto vertex = [&](std::size_t i) {
    return towards(d, i < light.places.size() ? light.places[i] : Place((vertices[i] - light.origin) * light.outline.scale),
                   point.position);
  };
  const Vector<V> first = vertex(0);
  const Vector<V> facing = numbers(d, light.polygon.normal);
  const V height = hn::Neg(away(d, light.plane, dot(point.position, facing)));
  const V first_up = dot(first, point.normal);
  V sum = zero, lowest = first_up, highest = first_up;
  Vector<V> a = first, gone = first, risen = first;
  V a_up = first_up;
  M below = hn::Lt(first_up, zero), was_gone = hn::FirstN(d, 0), came_first = hn::FirstN(d, 0);
  for (std::size_t i = 1; i <= count; ++i) {
    const Vector<V> b = i == count ? first : vertex(i);
    const V b_up = i == count ? first_up : dot(b, point.normal);
    lowest = hn::Min(lowest, b_up);
    highest = hn::Max(highest, b_up);
    const M b_below = hn::Lt(b_up, zero), down = hn::AndNot(below, b_below), up = hn::AndNot(b_below, below);
    if (hn::AllFalse(d, hn::Or(below, b_below))) {
      sum = hn::Add(sum, edge(d, a, b, point.normal));
    } else {
      const M crosses = hn::Or(down, up);
      const V t = hn::IfThenElseZero(crosses, hn::Div(a_up, hn::Sub(a_up, b_up)));
      const Vector<V> at = between(a, b, t);
      const V part = edge(d, chosen(below, at, a), chosen(b_below, at, b), point.normal);
      sum = hn::Add(sum, hn::IfThenZeroElse(hn::And(below, b_below), part));
      // Up after a gap, or up before any: that one is closed at the end.
      const M closes = hn::And(up, was_gone);
      if (!hn::AllFalse(d, closes)) sum = hn::Add(sum, hn::IfThenElseZero(closes, edge(d, gone, at, point.normal)));
      const M opens = hn::AndNot(was_gone, up);
      risen = chosen(opens, at, risen);
      came_first = hn::Or(came_first, opens);
      was_gone = hn::Or(hn::AndNot(up, was_gone), down);
      gone = chosen(down, at, gone);
    }
    a = b;
    a_up = b_up;
    below = b_below;
  }
  if (!hn::AllFalse(d, came_first)) sum = hn::Add(sum, hn::IfThenElseZero(came_first, edge(d, gone, risen, point.normal)));
  V value = hn::Mul(number(d, -0.5), sum);
  const M cut = hn::And(hn::Lt(lowest, zero), hn::Gt(highest, zero)), front = hn::Gt(height, zero);
  const V from_first2 = dot(first, first), height2 = hn::Mul(height, height);
  const auto farther_than = [&](double sizes) { return hn::Gt(from_first2, number(d, sizes * sizes * light.outline.size2)); };
  const auto lower_than = [&](double part) { return hn::Lt(height2, hn::Mul(number(d, part * part), from_first2)); };
  M cancels = hn::And(cut, farther_than(1e4));
  if constexpr (in_floats<D>) {
    // The integral over the area has no terms that cancel, but needs a light that is whole and not too close.
    const M small = hn::And(hn::Lt(hn::Abs(value), number(d, 0.006)), lower_than(0.4));
    const M whole = hn::AndNot(cut, farther_than(coarse_enough)),
            middle = hn::AndNot(hn::Or(cut, whole), hn::And(small, farther_than(fine_enough)));
    if (!hn::AllFalse(d, middle)) value = hn::IfThenElse(middle, over_area(d, light.outline.fine, first, point.normal, height), value);
    if (!hn::AllFalse(d, whole)) value = hn::IfThenElse(whole, over_area(d, light.outline.coarse, first, point.normal, height), value);
    cancels = hn::AndNot(hn::Or(whole, middle), hn::Or(small, hn::And(cut, hn::Or(farther_than(coarse_enough), lower_than(0.05)))));
    // The height itself has lost its digits.
    cancels = hn::Or(cancels, hn::And(hn::Lt(hn::Abs(value), number(d, 0.05)), lower_than(0.01)));
  }
  const M seen = light.white.two_sided ? hn::Or(front, hn::Lt(height, zero)) : front, lit = hn::And(seen, hn::Gt(highest, zero));
  doubtful = hn::And(lit, cancels);
  return hn::IfThenElseZero(lit, hn::Max(hn::IfThenElse(front, value, hn::Neg(value)), zero));
}

std::size_t OverPolygon(const PlacedPolygon& light, const PointBatch& points, std::span<float> sr, float where_none) {
  return at_every_point(light.white, light.outline.scale, points, sr, where_none,
                        [&](auto d, const auto& point, auto& doubtful) { return over_polygon(d, light, point, doubtful); });
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {
namespace {

HWY_EXPORT(OverPolygon);

// Gauss and Legendre's places in [0, 1].
template <std::size_t Order>
struct GaussLegendre;
template <>
struct GaussLegendre<3> {
  static constexpr std::array<double, 3> x{0.1127016653792583, 0.5, 0.8872983346207417};
  static constexpr std::array<double, 3> w{0.2777777777777778, 0.4444444444444444, 0.2777777777777778};
};
template <>
struct GaussLegendre<5> {
  static constexpr std::array<double, 5> x{0.04691007703066800, 0.2307653449471585, 0.5, 0.7692346550528415, 0.9530899229693320};
  static constexpr std::array<double, 5> w{0.1184634425280945, 0.2393143352496832, 0.2844444444444444, 0.2393143352496832,
                                           0.1184634425280945};
};

// Over a parallelogram, else over each triangle of the fan from the first vertex (collapsed squares: see area_sum in polygon_form.cpp; a
// triangle that a concave outline folds back counts less than nothing). The error goes as (half the size / distance)^(2 Order).
template <std::size_t Order>
std::vector<AreaNode> nodes_over(const PolygonEmitter& polygon, double scale) {
  using Rule = GaussLegendre<Order>;
  const std::vector<Vec3d>& v = polygon.vertices;
  std::vector<AreaNode> nodes;
  const auto add = [&](const Vec3d& place, double weight) {
    const Vec3d p = place * scale;
    nodes.push_back(
        {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z), static_cast<float>(weight * scale * scale)});
  };
  const Vec3d skew = v.size() == 4 ? v[0] - v[1] + v[2] - v[3] : Vec3d{1, 0, 0};
  const bool parallelogram = v.size() == 4 && dot(skew, skew) <= 1e-28 * dot(v[2] - v[0], v[2] - v[0]);
  for (std::size_t i = 1; i + 1 < v.size(); ++i) {
    const Vec3d e1 = v[i] - v[0], e2 = (parallelogram ? v[3] : v[i + 1]) - v[0];
    const double area = dot(cross(e1, e2), polygon.normal);
    for (std::size_t j = 0; j < Order; ++j) {
      for (std::size_t k = 0; k < Order; ++k) {
        const double x = Rule::x[j], y = Rule::x[k], w = Rule::w[j] * Rule::w[k] * area;
        if (parallelogram)
          add(e1 * x + e2 * y, w);
        else
          add(e1 * (x - x * y) + e2 * (x * y), w * x);
      }
    }
    if (parallelogram) break;
  }
  return nodes;
}

Outline outline_of(const PolygonEmitter& polygon) {
  Outline outline;
  outline.size2 = 0;
  for (const Vec3d& v : polygon.vertices) outline.size2 = std::max(outline.size2, dot(v - polygon.vertices[0], v - polygon.vertices[0]));
  outline.scale = unit_for(std::sqrt(outline.size2));
  outline.size2 *= outline.scale * outline.scale;
  outline.coarse = nodes_over<3>(polygon, outline.scale);
  outline.fine = nodes_over<5>(polygon, outline.scale);
  return outline;
}

class PolygonBatch final : public LightBatch::Shape {
 public:
  explicit PolygonBatch(const Emitter& white)
      : white_(white), polygon_(std::get<PolygonEmitter>(white.shape)), outline_(outline_of(polygon_)) {}
  std::size_t over(const PointBatch& points, std::span<float> sr, float where_none) const override {
    const auto place = [&](std::size_t i) {
      return Place(i < polygon_.vertices.size() ? (polygon_.vertices[i] - points.origin) * outline_.scale : Vec3d{});
    };
    const std::array<Place, 8> places{place(0), place(1), place(2), place(3), place(4), place(5), place(6), place(7)};
    const Coordinate plane(dot(polygon_.vertices[0] - points.origin, polygon_.normal) * outline_.scale);
    return HWY_DYNAMIC_DISPATCH(OverPolygon)({polygon_, outline_, points.origin, places, plane, white_}, points, sr, where_none);
  }

 private:
  Emitter white_;
  PolygonEmitter polygon_;
  Outline outline_;
};

}  // namespace

std::shared_ptr<const LightBatch::Shape> polygon_batch(const Emitter& white) {
  if (std::get<PolygonEmitter>(white.shape).vertices.size() < 3) return nullptr;
  return std::make_shared<PolygonBatch>(white);
}

}  // namespace etendue::eval
#endif
