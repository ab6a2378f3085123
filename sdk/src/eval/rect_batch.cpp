// The rectangle at many points: the edges' closed form in the light's own frame, cut at the horizon, in vectors.
#include "light_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/rect_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <array>
#include <cmath>

#include "eval/edge_batch-inl.h"
#include "eval/light_batch-inl.h"

#ifndef ETENDUE_RECT_BATCH_SHARED
#define ETENDUE_RECT_BATCH_SHARED
namespace etendue::eval {
// In units of the batch.
struct PlacedRect {
  Place centre;
  Direction x, y, normal;
  Constant half_x, half_y, width, height;
  Constant reach2;        // of the corners from the centre
  Constant area, longer;  // of both sides
  double scale;           // units a metre
  const Emitter& white;
  PlacedRect(const Place& c, const Vec3d& along_x, const Vec3d& along_y, const Vec3d& n, double hx, double hy, double units,
             const Emitter& e)
      : centre(c),
        x(along_x),
        y(along_y),
        normal(n),
        half_x(hx),
        half_y(hy),
        width(2 * hx),
        height(2 * hy),
        reach2(hx * hx + hy * hy),
        area(4 * hx * hy),
        longer(2 * std::max(hx, hy)),
        scale(units),
        white(e) {}
};
}  // namespace etendue::eval
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

// A side of the rectangle, or what is above the horizon of it: at (other, z) from `start` on by `length` with its sign.
template <class V>
struct Side {
  V from, to, sum;  // as Edge's
  V start, length, other;
  V m;  // n.(a x the unit vector along the side), a anywhere on it
};
// The horizon's part that closes a cut outline, from (x, y, z) by (dx, dy, 0).
template <class V>
struct HorizonSide {
  V from, to, x, y, dx, dy;
  V m;  // n.(a x b)
};
// What all sides share.
template <class V, class M>
struct RectSums {
  V z, z2, r2, per_r2;
  Special<M> special;
  V sum, closest;  // Lambert's sum without the area's part; one over the distance of the closest side that passes beside the point
};

template <std::size_t N, class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE void add_rests(D d, RectSums<V, M>& at, const std::array<Side<V>, 4>& sides, const EdgeRests<N, V, M>& edges) {
  const auto part = [&](std::size_t i) ETENDUE_INLINE_LAMBDA { return hn::Mul(edges.rest[i], sides[i].length); };
  const V two = hn::MulAdd(part(0), sides[0].m, hn::Mul(part(1), sides[1].m)),
          other = hn::MulAdd(part(2), sides[2].m, hn::Mul(part(3), sides[3].m));
  at.sum = hn::Add(at.sum, hn::Add(two, other));
  if (!edges.any_obtuse) return;
  each<4>([&](auto i) ETENDUE_INLINE_LAMBDA {
    const V h = hn::Max(hn::MulAdd(sides[i].other, sides[i].other, at.z2), number(d, 1e-36)), closeness = inverse_sqrt(d, h);
    at.closest = hn::Max(at.closest, hn::IfThenElseZero(edges.obtuse[i], closeness));
    const V straight = hn::CopySign(hn::Mul(hn::Mul(number(d, pi), closeness), at.r2), sides[i].length);
    at.sum = hn::MulAdd(hn::IfThenElseZero(edges.obtuse[i], straight), sides[i].m, at.sum);
  });
}
template <class D, class V = hn::Vec<D>, class M>
HWY_INLINE Edge<V> edge_of(D d, const RectSums<V, M>& at, const Side<V>& s) {
  return {s.from, s.to, s.sum, hn::Mul(hn::Mul(hn::Mul(s.length, s.length), number(d, 0.5)), at.per_r2)};
}
template <class D, class V = hn::Vec<D>, class M>
HWY_INLINE Products<V> products_of(D, const RectSums<V, M>& at, const Side<V>& s) {
  const V h = hn::MulAdd(s.other, s.other, at.z2), end = hn::Add(s.start, s.length);
  return {hn::Mul(hn::Mul(hn::MulAdd(s.start, s.start, h), at.per_r2), hn::Mul(hn::MulAdd(end, end, h), at.per_r2)),
          hn::Mul(hn::MulAdd(s.start, end, h), at.per_r2)};
}
template <class D, class V = hn::Vec<D>, class M>
HWY_INLINE Products<V> products_of(D, const RectSums<V, M>& at, const HorizonSide<V>& s) {
  const V bx = hn::Add(s.x, s.dx), by = hn::Add(s.y, s.dy);
  const V a2 = hn::MulAdd(s.x, s.x, hn::MulAdd(s.y, s.y, at.z2)), b2 = hn::MulAdd(bx, bx, hn::MulAdd(by, by, at.z2));
  return {hn::Mul(hn::Mul(a2, at.per_r2), hn::Mul(b2, at.per_r2)), hn::Mul(hn::MulAdd(s.x, bx, hn::MulAdd(s.y, by, at.z2)), at.per_r2)};
}
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE void add_sides(D d, RectSums<V, M>& at, const std::array<Side<V>, 4>& s) {
  const std::array<Edge<V>, 4> edges{edge_of(d, at, s[0]), edge_of(d, at, s[1]), edge_of(d, at, s[2]), edge_of(d, at, s[3])};
  add_rests(d, at, s, edge_rests(d, edges, at.special, [&](auto i) ETENDUE_INLINE_LAMBDA { return products_of(d, at, s[i]); }));
}
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE void add_sides(D d, RectSums<V, M>& at, const std::array<Side<V>, 4>& s, const HorizonSide<V>& horizon, M cut) {
  const V half_length2 = hn::Mul(hn::Mul(hn::MulAdd(horizon.dx, horizon.dx, hn::Mul(horizon.dy, horizon.dy)), number(d, 0.5)), at.per_r2);
  const std::array<Edge<V>, 5> edges{edge_of(d, at, s[0]), edge_of(d, at, s[1]), edge_of(d, at, s[2]), edge_of(d, at, s[3]),
                                     Edge<V>{horizon.from, horizon.to, hn::Add(horizon.from, horizon.to), half_length2}};
  const EdgeRests<5, V, M> rests = edge_rests(d, edges, at.special, [&](auto i) ETENDUE_INLINE_LAMBDA {
    if constexpr (i < 4)
      return products_of(d, at, s[i]);
    else
      return products_of(d, at, horizon);
  });
  // Along the horizon |a x b| = |m|, and what is seen lies on the normal's side: m has the sign of z, which half a turn from a to b leaves
  // no digit of.
  const V straight = hn::IfThenElseZero(rests.obtuse[4], hn::Mul(hn::CopySign(number(d, pi), at.z), at.r2));
  at.sum = hn::Add(at.sum, hn::IfThenElseZero(cut, hn::MulAdd(rests.rest[4], horizon.m, straight)));
  add_rests(d, at, s, rests);
}

template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE V over_rect(D d, const PlacedRect& light, const Point<V>& point, M& doubtful) {
  const V zero = hn::Zero(d), half_x = number(d, light.half_x), half_y = number(d, light.half_y);
  const Vector<V> x = numbers(d, light.x), y = numbers(d, light.y), facing = numbers(d, light.normal);
  const Vector<V> to_centre = towards(d, light.centre, point.position);
  const Vector<V> c{dot(to_centre, x), dot(to_centre, y), dot(to_centre, facing)};
  const Vector<V> n{dot(point.normal, x), dot(point.normal, y), dot(point.normal, facing)};
  const V z = c.z, up = dot(to_centre, point.normal), up_x = hn::Mul(n.x, half_x), up_y = hn::Mul(n.y, half_y);
  const V spread = hn::Add(hn::Abs(up_x), hn::Abs(up_y));
  const V reach2 = number(d, light.reach2), r2 = hn::Add(dot(to_centre, to_centre), reach2);
  const Sides<M> side = sides_of(d, z, r2, light.white.two_sided);
  const M above = hn::Gt(up, hn::Neg(spread)), lit = hn::And(side.seen, above), cut = hn::And(lit, hn::Lt(up, spread));
  doubtful = hn::And(side.unsure, above);
  if (hn::AllFalse(d, lit)) return zero;
  // r: of the corners' mean square. The corners' (a^2 - r^2) / r^2 are +-p +-q.
  const V per_r2 = inverse(d, r2), twice = hn::Add(per_r2, per_r2);
  const V per_x = hn::Mul(twice, c.x), per_y = hn::Mul(twice, c.y);
  const V p2 = hn::Mul(c.x, number(d, light.width)), q2 = hn::Mul(c.y, number(d, light.height));
  const V p = hn::Mul(p2, per_r2), q = hn::Mul(q2, per_r2), sum_pq = hn::Mul(hn::Add(p2, q2), per_r2),
          difference = hn::Mul(hn::Sub(p2, q2), per_r2);
  const V at00 = hn::Neg(sum_pq), at10 = difference, at11 = sum_pq, at01 = hn::Neg(difference);
  // n.(a x unit vector along the edge), a anywhere on it.
  const V m_x = hn::Mul(n.x, z), m_y = hn::Mul(n.y, z);
  const V y0 = hn::Sub(c.y, half_y), y1 = hn::Add(c.y, half_y), x0 = hn::Sub(c.x, half_x), x1 = hn::Add(c.x, half_x);
  const V m_bottom = hn::NegMulAdd(n.z, y0, m_y), m_top = hn::NegMulAdd(n.z, y1, m_y);
  const V m_left = hn::MulSub(n.z, x0, m_x), m_right = hn::MulSub(n.z, x1, m_x);
  const V area = number(d, light.area);
  V twice_area, least = hn::Neg(hn::Max(hn::Abs(sum_pq), hn::Abs(difference)));
  RectSums<V, M> at{z, hn::Mul(z, z), r2, per_r2, {cut, cut}, zero, zero};
  if (hn::AllFalse(d, cut)) {
    at.special = special_at(d, least, r2, reach2);
    const V width = number(d, light.width), height = number(d, light.height);
    twice_area = hn::Add(area, area);
    const V twice_p = hn::Add(p, p), twice_q = hn::Add(q, q);
    add_sides(d, at,
              {Side<V>{at00, at10, hn::Neg(twice_q), x0, width, y0, m_bottom}, Side<V>{at10, at11, twice_p, y0, height, x1, m_right},
               Side<V>{at11, at01, twice_q, x1, hn::Neg(width), y1, m_top},
               Side<V>{at01, at00, hn::Neg(twice_p), y1, hn::Neg(height), x0, m_left}});
  } else {
    const auto below = [&](V a, V b) ETENDUE_INLINE_LAMBDA { return hn::Lt(hn::Add(up, hn::Add(a, b)), zero); };
    const V down_x = hn::Neg(up_x), down_y = hn::Neg(up_y);
    const M b00 = below(down_x, down_y), b10 = below(up_x, down_y), b11 = below(up_x, up_y), b01 = below(down_x, up_y);
    // Where the lines of the edges meet the horizon, from the centre, within the edges; (a^2 - r^2) / r^2 there.
    const V one = number(d, 1), tiny = number(d, 1e-30);
    const auto over = [&](V a) ETENDUE_INLINE_LAMBDA { return hn::Div(one, hn::IfThenElse(hn::Lt(hn::Abs(a), tiny), tiny, a)); };
    const V over_x = over(n.x), over_y = over(n.y);
    const auto within = [&](V at, V half) ETENDUE_INLINE_LAMBDA { return hn::Min(hn::Max(at, hn::Neg(half)), half); };
    const V bottom = within(hn::Mul(hn::Sub(up_y, up), over_x), half_x), top = within(hn::Mul(hn::Sub(down_y, up), over_x), half_x);
    const V left = within(hn::Mul(hn::Sub(up_x, up), over_y), half_y), right = within(hn::Mul(hn::Sub(down_x, up), over_y), half_y);
    const auto rest_at = [&](V at, V per, V other, V half) ETENDUE_INLINE_LAMBDA {
      return hn::MulAdd(at, per, hn::MulAdd(hn::Mul(hn::Sub(at, half), hn::Add(at, half)), per_r2, other));
    };
    const V at_bottom = rest_at(bottom, per_x, hn::Neg(q), half_x), at_top = rest_at(top, per_x, q, half_x);
    const V at_left = rest_at(left, per_y, hn::Neg(p), half_y), at_right = rest_at(right, per_y, p, half_y);
    const V back_x = hn::Neg(half_x), back_y = hn::Neg(half_y);
    // The outline goes below once and comes up once; the horizon joins both places.
    struct Crossing {
      V x, y, rest;
    };
    const auto crossing = [&](M is_bottom, M is_right, M is_top) ETENDUE_INLINE_LAMBDA {
      const auto one_of = [&](V a, V b, V e, V f) ETENDUE_INLINE_LAMBDA {
        return hn::IfThenElse(is_bottom, a, hn::IfThenElse(is_right, b, hn::IfThenElse(is_top, e, f)));
      };
      return Crossing{one_of(bottom, half_x, top, back_x), one_of(back_y, right, half_y, left),
                      one_of(at_bottom, at_right, at_top, at_left)};
    };
    const Crossing gone = crossing(hn::AndNot(b00, b10), hn::AndNot(b10, b11), hn::AndNot(b11, b01));
    const Crossing risen = crossing(hn::AndNot(b10, b00), hn::AndNot(b11, b10), hn::AndNot(b01, b11));
    least = hn::IfThenElse(cut, hn::Min(least, hn::Min(gone.rest, risen.rest)), least);
    at.special = special_at(d, least, r2, reach2);
    const auto part = [&](M start_below, M end_below, V start, V end, V crossing, V from, V to, V at_crossing, V middle, V other,
                          V m) ETENDUE_INLINE_LAMBDA {
      start = hn::IfThenElse(start_below, crossing, start);
      const V length = hn::IfThenZeroElse(hn::And(start_below, end_below), hn::Sub(hn::IfThenElse(end_below, crossing, end), start));
      from = hn::IfThenElse(start_below, at_crossing, from);
      to = hn::IfThenElse(end_below, at_crossing, to);
      return Side<V>{from, to, hn::Add(from, to), hn::Add(middle, start), length, other, m};
    };
    const std::array<Side<V>, 4> sides{part(b00, b10, back_x, half_x, bottom, at00, at10, at_bottom, c.x, y0, m_bottom),
                                       part(b10, b11, back_y, half_y, right, at10, at11, at_right, c.y, x1, m_right),
                                       part(b11, b01, half_x, back_x, top, at11, at01, at_top, c.x, y1, m_top),
                                       part(b01, b00, half_y, back_y, left, at01, at00, at_left, c.y, x0, m_left)};
    const V dx = hn::Sub(risen.x, gone.x), dy = hn::Sub(risen.y, gone.y), ax = hn::Add(c.x, gone.x), ay = hn::Add(c.y, gone.y);
    const V m = hn::MulAdd(z, hn::MulSub(n.y, dx, hn::Mul(n.x, dy)), hn::Mul(n.z, hn::MulSub(ax, dy, hn::Mul(ay, dx))));
    add_sides(d, at, sides, {gone.rest, risen.rest, ax, ay, dx, dy, m}, cut);
    // Of the outline's cross products about the centre.
    twice_area = hn::IfThenElseZero(cut, hn::MulSub(gone.x, risen.y, hn::Mul(gone.y, risen.x)));
    twice_area = hn::MulAdd(half_y, hn::Sub(sides[0].length, sides[2].length), twice_area);
    twice_area = hn::MulAdd(half_x, hn::Sub(sides[1].length, sides[3].length), twice_area);
  }
  const V facing_part = hn::Mul(twice_area, n.z);
  const V value = hn::Mul(hn::Mul(number(d, -0.5), per_r2), hn::Add(facing_part, at.sum));
  const Cancellation<V, M> terms{value, n.z, z, r2, per_r2, area, number(d, light.longer), at.closest, least, hn::Not(cut)};
  doubtful = hn::Or(doubtful, hn::And(lit, cancels(d, terms)));
  return hn::IfThenElseZero(lit, hn::Max(hn::IfThenElse(side.front, value, hn::Neg(value)), zero));
}

struct RectKernel {
  const PlacedRect& light;
  template <class D, class V, class M>
  HWY_INLINE V operator()(D d, const Point<V>& point, M& doubtful) const {
    return over_rect(d, light, point, doubtful);
  }
};
std::size_t OverRect(const PlacedRect& light, const PointBatch& points, std::span<float> sr, float where_none) {
  return at_every_point(light.white, light.scale, points, sr, where_none, RectKernel{light});
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {
namespace {

HWY_EXPORT(OverRect);

class RectBatch final : public LightBatch::Shape {
 public:
  RectBatch(const Emitter& white, const Vec3d& along_x, const Vec3d& along_y)
      : white_(white),
        first_(std::get<PolygonEmitter>(white.shape).vertices[0]),
        middle_((along_x + along_y) * 0.5),
        x_(normalised(along_x)),
        y_(normalised(along_y)),
        normal_(std::get<PolygonEmitter>(white.shape).normal),
        half_x_(length(along_x) / 2),
        half_y_(length(along_y) / 2),
        scale_(unit_for(std::max(half_x_, half_y_))) {}
  std::size_t over(const PointBatch& points, std::span<float> sr, float where_none) const override {
    const Place centre((first_ - points.origin + middle_) * scale_);
    return HWY_DYNAMIC_DISPATCH(OverRect)(PlacedRect(centre, x_, y_, normal_, half_x_ * scale_, half_y_ * scale_, scale_, white_), points,
                                          sr, where_none);
  }

 private:
  Emitter white_;
  Vec3d first_, middle_;  // the middle from the first corner: far from the origin their sum would be rounded
  Vec3d x_, y_, normal_;
  double half_x_, half_y_, scale_;
};

}  // namespace

std::shared_ptr<const LightBatch::Shape> rect_batch(const Emitter& white) {
  const auto& v = std::get<PolygonEmitter>(white.shape).vertices;
  if (v.size() != 4) return nullptr;
  const Vec3d x = v[1] - v[0], y = v[3] - v[0], skew = v[2] - v[1] - y;
  const double area = length(x) * length(y);
  // Far from the origin corners are off by a double's rounding; where that shows, they are those of a polygon.
  constexpr double rounding = 1e-12;
  if (!(area > 0) || std::abs(dot(x, y)) > rounding * area) return nullptr;
  if (dot(skew, skew) > rounding * rounding * std::min(dot(x, x), dot(y, y))) return nullptr;
  return std::make_shared<RectBatch>(white, x, y);
}

}  // namespace etendue::eval
#endif
