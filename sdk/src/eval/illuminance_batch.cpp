// Spheres and polygons at many points: the closed forms of illuminance.cpp in vectors of floats.
#include "etendue/illuminance_batch.h"

#include "batch_error.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/illuminance_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#ifndef ETENDUE_ILLUMINANCE_BATCH_SHARED
#define ETENDUE_ILLUMINANCE_BATCH_SHARED
namespace etendue::eval {

// A coordinate as the sum of two floats: what is left of it after a point's coordinate is taken away has all its digits.
struct Coordinate {
  float high, low;
  explicit Coordinate(double x) : high(static_cast<float>(x)), low(static_cast<float>(x - static_cast<double>(high))) {}
};
struct Place {
  Coordinate x, y, z;
  explicit Place(const Vec3d& p) : x(p.x), y(p.y), z(p.z) {}
};

// Both are given in units of about the light's size, a power of two of metres: then no square leaves the range of a float.
struct BatchSphere {
  Place centre;
  float radius;
  double scale;  // units a metre
  bool two_sided;
};
struct LightBatch::Polygon {
  // Of Gauss and Legendre's: where, from the first vertex, and how much of the area.
  struct Node {
    float x, y, z, weight;
  };
  std::vector<Node> coarse, fine;  // 3 x 3 and 5 x 5
  float fine2, coarse2;            // squared distances from the first vertex beyond which they are enough
  double scale;                    // units a metre
};
struct BatchPolygon {
  const PolygonEmitter& polygon;
  const LightBatch::Polygon& prepared;
  Vec3d origin;
  std::span<const Place> places;  // of the first vertices
  Coordinate plane;               // normal.vertex
  double scale;
  bool two_sided;
};
// A point of its own in double, where floats are not enough.
struct InDouble {
  float (*at)(const Emitter& white, const PointBatch& points, std::size_t index);
  const Emitter& white;
};

}  // namespace etendue::eval
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct Vector {
  V x, y, z;
};
template <class V>
HWY_INLINE V dot(const Vector<V>& a, const Vector<V>& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
template <class V>
HWY_INLINE Vector<V> cross(const Vector<V>& a, const Vector<V>& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)), hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}
template <class V>
HWY_INLINE Vector<V> operator-(const Vector<V>& a, const Vector<V>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
// a + (b - a) t
template <class V>
HWY_INLINE Vector<V> between(const Vector<V>& a, const Vector<V>& b, V t) {
  return {hn::MulAdd(hn::Sub(b.x, a.x), t, a.x), hn::MulAdd(hn::Sub(b.y, a.y), t, a.y), hn::MulAdd(hn::Sub(b.z, a.z), t, a.z)};
}
template <class M, class V>
HWY_INLINE Vector<V> chosen(M mask, const Vector<V>& yes, const Vector<V>& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y), hn::IfThenElse(mask, yes.z, no.z)};
}

// atan(q) / q as a polynomial in z = q^2, q <= tan(22.5 deg): relative error 1.3e-9.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V atan_over(D d, V z) {
  V p = hn::Set(d, -0.060263049f);
  p = hn::MulAdd(p, z, hn::Set(d, 0.10569829f));
  p = hn::MulAdd(p, z, hn::Set(d, -0.14239533f));
  p = hn::MulAdd(p, z, hn::Set(d, 0.19998182f));
  p = hn::MulAdd(p, z, hn::Set(d, -0.33333308f));
  return hn::MulAdd(p, z, hn::Set(d, 1.0f));
}

// The angle of (x, y), y >= 0: 0 to pi, with a relative error of a few roundings; 0 for (0, 0).
template <class D, class V = hn::Vec<D>>
HWY_INLINE V angle_of(D d, V y, V x) {
  const V ax = hn::Abs(x), longer = hn::Max(ax, y), shorter = hn::Min(ax, y), zero = hn::Zero(d);
  const auto far = hn::Gt(shorter, hn::Mul(hn::Set(d, 0.41421356f), longer));
  const V numerator = hn::Sub(shorter, hn::IfThenElseZero(far, longer)), denominator = hn::Add(longer, hn::IfThenElseZero(far, shorter));
  const V q = hn::IfThenElseZero(hn::Gt(denominator, zero), hn::Div(numerator, denominator));
  const V octant = hn::MulAdd(atan_over(d, hn::Mul(q, q)), q, hn::IfThenElseZero(far, hn::Set(d, 0.78539816f)));
  const V quadrant = hn::IfThenElse(hn::Gt(y, ax), hn::Sub(hn::Set(d, 1.57079633f), octant), octant);
  return hn::IfThenElse(hn::Lt(x, zero), hn::Sub(hn::Set(d, 3.14159265f), quadrant), quadrant);
}

template <class V>
struct Point {
  Vector<V> position, normal;
};
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vector<V> towards(D d, const Place& place, const Vector<V>& position) {
  const auto along = [&](const Coordinate& c, V p) { return hn::Add(hn::Sub(hn::Set(d, c.high), p), hn::Set(d, c.low)); };
  return {along(place.x, position.x), along(place.y, position.y), along(place.z, position.z)};
}

// A cap of sine s and cosine c about the direction at the height u = n.axis. Above the horizon pi s^2 u. Where it is cut, with phi half the
// angle of the circle's part above and psi half the angle of the horizon's part below the cap, the integral of half b x db gives
//     phi s^2 u - c q + psi,   q = sqrt(s^2 - u^2), phi = angle(-c u, q), psi = atan(k), k = q / c,
// and with c q = c^2 k = k - s^2 k it is s^2 (phi u + k) - (k - atan k), whose terms are no larger than the result's order s^3.
// `alone` marks lanes so close to the surface that c, a root of a difference, has too few digits.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE V over_sphere(D d, const BatchSphere& light, const Point<V>& point, M& alone) {
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f), radius = hn::Set(d, light.radius), pi_ = hn::Set(d, 3.14159265f);
  const Vector<V> centre = towards(d, light.centre, point.position);
  const V distance = hn::Sqrt(dot(centre, centre));
  const auto outside = hn::Gt(distance, radius);
  alone = hn::Lt(hn::Abs(hn::Sub(distance, radius)), hn::Mul(hn::Set(d, 0.004f), radius));
  const V inverse = hn::Div(one, hn::IfThenElse(outside, distance, one));
  const V s = hn::Mul(radius, inverse);
  const V c = hn::Mul(hn::Sqrt(hn::Max(hn::Mul(hn::Sub(distance, radius), hn::Add(distance, radius)), zero)), inverse);
  const V u = hn::Mul(dot(centre, point.normal), inverse), s2 = hn::Mul(s, s);
  V value = hn::Mul(hn::Mul(pi_, s2), hn::Max(u, zero));
  const auto cut = hn::And(hn::Lt(hn::Abs(u), s), outside);
  if (!hn::AllFalse(d, cut)) {
    const V q = hn::Sqrt(hn::Max(hn::Mul(hn::Sub(s, u), hn::Add(s, u)), zero));
    const V phi = angle_of(d, q, hn::Neg(hn::Mul(c, u))), psi = angle_of(d, q, c);
    // k - atan k: a series in k where the difference would cancel.
    const V k = hn::Div(q, hn::Max(c, hn::Set(d, 1e-6f))), k2 = hn::Mul(k, k);
    V series = hn::Set(d, -0.060263049f);
    series = hn::MulAdd(series, k2, hn::Set(d, 0.10569829f));
    series = hn::MulAdd(series, k2, hn::Set(d, -0.14239533f));
    series = hn::MulAdd(series, k2, hn::Set(d, 0.19998182f));
    series = hn::MulAdd(series, k2, hn::Set(d, -0.33333308f));
    const V narrow = hn::MulAdd(s2, hn::MulAdd(phi, u, k), hn::Mul(hn::Mul(series, k2), k));
    const V wide = hn::Add(hn::MulSub(hn::Mul(phi, s2), u, hn::Mul(c, q)), psi);
    const V part = hn::IfThenElse(hn::Lt(k, hn::Set(d, 0.41421356f)), narrow, wide);
    value = hn::IfThenElse(cut, hn::Max(part, zero), value);
  }
  return hn::IfThenElse(outside, value, light.two_sided ? pi_ : zero);
}

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
HWY_INLINE V over_area(D d, std::span<const LightBatch::Polygon::Node> nodes, const Vector<V>& first, const Vector<V>& normal, V height) {
  V sum = hn::Zero(d);
  for (const LightBatch::Polygon::Node& node : nodes) {
    const Vector<V> q{hn::Add(first.x, hn::Set(d, node.x)), hn::Add(first.y, hn::Set(d, node.y)), hn::Add(first.z, hn::Set(d, node.z))};
    const V q2 = dot(q, q);
    sum = hn::MulAdd(hn::Set(d, node.weight), hn::Div(dot(q, normal), hn::Mul(q2, q2)), sum);
  }
  return hn::Mul(sum, height);
}

// Lambert's sum over the edges, cut at the horizon as they come: where the outline goes below, the horizon closes it from there to where it
// comes up again. `alone` marks the lanes that floats are not enough for: far lights that the horizon cuts, and lights seen edge-on, whose
// edges cancel to a small part of what each contributes.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE V over_polygon(D d, const BatchPolygon& light, const Point<V>& point, M& alone) {
  const V zero = hn::Zero(d);
  const std::vector<Vec3d>& vertices = light.polygon.vertices;
  const std::size_t count = vertices.size();
  const auto vertex = [&](std::size_t i) {
    return towards(d, i < light.places.size() ? light.places[i] : Place((vertices[i] - light.origin) * light.scale), point.position);
  };
  const Vector<V> first = vertex(0);
  const Vector<V> facing{hn::Set(d, static_cast<float>(light.polygon.normal.x)), hn::Set(d, static_cast<float>(light.polygon.normal.y)),
                         hn::Set(d, static_cast<float>(light.polygon.normal.z))};
  const V height = hn::Sub(hn::Sub(dot(point.position, facing), hn::Set(d, light.plane.high)), hn::Set(d, light.plane.low));
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
  V value = hn::Mul(hn::Set(d, -0.5f), sum);
  const V from_first2 = dot(first, first), grazing = hn::Mul(hn::Abs(height), hn::Abs(height));
  const M far = hn::Gt(from_first2, hn::Set(d, light.prepared.coarse2)), cut = hn::And(hn::Lt(lowest, zero), hn::Gt(highest, zero));
  const auto lower_than = [&](float part) { return hn::Lt(grazing, hn::Mul(hn::Set(d, part * part), from_first2)); };
  // Edges that cancel to less than a hundredth of what each contributes.
  const M cancelled = hn::And(hn::Lt(hn::Abs(value), hn::Set(d, 0.006f)), lower_than(0.4f));
  const M middle = hn::AndNot(hn::Or(cut, far), hn::And(cancelled, hn::Gt(from_first2, hn::Set(d, light.prepared.fine2))));
  const M whole = hn::AndNot(cut, far);
  if (!hn::AllFalse(d, middle)) value = hn::IfThenElse(middle, over_area(d, light.prepared.fine, first, point.normal, height), value);
  if (!hn::AllFalse(d, whole)) value = hn::IfThenElse(whole, over_area(d, light.prepared.coarse, first, point.normal, height), value);
  const M front = hn::Gt(height, zero), seen = light.two_sided ? hn::Or(front, hn::Lt(height, zero)) : front;
  const M lit = hn::And(seen, hn::Gt(highest, zero));
  value = hn::IfThenElseZero(lit, hn::Max(hn::IfThenElse(front, value, hn::Neg(value)), zero));
  const M by_edges = hn::And(hn::Not(hn::Or(middle, whole)), hn::Or(hn::And(cut, hn::Or(far, lower_than(0.05f))), cancelled));
  alone = hn::And(lit, hn::Or(by_edges, hn::And(hn::Lt(value, hn::Set(d, 0.05f)), lower_than(0.01f))));
  return value;
}

// body(point, first index, number) for every vector of points; positions in the light's unit. How many points are not finite.
template <class Body>
HWY_INLINE std::size_t each_vector(const PointBatch& points, float scale, float where_none, std::span<float> out, Body body) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  const std::size_t lanes = hn::Lanes(d), count = out.size();
  std::size_t without = 0;
  const auto over = [&](const std::array<const float*, 6>& in, std::size_t first, std::size_t number, float* to) {
    const V x = hn::LoadU(d, in[0]), y = hn::LoadU(d, in[1]), z = hn::LoadU(d, in[2]);
    const Vector<V> normal{hn::LoadU(d, in[3]), hn::LoadU(d, in[4]), hn::LoadU(d, in[5])};
    const auto finite = [&](V a, V b, V c) { return hn::And(hn::IsFinite(a), hn::And(hn::IsFinite(b), hn::IsFinite(c))); };
    const auto valid = hn::And(finite(x, y, z), finite(normal.x, normal.y, normal.z));
    const V unit = hn::Set(d, scale);
    const Point<V> point{{hn::Mul(x, unit), hn::Mul(y, unit), hn::Mul(z, unit)}, normal};
    const V value = body(d, point, first, number);
    // Coordinates whose squares are too large for a float are infinitely far: no light.
    const V bounded = hn::IfThenElseZero(hn::Lt(value, hn::Set(d, 4.0f)), value);
    hn::StoreU(hn::IfThenElse(valid, bounded, hn::Set(d, where_none)), d, to);
    without += lanes - hn::CountTrue(d, valid);
  };
  const std::array<const float*, 6> all{points.px.data(), points.py.data(), points.pz.data(),
                                        points.nx.data(), points.ny.data(), points.nz.data()};
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    std::array<const float*, 6> in = all;
    for (const float*& p : in) p += i;
    over(in, i, lanes, out.data() + i);
  }
  if (i == count) return without;
  HWY_ALIGN float last[7][hn::MaxLanes(d)];
  std::array<const float*, 6> in = all;
  for (std::size_t k = 0; k < 6; ++k) {
    std::fill_n(last[k], lanes, 1.0f);
    std::copy(all[k] + i, all[k] + count, last[k]);
    in[k] = last[k];
  }
  over(in, i, count - i, last[6]);
  std::copy_n(last[6], count - i, out.data() + i);
  return without;
}

template <class Light, class Kernel>
HWY_INLINE std::size_t over_light(const Light& light, const PointBatch& points, float where_none, std::span<float> out, const InDouble& one,
                                  Kernel kernel) {
  return each_vector(points, static_cast<float>(light.scale), where_none, out,
                     [&](auto d, const auto& point, std::size_t first, std::size_t number) {
                       auto alone = hn::FirstN(d, 0);
                       const auto value = kernel(d, light, point, alone);
                       if (hn::AllFalse(d, alone)) return value;
                       HWY_ALIGN float values[hn::MaxLanes(d)], is_alone[hn::MaxLanes(d)];
                       hn::Store(value, d, values);
                       hn::Store(hn::IfThenElseZero(alone, hn::Set(d, 1.0f)), d, is_alone);
                       for (std::size_t k = 0; k < number; ++k)
                         if (is_alone[k] != 0) values[k] = one.at(one.white, points, first + k);
                       return hn::Load(d, values);
                     });
}
std::size_t OverSphere(const BatchSphere& light, const PointBatch& points, float where_none, std::span<float> out, const InDouble& one) {
  return over_light(light, points, where_none, out, one,
                    [](auto d, const BatchSphere& l, const auto& point, auto& alone) { return over_sphere(d, l, point, alone); });
}
std::size_t OverPolygon(const BatchPolygon& light, const PointBatch& points, float where_none, std::span<float> out, const InDouble& one) {
  return over_light(light, points, where_none, out, one,
                    [](auto d, const BatchPolygon& l, const auto& point, auto& alone) { return over_polygon(d, l, point, alone); });
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {
namespace {

HWY_EXPORT(OverSphere);
HWY_EXPORT(OverPolygon);

Vec3d at(std::span<const float> x, std::span<const float> y, std::span<const float> z, std::size_t i) {
  return {static_cast<double>(x[i]), static_cast<double>(y[i]), static_cast<double>(z[i])};
}
float in_double(const Emitter& white, const PointBatch& p, std::size_t i) {
  return static_cast<float>(illuminance(white, at(p.px, p.py, p.pz, i) + p.origin, normalised(at(p.nx, p.ny, p.nz, i))).x);
}

// The power of two that brings a length to between 1 and 2.
double unit_for(double size) { return size > 0 && std::isfinite(size) ? std::exp2(-std::floor(std::log2(size))) : 1; }

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
std::vector<LightBatch::Polygon::Node> nodes_over(const PolygonEmitter& polygon, double scale) {
  using Rule = GaussLegendre<Order>;
  const std::vector<Vec3d>& v = polygon.vertices;
  std::vector<LightBatch::Polygon::Node> nodes;
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

bool is_area_light(const EmitterShape& shape) {
  return std::holds_alternative<SphereEmitter>(shape) || std::holds_alternative<PolygonEmitter>(shape) ||
         std::holds_alternative<DiskEmitter>(shape) || std::holds_alternative<TubeEmitter>(shape) ||
         std::holds_alternative<MeshEmitter>(shape);
}

}  // namespace

Result<LightBatch> LightBatch::of(const Emitter& emitter) {
  const bool windowed = emitter.window.falloff != Falloff::inverse_square && emitter.window.range_m > 0;
  if (!is_area_light(emitter.shape) || emitter.pattern || windowed)
    return Error{"EVALUATION_UNSUPPORTED", "expected an area light without pattern and range", {}, {}, {}};
  return LightBatch(emitter);
}

LightBatch::LightBatch(const Emitter& emitter) : white_(emitter) {
  white_.radiance = {1, 1, 1};
  const auto* polygon = std::get_if<PolygonEmitter>(&emitter.shape);
  if (polygon == nullptr || polygon->vertices.size() < 3) return;
  double size2 = 0;
  for (const Vec3d& v : polygon->vertices) size2 = std::max(size2, dot(v - polygon->vertices[0], v - polygon->vertices[0]));
  Polygon prepared;
  prepared.scale = unit_for(std::sqrt(size2));
  prepared.coarse = nodes_over<3>(*polygon, prepared.scale);
  prepared.fine = nodes_over<5>(*polygon, prepared.scale);
  size2 *= prepared.scale * prepared.scale;
  prepared.fine2 = static_cast<float>(2.5 * 2.5 * size2);
  prepared.coarse2 = static_cast<float>(4.5 * 4.5 * size2);
  polygon_ = std::make_shared<const Polygon>(std::move(prepared));
}

BatchOutcome LightBatch::projected_solid_angles(const PointBatch& points, std::span<float> sr, float where_none) const {
  for (const std::span<const float>& s : {points.px, points.py, points.pz, points.nx, points.ny, points.nz})
    if (s.size() != sr.size()) return batch_sizes_differ(s.size(), sr.size());
  if (const auto* sphere = std::get_if<SphereEmitter>(&white_.shape)) {
    const double unit = unit_for(sphere->radius);
    const BatchSphere light{Place((sphere->centre - points.origin) * unit), static_cast<float>(sphere->radius * unit), unit,
                            white_.two_sided};
    return HWY_DYNAMIC_DISPATCH(OverSphere)(light, points, where_none, sr, {in_double, white_});
  }
  if (polygon_) {
    const auto& polygon = std::get<PolygonEmitter>(white_.shape);
    const auto place = [&](std::size_t i) {
      return Place(i < polygon.vertices.size() ? (polygon.vertices[i] - points.origin) * polygon_->scale : Vec3d{});
    };
    const std::array<Place, 8> places{place(0), place(1), place(2), place(3), place(4), place(5), place(6), place(7)};
    const Coordinate plane(dot(polygon.vertices[0] - points.origin, polygon.normal) * polygon_->scale);
    const BatchPolygon light{polygon, *polygon_, points.origin, places, plane, polygon_->scale, white_.two_sided};
    return HWY_DYNAMIC_DISPATCH(OverPolygon)(light, points, where_none, sr, {in_double, white_});
  }
  std::size_t without = 0;
  for (std::size_t i = 0; i < sr.size(); ++i) {
    const Vec3d p = at(points.px, points.py, points.pz, i), n = at(points.nx, points.ny, points.nz, i);
    const bool valid = std::isfinite(dot(p, p)) && std::isfinite(dot(n, n));
    sr[i] = valid ? in_double(white_, points, i) : where_none;
    if (!valid) ++without;
  }
  return without;
}

}  // namespace etendue::eval
#endif
