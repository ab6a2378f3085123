// Sides of SideBlock from arcs of directions, a point a lane of doubles, once for each instruction set: include it after
// HWY_TARGET_INCLUDE and hwy/foreach_target.h.
#if defined(ETENDUE_SPECULAR_SIDES_INL_H) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard, once an instruction set
#ifdef ETENDUE_SPECULAR_SIDES_INL_H
#undef ETENDUE_SPECULAR_SIDES_INL_H
#else
#define ETENDUE_SPECULAR_SIDES_INL_H
#endif

#include "eval/arc_tangent-inl.h"
#include "eval/light_batch-inl.h"
#include "specular_outline.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

using Doubles = hn::ScalableTag<double>;
using Wide = hn::Vec<Doubles>;
using WideMask = hn::Mask<Doubles>;
using Wide3 = Vector<Wide>;

HWY_INLINE Wide wide(double x) { return hn::Set(Doubles(), x); }
HWY_INLINE Wide3 wide(const Vec3d& v) { return {wide(v.x), wide(v.y), wide(v.z)}; }
HWY_INLINE WideMask none_of() { return hn::FirstN(Doubles(), 0); }
HWY_INLINE Wide3 times(const Wide3& v, Wide s) { return {hn::Mul(v.x, s), hn::Mul(v.y, s), hn::Mul(v.z, s)}; }
HWY_INLINE Wide3 wide_unit(const Wide3& v) { return times(v, inverse_root(Doubles(), hn::Max(dot(v, v), wide(1e-300)))); }
HWY_INLINE Wide3 plus(const Wide3& a, const Wide3& b, Wide s) {
  return {hn::MulAdd(b.x, s, a.x), hn::MulAdd(b.y, s, a.y), hn::MulAdd(b.z, s, a.z)};
}
HWY_INLINE Wide wide_root(Wide x) { return hn::Sqrt(hn::Max(x, wide(0))); }

HWY_INLINE void store(const Wide& v, float* to) {
  const hn::Rebind<float, Doubles> floats;
  hn::StoreU(hn::DemoteTo(floats, v), floats, to);
}

// A vector of points in their own frame: z along the normal, the view at x >= 0, y = 0.
struct WidePoints {
  Wide3 position, x, y, z, view;
  Wide alpha, cosine, nothing;  // n.v; 0 where all is finite

  HWY_INLINE WidePoints(const PlaceBlock& places, std::size_t first) {
    const auto load = [&](std::size_t k) ETENDUE_INLINE_LAMBDA { return hn::LoadU(Doubles(), places.numbers[k].data() + first); };
    const Wide zero = wide(0), one = wide(1);
    position = {load(0), load(1), load(2)};
    const Wide3 normal{load(3), load(4), load(5)}, towards{load(6), load(7), load(8)};
    z = wide_unit(normal);
    const Wide3 v = wide_unit(towards);
    const Wide rough = load(9);
    alpha = hn::Min(hn::Max(rough, wide(1e-4)), one);
    cosine = dot(z, v);
    Wide3 across = plus(v, z, hn::Neg(cosine));
    const WideMask upright = hn::Lt(dot(across, across), wide(1e-20)), steep = hn::Gt(hn::Abs(z.x), wide(0.7));
    const Wide3 axis{hn::IfThenZeroElse(steep, one), hn::IfThenElseZero(steep, one), zero};
    across = chosen(upright, cross(axis, z), across);
    x = wide_unit(across), y = cross(z, x);
    view = {hn::IfThenZeroElse(upright, dot(across, x)), zero, cosine};
    nothing = hn::Add(hn::Add(less_itself(position, normal), less_itself(towards, towards)), hn::Sub(rough, rough));
  }
  Wide3 local(const Wide3& v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
};

// Directions b(s) = centre + u cos s + v sin s of length 1, of which t = tan(s / 2) is within `reach` of 0. Of a great circle the centre
// is 0.
struct WideArc {
  Wide3 centre, u, v;
  Wide reach;
  WideMask seen;
};
// A part of a great circle between unit vectors.
struct WideSide {
  Wide3 from, to;
  WideMask seen;
};

// Half vectors of an arc's directions in t, bent: x, y, z each c[0] + c[1] t + c[2] t^2.
struct WideSlopes {
  Wide x, y, speed_x, speed_y;
  Wide squared() const { return hn::MulAdd(x, x, hn::Mul(y, y)); }
};
struct WideQuadratic {
  Wide3 c0, c1, c2;
  HWY_INLINE WideSlopes at(Wide t) const {
    const Wide3 h = plus(c0, plus(c1, c2, t), t), speed = plus(c1, c2, hn::Add(t, t));
    const Wide over = hn::Div(wide(1), hn::Max(h.z, wide(1e-12)));
    WideSlopes s;
    s.x = hn::Mul(h.x, over), s.y = hn::Mul(h.y, over);
    s.speed_x = hn::Mul(hn::NegMulAdd(s.x, speed.z, speed.x), over), s.speed_y = hn::Mul(hn::NegMulAdd(s.y, speed.z, speed.y), over);
    return s;
  }
};
// The same of a circle in space, whose b are of any length: h' = v |b| + b.
struct WideRim {
  Wide3 view, b0, b1, b2;
  Wide over_alpha;
  HWY_INLINE WideSlopes at(Wide t) const {
    const Wide3 b = plus(b0, plus(b1, b2, t), t), along = plus(b1, b2, hn::Add(t, t));
    const Wide length = hn::Sqrt(hn::Max(dot(b, b), wide(1e-60))), longer = hn::Div(dot(b, along), length);
    const Wide3 h = plus(b, view, length), speed = plus(along, view, longer);
    const Wide over = hn::Div(wide(1), hn::Max(h.z, hn::Mul(wide(1e-12), length))), bent = hn::Mul(over, over_alpha);
    WideSlopes s;
    s.x = hn::Mul(h.x, bent), s.y = hn::Mul(h.y, bent);
    s.speed_x = hn::NegMulAdd(s.x, hn::Mul(speed.z, over), hn::Mul(speed.x, bent));
    s.speed_y = hn::NegMulAdd(s.y, hn::Mul(speed.z, over), hn::Mul(speed.y, bent));
    return s;
  }
};
HWY_INLINE Wide p_of(const WideSlopes& s) { return hn::Div(wide(1), hn::Add(wide(1), hn::Sqrt(hn::Add(wide(1), s.squared())))); }

enum class ArcKind { great, circle, rim };

// Lays out all sides of a vector of points and gathers what they say together: where the outline is nearest to the middle of the lobe, how
// far its places lie apart, and so on.
class SideLayer {
 public:
  HWY_INLINE SideLayer(const WidePoints& seen_from, SideBlock& to, std::size_t first_point)
      : points_(seen_from),
        over_alpha_(hn::Div(wide(1), seen_from.alpha)),
        block_(to),
        first_(first_point),
        doubtful(none_of()),
        illuminance(wide(0)),
        winding(wide(0)),
        least2_(wide(1e300)),
        least_x_(wide(0)),
        least_y_(wide(0)),
        first_x_(wide(0)),
        first_y_(wide(0)),
        size2_(wide(0)),
        started_(none_of()) {}

  HWY_INLINE void nothing(std::size_t index) {
    for (const auto k : {SideBlock::begin, SideBlock::end}) keep(k, index, wide(0));
  }

  // A part of a great circle.
  HWY_INLINE void lay(std::size_t index, const WideSide& side) {
    if (hn::AllFalse(Doubles(), side.seen)) return nothing(index);
    const Wide zero = wide(0);
    const Wide3 sum = side.from + side.to, step = side.to - side.from;
    const Wide sum2 = dot(sum, sum), step2 = dot(step, step);
    // Half a turn has no middle; of a side that is short beside the digits of its ends little is known.
    doubtful = hn::Or(doubtful, hn::And(side.seen, hn::Or(hn::Lt(sum2, wide(1e-3)), hn::Lt(step2, wide(1e-10)))));
    const Wide over_sum = inverse_root(Doubles(), hn::Max(sum2, wide(1e-6)));
    const Wide over = hn::Div(wide(1), hn::MulAdd(hn::Mul(wide(0.5), sum2), over_sum, wide(1)));
    const WideArc arc{Wide3{zero, zero, zero}, times(sum, over_sum), times(step, inverse_root(Doubles(), hn::Max(step2, wide(1e-20)))),
                      hn::Mul(hn::Mul(wide(0.5), hn::Sqrt(step2)), over), hn::And(side.seen, hn::Gt(step2, wide(1e-20)))};
    const Wide at_crossing = lay<ArcKind::great>(index, arc);
    // How often the outline turns about the middle of the lobe: where it crosses the plane of the view ahead of there.
    const WideMask from = hn::Ge(side.from.y, zero), to = hn::Ge(side.to.y, zero);
    const WideMask ahead = hn::And(arc.seen, hn::Gt(at_crossing, zero));
    winding = hn::Add(winding, hn::IfThenElseZero(hn::And(ahead, hn::AndNot(from, to)), wide(1)));
    winding = hn::Sub(winding, hn::IfThenElseZero(hn::And(ahead, hn::AndNot(to, from)), wide(1)));
  }
  // Of up to a quarter of a turn.
  HWY_INLINE void lay(std::size_t index, const WideArc& arc) {
    if (hn::AllFalse(Doubles(), arc.seen)) return nothing(index);
    lay<ArcKind::circle>(index, arc);
  }
  // Of up to an eighth of a turn, whose b are of any length.
  HWY_INLINE void lay_rim(std::size_t index, const WideArc& arc) {
    if (hn::AllFalse(Doubles(), arc.seen)) return nothing(index);
    lay<ArcKind::rim>(index, arc);
  }

  // What a point has beside its sides. `inside`: the middle of the lobe is within the light.
  HWY_INLINE void finish(const OutlinedLight& light, WideMask lit, WideMask inside);

 private:
  HWY_INLINE void keep(SideBlock::OfSide what, std::size_t index, Wide v) {
    store(v, block_.side[what].data() + index * points_at_once + first_);
  }
  HWY_INLINE WideQuadratic bent(const Wide3& centre, const Wide3& middle, const Wide3& onwards) const {
    const auto one = [&](const Wide3& v) ETENDUE_INLINE_LAMBDA { return Wide3{hn::Mul(v.x, over_alpha_), hn::Mul(v.y, over_alpha_), v.z}; };
    return {one(points_.view + centre + middle), one(onwards + onwards), one(points_.view + centre - middle)};
  }
  // Half vectors of a rim about the place where it is nearest, but for r, which w0 to w4 say.
  HWY_INLINE WideQuadratic bent_rim(std::size_t index, const WideArc& arc, const Wide3& out, const Wide3& along, Wide begin, Wide end) {
    // |b|^2 (1 + tau^2) = n0 + n1 tau + n2 tau^2, and W^2 is that times 1 + tau^2 up to the second degree.
    const Wide two = wide(2), zero = wide(0);
    const Wide near2 = hn::Mul(two, dot(arc.centre, out)), size2 = hn::Add(dot(arc.centre, arc.centre), dot(out, out));
    const Wide n0 = hn::Max(hn::Add(size2, near2), wide(1e-60)), n2 = hn::Sub(size2, near2), n1 = hn::Mul(wide(4), dot(arc.centre, along));
    const Wide w0 = hn::Sqrt(n0), half = hn::Div(wide(0.5), w0), w1 = hn::Mul(n1, half);
    const Wide w2 = hn::Mul(hn::NegMulAdd(w1, w1, hn::Add(n0, n2)), half);
    keep(SideBlock::w0, index, w0), keep(SideBlock::w1, index, w1), keep(SideBlock::w2, index, w2);
    keep(SideBlock::w3, index, hn::NegMulAdd(hn::Mul(two, w1), w2, n1)), keep(SideBlock::w4, index, hn::NegMulAdd(w2, w2, n2));
    // A rim that passes close to the point is not like W.
    for (const Wide tau : {begin, end}) {
      const Wide w = hn::MulAdd(hn::MulAdd(w2, tau, w1), tau, w0), squared = hn::MulAdd(hn::MulAdd(n2, tau, n1), tau, n0);
      const Wide length = hn::Sqrt(hn::Max(hn::Mul(squared, hn::MulAdd(tau, tau, wide(1))), zero));
      doubtful = hn::Or(doubtful, hn::And(arc.seen, hn::Lt(w, hn::Mul(wide(0.25), length))));
    }
    WideQuadratic c = bent(arc.centre, out, along);
    const auto add = [&](Wide3& to, Wide times) {
      to.x = hn::MulAdd(hn::Mul(points_.view.x, over_alpha_), times, to.x), to.z = hn::MulAdd(points_.view.z, times, to.z);
    };
    // bent() has the view once in c0 and in c2.
    add(c.c0, hn::Sub(w0, wide(1))), add(c.c1, w1), add(c.c2, hn::Sub(w2, wide(1)));
    return c;
  }
  // The slope along x where the arc crosses the plane of the view.
  template <ArcKind Kind>
  HWY_INLINE Wide lay(std::size_t index, const WideArc& arc);

  const WidePoints& points_;
  Wide over_alpha_;
  SideBlock& block_;
  std::size_t first_;

 public:
  WideMask doubtful;
  Wide illuminance, winding;

 private:
  Wide least2_, least_x_, least_y_, first_x_, first_y_, size2_;
  WideMask started_;
};

template <ArcKind Kind>
HWY_INLINE Wide SideLayer::lay(std::size_t index, const WideArc& arc) {
  const Doubles d;
  const Wide zero = wide(0), one = wide(1), u = arc.reach, tiny = wide(1e-60);
  const Wide3& view = points_.view;
  constexpr bool Great = Kind == ArcKind::great, Rim = Kind == ArcKind::rim;
  const auto curve = [&] {
    if constexpr (Rim) return WideRim{view, arc.centre + arc.u, arc.v + arc.v, arc.centre - arc.u, over_alpha_};
    if constexpr (!Rim) return bent(arc.centre, arc.u, arc.v);
  }();
  // Nearest: of the middle, the ends, where it crosses the plane of the view, and where it is closest to the mirror direction (of a great
  // circle that is near enough to one of these); then steps of Gauss and Newton.
  Wide best = zero;
  WideSlopes at = curve.at(zero);
  Wide near2 = at.squared();
  const auto try_at = [&](Wide t) ETENDUE_INLINE_LAMBDA {
    const WideSlopes other = curve.at(t);
    const Wide other2 = other.squared();
    const WideMask nearer = hn::Lt(other2, near2);
    best = hn::IfThenElse(nearer, t, best), near2 = hn::IfThenElse(nearer, other2, near2);
    at.x = hn::IfThenElse(nearer, other.x, at.x), at.y = hn::IfThenElse(nearer, other.y, at.y);
    at.speed_x = hn::IfThenElse(nearer, other.speed_x, at.speed_x), at.speed_y = hn::IfThenElse(nearer, other.speed_y, at.speed_y);
    return other;
  };
  const auto on_arc = [&](Wide t) ETENDUE_INLINE_LAMBDA { return hn::Min(hn::Max(t, hn::Neg(u)), u); };
  const WideSlopes middle = at, start = try_at(hn::Neg(u)), finish = try_at(u);
  // (centre.y + u.y) + 2 v.y t + (centre.y - u.y) t^2 = 0
  const Wide low = hn::Add(arc.centre.y, arc.u.y), high = hn::Sub(arc.centre.y, arc.u.y);
  const Wide root = hn::Sqrt(hn::Add(hn::Max(hn::NegMulAdd(low, high, hn::Mul(arc.v.y, arc.v.y)), zero), tiny));
  const Wide larger = hn::Neg(hn::Add(arc.v.y, hn::CopySign(root, arc.v.y)));
  const Wide ahead = try_at(on_arc(hn::Div(low, larger))).x;
  if constexpr (!Great) {
    try_at(on_arc(hn::Div(larger, high)));
    const auto to_mirror = [&](const Wide3& b) ETENDUE_INLINE_LAMBDA { return hn::MulSub(b.z, view.z, hn::Mul(b.x, view.x)); };
    const Wide a = to_mirror(arc.u), b = to_mirror(arc.v), r = hn::Sqrt(hn::MulAdd(a, a, hn::MulAdd(b, b, tiny)));
    try_at(on_arc(hn::Div(b, hn::Max(hn::Add(r, a), tiny))));
  }
  for (int turn = 0; turn < 3; ++turn) {
    const Wide speed2 = hn::MulAdd(at.speed_x, at.speed_x, hn::Mul(at.speed_y, at.speed_y));
    const Wide shift = hn::Div(hn::MulAdd(at.x, at.speed_x, hn::Mul(at.y, at.speed_y)), hn::Max(speed2, tiny));
    try_at(on_arc(hn::Sub(best, shift)));
  }
  // The same arc about there.
  const Wide per = hn::Div(one, hn::MulAdd(best, best, one));
  const Wide cs = hn::Mul(hn::NegMulAdd(best, best, one), per), sn = hn::Mul(hn::Add(best, best), per);
  const Wide3 out = plus(times(arc.u, cs), arc.v, sn), along = plus(times(arc.v, cs), arc.u, hn::Neg(sn));
  const auto tau_at = [&](Wide t) ETENDUE_INLINE_LAMBDA { return hn::Div(hn::Sub(t, best), hn::MulAdd(t, best, one)); };
  WideQuadratic c;
  if constexpr (Rim) {
    c = bent_rim(index, arc, out, along, tau_at(hn::Neg(u)), tau_at(u));
  } else {
    c = bent(arc.centre, out, along);
  }
  const WideSlopes here = c.at(zero);
  const Wide q2 = here.squared(), speed2 = hn::MulAdd(here.speed_x, here.speed_x, hn::Mul(here.speed_y, here.speed_y));
  const Wide kappa = hn::Min(hn::Sqrt(hn::Div(hn::Mul(wide(4), hn::Add(one, q2)), hn::Max(speed2, tiny))), wide(1e3));
  const Wide turn0 = hn::MulSub(c.c0.x, c.c1.y, hn::Mul(c.c1.x, c.c0.y));
  const Wide turn1 = hn::MulSub(c.c0.x, c.c2.y, hn::Mul(c.c2.x, c.c0.y));
  const Wide turn2 = hn::MulSub(c.c1.x, c.c2.y, hn::Mul(c.c2.x, c.c1.y));
  keep(SideBlock::x0, index, c.c0.x), keep(SideBlock::x1, index, c.c1.x), keep(SideBlock::x2, index, c.c2.x);
  keep(SideBlock::y0, index, c.c0.y), keep(SideBlock::y1, index, c.c1.y), keep(SideBlock::y2, index, c.c2.y);
  keep(SideBlock::z0, index, c.c0.z), keep(SideBlock::z1, index, c.c1.z), keep(SideBlock::z2, index, c.c2.z);
  keep(SideBlock::turn0, index, turn0), keep(SideBlock::turn1, index, hn::Add(turn1, turn1)), keep(SideBlock::turn2, index, turn2);
  keep(SideBlock::kappa, index, kappa);
  keep(SideBlock::begin, index, hn::IfThenElseZero(arc.seen, tau_at(hn::Neg(u))));
  keep(SideBlock::end, index, hn::IfThenElseZero(arc.seen, tau_at(u)));
  // Of all sides.
  const WideMask nearest = hn::And(arc.seen, hn::Lt(q2, least2_));
  least2_ = hn::IfThenElse(nearest, q2, least2_);
  least_x_ = hn::IfThenElse(nearest, here.x, least_x_), least_y_ = hn::IfThenElse(nearest, here.y, least_y_);
  const Wide start_p = p_of(start);
  const WideMask begins = hn::AndNot(started_, arc.seen);
  first_x_ = hn::IfThenElse(begins, hn::Mul(start.x, start_p), first_x_);
  first_y_ = hn::IfThenElse(begins, hn::Mul(start.y, start_p), first_y_);
  started_ = hn::Or(started_, arc.seen);
  const auto reach = [&](const WideSlopes& s) ETENDUE_INLINE_LAMBDA {
    const Wide k = p_of(s), dx = hn::MulSub(s.x, k, first_x_), dy = hn::MulSub(s.y, k, first_y_);
    size2_ = hn::Max(size2_, hn::IfThenElseZero(arc.seen, hn::MulAdd(dx, dx, hn::Mul(dy, dy))));
  };
  reach(start), reach(here), reach(finish);
  const auto from_rim = [&](const WideSlopes& s) ETENDUE_INLINE_LAMBDA { return hn::NegMulAdd(hn::Sqrt(s.squared()), p_of(s), one); };
  // n.l at the ends, and at the lowest place of a circle where that is between them.
  const Wide over = hn::Div(one, hn::MulAdd(u, u, one)), sine = hn::Mul(hn::Add(u, u), over),
             cosine = hn::Mul(hn::NegMulAdd(u, u, one), over);
  const auto height = [&](const Wide3& b) ETENDUE_INLINE_LAMBDA { return Rim ? hn::Div(b.z, hn::Sqrt(hn::Max(dot(b, b), tiny))) : b.z; };
  const Wide3 mean = plus(arc.centre, arc.u, cosine);
  Wide lowest = hn::Min(height(plus(mean, arc.v, sine)), height(plus(mean, arc.v, hn::Neg(sine))));
  Wide rim = hn::Min(from_rim(start), from_rim(finish));
  if constexpr (!Great) {
    const Wide rise = hn::Sqrt(hn::MulAdd(arc.u.z, arc.u.z, hn::MulAdd(arc.v.z, arc.v.z, tiny))), down = hn::Div(wide(-1), rise);
    const Wide3 bottom = plus(plus(arc.centre, arc.u, hn::Mul(arc.u.z, down)), arc.v, hn::Mul(arc.v.z, down));
    lowest = hn::IfThenElse(hn::Ge(hn::Neg(arc.u.z), hn::Mul(rise, cosine)), hn::Min(lowest, height(bottom)), lowest);
    rim = hn::Min(rim, from_rim(middle));
  }
  keep(SideBlock::lowest, index, lowest), keep(SideBlock::rim, index, rim);
  // Half the integral of b x db, where b is of length 1: b x b' = centre x (v cos s - u sin s) + u x v.
  const auto vertical = [](const Wide3& a, const Wide3& b) ETENDUE_INLINE_LAMBDA { return hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x)); };
  if constexpr (!Rim) {
    Wide part = hn::Mul(hn::Mul(wide(2), arc_tangent(d, u)), vertical(arc.u, arc.v));
    if constexpr (!Great) part = hn::MulAdd(sine, vertical(arc.centre, arc.v), part);
    illuminance = hn::Add(illuminance, hn::IfThenElseZero(arc.seen, part));
  }
  return ahead;
}

HWY_INLINE void SideLayer::finish(const OutlinedLight& light, WideMask lit, WideMask inside) {
  const Wide zero = wide(0), one = wide(1);
  const Wide3& view = points_.view;
  const Wide alpha = points_.alpha, cosine = points_.cosine;
  const Wide root = hn::Sqrt(hn::Add(one, least2_)), nearest = hn::Sqrt(least2_), least = hn::Div(nearest, hn::Add(one, root));
  const WideMask apart = hn::AndNot(inside, hn::Or(hn::Gt(hn::Mul(least, least), hn::Mul(wide(0.0625), size2_)), hn::Gt(least, wide(0.4))));
  // 1 - p there, with all its digits.
  const Wide rest = hn::Div(hn::Add(one, hn::Div(one, hn::Add(root, nearest))), hn::Add(one, root));
  // W at the middle, or at the nearest place.
  const Wide mx = hn::IfThenElseZero(apart, hn::Mul(alpha, least_x_)), my = hn::IfThenElseZero(apart, hn::Mul(alpha, least_y_));
  const Wide m2 = hn::MulAdd(mx, mx, hn::Mul(my, my)), vm = hn::Mul(view.x, mx), per_m = hn::Div(one, hn::Add(one, m2));
  const Wide nl = hn::Max(hn::Mul(hn::MulAdd(wide(2), vm, hn::NegMulAdd(cosine, m2, cosine)), per_m), zero);
  const Wide alpha2 = hn::Mul(alpha, alpha);
  const auto masked_root = [&](Wide c) ETENDUE_INLINE_LAMBDA { return hn::Sqrt(hn::MulAdd(hn::Mul(c, c), hn::Sub(one, alpha2), alpha2)); };
  // Correlated: n.l S(n.v) + n.v S(n.l); separable: half of (n.v + S(n.v)) (n.l + S(n.l)).
  const Wide view_root = masked_root(cosine), c = hn::Max(hn::Add(vm, cosine), zero), seen = hn::Max(cosine, wide(1e-9));
  const Wide both = hn::Mul(wide(0.5), hn::Add(seen, view_root));
  const Wide of_height = light.separable ? both : view_root, of_root = light.separable ? both : seen;
  const Wide shape = hn::Div(hn::Mul(hn::Mul(wide(2), nl), c), hn::MulAdd(nl, of_height, hn::Mul(of_root, masked_root(nl))));
  const Wide away = hn::Max(hn::NegMulAdd(c, hn::Sqrt(per_m), one), zero), away2 = hn::Mul(away, away);
  const auto keep = [&](SideBlock::OfPoint what, Wide value) ETENDUE_INLINE_LAMBDA { store(value, block_.point[what].data() + first_); };
  keep(SideBlock::alpha, alpha), keep(SideBlock::view_x, view.x), keep(SideBlock::view_z, cosine), keep(SideBlock::of_height, of_height),
      keep(SideBlock::of_root, of_root);
  keep(SideBlock::base, hn::IfThenElseZero(apart, least)), keep(SideBlock::rest, hn::IfThenElse(apart, rest, one));
  keep(SideBlock::level, shape), keep(SideBlock::level_risen, hn::Mul(shape, hn::Mul(hn::Mul(away2, away2), away)));
  const WideMask any = hn::And(hn::And(lit, hn::Gt(cosine, zero)), hn::Gt(illuminance, zero));
  keep(SideBlock::floor, hn::IfThenElseZero(any, hn::Max(hn::Mul(wide(1e-3), illuminance), wide(light.least))));
  keep(SideBlock::doubt, hn::IfThenElseZero(hn::Or(doubtful, hn::Not(hn::Eq(points_.nothing, zero))), one));
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
