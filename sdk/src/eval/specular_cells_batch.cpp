// Sides and cells of specular_cells.h in vectors: a point a lane of doubles for the first, a cell a lane of floats for the second.
#include "specular_cells.h"

#include "gauss_rule.h"
#include "light_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/specular_cells_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <algorithm>
#include <utility>

#include "eval/light_batch-inl.h"

#ifndef ETENDUE_SPECULAR_CELLS_BATCH_SHARED
#define ETENDUE_SPECULAR_CELLS_BATCH_SHARED
namespace etendue::eval {

template <std::size_t N>
struct GaussFloats {
  std::array<float, N> x, weight;
  std::array<std::array<float, told>, N> high;
  GaussFloats() {
    for (std::size_t i = 0; i < N; ++i) {
      x[i] = static_cast<float>(gauss<N>().x[i]), weight[i] = static_cast<float>(gauss<N>().weight[i]);
      for (std::size_t k = 0; k < told; ++k) high[i][k] = static_cast<float>(gauss<N>().high[i][k]);
    }
  }
};
template <std::size_t N>
inline const GaussFloats<N>& gauss_floats() {
  static const GaussFloats<N> rule;
  return rule;
}

}  // namespace etendue::eval
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

// ---- Sides ----

using Doubles = hn::ScalableTag<double>;
using Wide = hn::Vec<Doubles>;
using WideMask = hn::Mask<Doubles>;
using Wide3 = Vector<Wide>;

HWY_INLINE Wide wide(double x) { return hn::Set(Doubles(), x); }
HWY_INLINE Wide3 times(const Wide3& v, Wide s) { return {hn::Mul(v.x, s), hn::Mul(v.y, s), hn::Mul(v.z, s)}; }
HWY_INLINE Wide3 wide_unit(const Wide3& v) { return times(v, inverse_root(Doubles(), hn::Max(dot(v, v), wide(1e-300)))); }
HWY_INLINE Wide3 plus(const Wide3& a, const Wide3& b, Wide s) {
  return {hn::MulAdd(b.x, s, a.x), hn::MulAdd(b.y, s, a.y), hn::MulAdd(b.z, s, a.z)};
}

struct WideSide {
  Wide3 from, to;
  WideMask seen;
};
// What has z >= 0 of four sides head to tail, and the side on z = 0 that closes it.
HWY_INLINE std::array<WideSide, 5> wide_clipped(const std::array<Wide3, 4>& corners) {
  const Doubles d;
  const Wide zero = wide(0);
  std::array<WideSide, 5> c;
  Wide3 high = corners[0], low = corners[1], deep = corners[0], raised = corners[1];
  WideMask cut = hn::FirstN(d, 0);
  std::array<WideMask, 4> goes, rises;
  each<4>([&](auto i) ETENDUE_INLINE_LAMBDA {
    const Wide3 &a = corners[i], &b = corners[(i + 1) % 4];
    const WideMask from = hn::Ge(a.z, zero), to = hn::Ge(b.z, zero);
    goes[i] = hn::AndNot(to, from), rises[i] = hn::AndNot(from, to);
    high = chosen(goes[i], a, high), low = chosen(goes[i], b, low);
    deep = chosen(rises[i], a, deep), raised = chosen(rises[i], b, raised);
    c[i].seen = hn::Or(from, to);
    cut = hn::Or(cut, goes[i]);
  });
  const auto crossing = [&](const Wide3& a, const Wide3& b) ETENDUE_INLINE_LAMBDA {
    const Wide x = hn::NegMulAdd(a.x, b.z, hn::Mul(b.x, a.z)), y = hn::NegMulAdd(a.y, b.z, hn::Mul(b.y, a.z));
    const Wide inverse = inverse_root(d, hn::Max(hn::MulAdd(x, x, hn::Mul(y, y)), wide(1e-60)));
    return Wide3{hn::Mul(x, inverse), hn::Mul(y, inverse), zero};
  };
  const Wide3 gone = crossing(high, low), risen = crossing(raised, deep);
  each<4>([&](auto i) ETENDUE_INLINE_LAMBDA {
    c[i].from = chosen(rises[i], risen, corners[i]);
    c[i].to = chosen(goes[i], gone, corners[(i + 1) % 4]);
  });
  c[4] = {gone, risen, cut};
  return c;
}

// Of x >= 0 (Abramowitz and Stegun 4.4.49, within 2e-8).
template <class D, class V = hn::Vec<D>>
HWY_INLINE V arc_tangent(D d, V x) {
  const V one = number(d, 1);
  const auto beyond = hn::Gt(x, one);
  const V y = hn::IfThenElse(beyond, hn::Div(one, x), x);
  const V p = hn::Mul(y, polynomial(d, hn::Mul(y, y),
                                    std::array{1.0, -0.3333314528, 0.1999355085, -0.1420889944, 0.1065626393, -0.0752896400, 0.0429096138,
                                               -0.0161657367, 0.0028662257}));
  return hn::IfThenElse(beyond, hn::Sub(number(d, 0.5 * pi), p), p);
}

// Half vectors of a side's directions in t about its middle, bent: x, y, z each c[0] + c[1] t + c[2] t^2.
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
HWY_INLINE WideQuadratic wide_bent(const Wide3& view, const Wide3& middle, const Wide3& onwards, Wide over_alpha) {
  const auto bent = [&](const Wide3& v) ETENDUE_INLINE_LAMBDA { return Wide3{hn::Mul(v.x, over_alpha), hn::Mul(v.y, over_alpha), v.z}; };
  return {bent(view + middle), bent(onwards + onwards), bent(view - middle)};
}

// What a block has of all its sides: where the outline is nearest to the middle of the lobe, how far its places lie apart, and so on.
struct Gathered {
  Wide least2, least_x, least_y, first_x, first_y, size2, illuminance;
  WideMask inside, doubtful;
};

HWY_INLINE void store(const Wide& v, float* to) {
  const hn::Rebind<float, Doubles> floats;
  hn::StoreU(hn::DemoteTo(floats, v), floats, to);
}

template <std::size_t Index>
HWY_INLINE void lay_side(const WideSide& side, const Wide3& view, Wide over_alpha, Gathered& all, SideBlock& block, std::size_t first) {
  const Doubles d;
  const Wide zero = wide(0), one = wide(1), half = wide(0.5);
  const Wide3 sum = side.from + side.to, step = side.to - side.from;
  const Wide sum2 = dot(sum, sum), step2 = dot(step, step);
  const WideMask seen = hn::And(side.seen, hn::Gt(step2, wide(1e-20)));
  // Half a turn has no middle; of a side that is short beside the digits of its ends little is known.
  all.doubtful = hn::Or(all.doubtful, hn::And(side.seen, hn::Or(hn::Lt(sum2, wide(1e-3)), hn::Lt(step2, wide(1e-10)))));
  const Wide over_sum = inverse_root(d, hn::Max(sum2, wide(1e-6)));
  const Wide3 middle = times(sum, over_sum), onwards = times(step, inverse_root(d, hn::Max(step2, wide(1e-20))));
  const Wide over = hn::Div(one, hn::MulAdd(hn::Mul(half, sum2), over_sum, one));
  const Wide u = hn::Mul(hn::Mul(half, hn::Sqrt(step2)), over);
  const WideQuadratic curve = wide_bent(view, middle, onwards, over_alpha);
  // Nearest: of the middle, the ends, and where it crosses the plane of the view; then steps of Gauss and Newton.
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
  const WideSlopes start = try_at(hn::Neg(u));
  const WideSlopes finish = try_at(u);
  const Wide root = hn::Sqrt(hn::MulAdd(onwards.y, onwards.y, hn::MulAdd(middle.y, middle.y, wide(1e-60))));
  const Wide crossing = hn::Div(hn::Neg(middle.y), hn::Add(onwards.y, hn::CopySign(root, onwards.y)));
  try_at(hn::Min(hn::Max(crossing, hn::Neg(u)), u));
  for (int turn = 0; turn < 3; ++turn) {
    const Wide speed2 = hn::MulAdd(at.speed_x, at.speed_x, hn::Mul(at.speed_y, at.speed_y));
    const Wide shift = hn::Div(hn::MulAdd(at.x, at.speed_x, hn::Mul(at.y, at.speed_y)), hn::Max(speed2, wide(1e-60)));
    try_at(hn::Min(hn::Max(hn::Sub(best, shift), hn::Neg(u)), u));
  }
  // The same arc about there.
  const Wide per = hn::Div(one, hn::MulAdd(best, best, one));
  const Wide cs = hn::Mul(hn::NegMulAdd(best, best, one), per), sn = hn::Mul(hn::Add(best, best), per);
  const Wide3 out = plus(times(middle, cs), onwards, sn), along = plus(times(onwards, cs), middle, hn::Neg(sn));
  const WideQuadratic c = wide_bent(view, out, along, over_alpha);
  const auto tau_at = [&](Wide t) ETENDUE_INLINE_LAMBDA { return hn::Div(hn::Sub(t, best), hn::MulAdd(t, best, one)); };
  const WideSlopes here = c.at(zero);
  const Wide q2 = here.squared(), speed2 = hn::MulAdd(here.speed_x, here.speed_x, hn::Mul(here.speed_y, here.speed_y));
  const Wide kappa = hn::Min(hn::Sqrt(hn::Div(hn::Mul(wide(4), hn::Add(one, q2)), hn::Max(speed2, wide(1e-60)))), wide(1e3));
  const auto x_of = [&](Wide tau) ETENDUE_INLINE_LAMBDA {
    return hn::Div(hn::Add(tau, tau), hn::Add(kappa, hn::Sqrt(hn::MulAdd(kappa, kappa, hn::Mul(wide(4), hn::Mul(tau, tau))))));
  };
  const Wide turn0 = hn::MulSub(c.c0.x, c.c1.y, hn::Mul(c.c1.x, c.c0.y));
  const Wide turn1 = hn::MulSub(c.c0.x, c.c2.y, hn::Mul(c.c2.x, c.c0.y));
  const Wide turn2 = hn::MulSub(c.c1.x, c.c2.y, hn::Mul(c.c2.x, c.c1.y));
  const auto keep = [&](SideBlock::OfSide what, Wide v)
                        ETENDUE_INLINE_LAMBDA { store(v, block.side[what].data() + Index * points_at_once + first); };
  keep(SideBlock::x0, c.c0.x), keep(SideBlock::x1, c.c1.x), keep(SideBlock::x2, c.c2.x);
  keep(SideBlock::y0, c.c0.y), keep(SideBlock::y1, c.c1.y), keep(SideBlock::y2, c.c2.y);
  keep(SideBlock::z0, c.c0.z), keep(SideBlock::z1, c.c1.z), keep(SideBlock::z2, c.c2.z);
  keep(SideBlock::turn0, turn0), keep(SideBlock::turn1, hn::Add(turn1, turn1)), keep(SideBlock::turn2, turn2);
  keep(SideBlock::kappa, kappa);
  keep(SideBlock::begin, hn::IfThenElseZero(seen, x_of(tau_at(hn::Neg(u)))));
  keep(SideBlock::end, hn::IfThenElseZero(seen, x_of(tau_at(u))));
  // Of all sides.
  const WideMask nearest = hn::And(seen, hn::Lt(q2, all.least2));
  all.least2 = hn::IfThenElse(nearest, q2, all.least2);
  all.least_x = hn::IfThenElse(nearest, here.x, all.least_x), all.least_y = hn::IfThenElse(nearest, here.y, all.least_y);
  const auto p_of = [&](const WideSlopes& s)
                        ETENDUE_INLINE_LAMBDA { return hn::Div(one, hn::Add(one, hn::Sqrt(hn::Add(one, s.squared())))); };
  if constexpr (Index == 0) {
    const Wide k = p_of(start);
    all.first_x = hn::Mul(start.x, k), all.first_y = hn::Mul(start.y, k);
  }
  const auto reach = [&](const WideSlopes& s) ETENDUE_INLINE_LAMBDA {
    const Wide k = p_of(s), dx = hn::MulSub(s.x, k, all.first_x), dy = hn::MulSub(s.y, k, all.first_y);
    all.size2 = hn::Max(all.size2, hn::IfThenElseZero(seen, hn::MulAdd(dx, dx, hn::Mul(dy, dy))));
  };
  reach(start), reach(here);
  const auto from_rim = [&](const WideSlopes& s) ETENDUE_INLINE_LAMBDA { return hn::NegMulAdd(hn::Sqrt(s.squared()), p_of(s), one); };
  keep(SideBlock::lowest, hn::Min(side.from.z, side.to.z)), keep(SideBlock::rim, hn::Min(from_rim(start), from_rim(finish)));
  if constexpr (Index < 4) reach(finish);
  const Wide3 axis = cross(middle, onwards);
  all.illuminance = hn::Add(all.illuminance, hn::IfThenElseZero(seen, hn::Mul(hn::Mul(wide(2), arc_tangent(d, u)), axis.z)));
  const Wide towards_mirror = hn::MulSub(axis.z, view.z, hn::Mul(axis.x, view.x));
  all.inside = hn::And(all.inside, hn::Or(hn::Not(seen), hn::Gt(towards_mirror, zero)));
}

void LaySides(const RectWithin& light, const PlaceBlock& places, std::size_t count, SideBlock& block) {
  const Doubles d;
  const std::size_t lanes = hn::Lanes(d);
  const Wide zero = wide(0), one = wide(1);
  for (std::size_t i = 0; i < count; i += lanes) {
    const auto load = [&](std::size_t k) ETENDUE_INLINE_LAMBDA { return hn::LoadU(d, places.numbers[k].data() + i); };
    const Wide3 position{load(0), load(1), load(2)}, normal{load(3), load(4), load(5)}, towards{load(6), load(7), load(8)};
    const Wide3 z = wide_unit(normal), v = wide_unit(towards);
    const Wide rough = load(9), alpha = hn::Min(hn::Max(rough, wide(1e-4)), one), over_alpha = hn::Div(one, alpha);
    const Wide cosine = dot(z, v);
    Wide3 across = plus(v, z, hn::Neg(cosine));
    const WideMask upright = hn::Lt(dot(across, across), wide(1e-20));
    const WideMask steep = hn::Gt(hn::Abs(z.x), wide(0.7));
    const Wide3 axis{hn::IfThenZeroElse(steep, one), hn::IfThenElseZero(steep, one), zero};
    across = chosen(upright, cross(axis, z), across);
    const Wide3 x = wide_unit(across), y = cross(z, x);
    const Wide3 view{hn::IfThenZeroElse(upright, dot(across, x)), zero, cosine};
    std::array<Wide3, 4> corners;
    Wide height = zero;
    each<4>([&](auto c) ETENDUE_INLINE_LAMBDA {
      const Wide3 to = numbers(d, light.corners[c]) - position;
      if (c == 0) height = dot(to, numbers(d, light.normal));
      corners[c] = wide_unit(Wide3{dot(x, to), dot(y, to), dot(z, to)});
    });
    const WideMask front = hn::Lt(height, zero), back = hn::Gt(height, zero);
    if (light.two_sided) {
      const Wide3 second = corners[1];
      corners[1] = chosen(back, corners[3], second), corners[3] = chosen(back, second, corners[3]);
    }
    const WideMask lit = hn::And(hn::Gt(cosine, zero), light.two_sided ? hn::Or(front, back) : front);
    const std::array<WideSide, 5> sides = wide_clipped(corners);
    Gathered all{wide(1e300), zero, zero, zero, zero, zero, zero, hn::FirstN(d, lanes), hn::FirstN(d, 0)};
    each<5>([&](auto side) ETENDUE_INLINE_LAMBDA { lay_side<side>(sides[side], view, over_alpha, all, block, i); });
    const Wide root = hn::Sqrt(hn::Add(one, all.least2)), least = hn::Div(hn::Sqrt(all.least2), hn::Add(one, root));
    const WideMask apart =
        hn::AndNot(all.inside, hn::Or(hn::Gt(hn::Mul(least, least), hn::Mul(wide(0.0625), all.size2)), hn::Gt(least, wide(0.4))));
    // 1 - p there, with all its digits.
    const Wide rest = hn::Div(hn::Add(one, hn::Div(one, hn::Add(root, hn::Sqrt(all.least2)))), hn::Add(one, root));
    // W at the middle, or at the nearest place.
    const Wide mx = hn::IfThenElseZero(apart, hn::Mul(alpha, all.least_x)), my = hn::IfThenElseZero(apart, hn::Mul(alpha, all.least_y));
    const Wide m2 = hn::MulAdd(mx, mx, hn::Mul(my, my)), vm = hn::Mul(view.x, mx), per_m = hn::Div(one, hn::Add(one, m2));
    const Wide nl = hn::Max(hn::Mul(hn::MulAdd(wide(2), vm, hn::NegMulAdd(cosine, m2, cosine)), per_m), zero);
    const Wide alpha2 = hn::Mul(alpha, alpha);
    const auto masked_root = [&](Wide c)
                                 ETENDUE_INLINE_LAMBDA { return hn::Sqrt(hn::MulAdd(hn::Mul(c, c), hn::Sub(one, alpha2), alpha2)); };
    // Correlated: n.l S(n.v) + n.v S(n.l); separable: half of (n.v + S(n.v)) (n.l + S(n.l)).
    const Wide view_root = masked_root(cosine), c = hn::Max(hn::Add(vm, cosine), zero), seen = hn::Max(cosine, wide(1e-9));
    const Wide both = hn::Mul(wide(0.5), hn::Add(seen, view_root));
    const Wide of_height = light.separable ? both : view_root, of_root = light.separable ? both : seen;
    const Wide shape = hn::Div(hn::Mul(hn::Mul(wide(2), nl), c), hn::MulAdd(nl, of_height, hn::Mul(of_root, masked_root(nl))));
    const Wide away = hn::Max(hn::NegMulAdd(c, hn::Sqrt(per_m), one), zero), away2 = hn::Mul(away, away);
    const auto keep = [&](SideBlock::OfPoint what, Wide value) ETENDUE_INLINE_LAMBDA { store(value, block.point[what].data() + i); };
    keep(SideBlock::alpha, alpha), keep(SideBlock::view_x, view.x), keep(SideBlock::view_z, cosine), keep(SideBlock::of_height, of_height),
        keep(SideBlock::of_root, of_root);
    keep(SideBlock::base, hn::IfThenElseZero(apart, least)), keep(SideBlock::rest, hn::IfThenElse(apart, rest, one));
    keep(SideBlock::level, shape), keep(SideBlock::level_risen, hn::Mul(shape, hn::Mul(hn::Mul(away2, away2), away)));
    const WideMask any = hn::And(lit, hn::Gt(all.illuminance, zero));
    keep(SideBlock::floor, hn::IfThenElseZero(any, hn::Max(hn::Mul(wide(1e-3), all.illuminance), wide(light.least))));
    const Wide nothing = hn::Add(hn::Add(less_itself(position, normal), less_itself(towards, towards)), hn::Sub(rough, rough));
    keep(SideBlock::doubt, hn::IfThenElseZero(hn::Or(all.doubtful, hn::Not(hn::Eq(nothing, zero))), one));
  }
}

// ---- Cells ----

using CellFloats = hn::CappedTag<float, 16>;
using Cell = hn::Vec<CellFloats>;
using CellMask = hn::Mask<CellFloats>;
HWY_INLINE Cell cell_number(float x) { return hn::Set(CellFloats(), x); }

// From the four highest coefficients, in the order of gauss_rule.h, to what the rule errs by. Where they fall like rho^-k it errs by what
// they are at 2 N: rho^-2 is the larger of the highest two over the larger of the two before, and four times two degrees further on than
// the highest they are less by its fourth power, which is no less than they are at 2 N = 10 to 16 for rules of 5 to 8 nodes.
HWY_INLINE Cell left_over(const std::array<Cell, told>& sums) {
  const CellFloats d;
  const Cell high = hn::Max(hn::Abs(sums[0]), hn::Abs(sums[1])), low = hn::Max(hn::Abs(sums[2]), hn::Abs(sums[3]));
  const Cell r = hn::Min(hn::Mul(high, inverse(d, hn::Max(low, cell_number(1e-30f)))), cell_number(1)), r2 = hn::Mul(r, r);
  return hn::Mul(high, hn::Mul(r2, r2));
}

template <std::size_t NX, std::size_t NT>
HWY_NOINLINE void measure(const SideBlock& block, CellList& cells, std::size_t first) {
  const CellFloats d;
  const hn::RebindToSigned<CellFloats> di;
  const GaussFloats<NX>& gx = gauss_floats<NX>();
  const GaussFloats<NT>& gt = gauss_floats<NT>();
  const Cell zero = cell_number(0), one = cell_number(1), two = cell_number(2);
  const auto at_point = hn::LoadU(di, cells.point.data() + first), at_side = hn::LoadU(di, cells.side.data() + first);
  const auto of_point = [&](SideBlock::OfPoint k) ETENDUE_INLINE_LAMBDA { return hn::GatherIndex(d, block.point[k].data(), at_point); };
  const auto of_side = [&](SideBlock::OfSide k) ETENDUE_INLINE_LAMBDA { return hn::GatherIndex(d, block.side[k].data(), at_side); };
  const Cell hx0 = of_side(SideBlock::x0), hx1 = of_side(SideBlock::x1), hx2 = of_side(SideBlock::x2);
  const Cell hy0 = of_side(SideBlock::y0), hy1 = of_side(SideBlock::y1), hy2 = of_side(SideBlock::y2);
  const Cell hz0 = of_side(SideBlock::z0), hz1 = of_side(SideBlock::z1), hz2 = of_side(SideBlock::z2);
  const Cell turn0 = of_side(SideBlock::turn0), turn1 = of_side(SideBlock::turn1), turn2 = of_side(SideBlock::turn2);
  const Cell kappa = of_side(SideBlock::kappa);
  const Cell alpha = of_point(SideBlock::alpha), vx = of_point(SideBlock::view_x), vz = of_point(SideBlock::view_z);
  const Cell of_height = of_point(SideBlock::of_height), of_root = of_point(SideBlock::of_root), base = of_point(SideBlock::base),
             rest = of_point(SideBlock::rest);
  const Cell level = of_point(SideBlock::level), level_risen = of_point(SideBlock::level_risen);
  const Cell x0 = hn::LoadU(d, cells.x0.data() + first), x1 = hn::LoadU(d, cells.x1.data() + first);
  const Cell t0 = hn::LoadU(d, cells.t0.data() + first), t1 = hn::LoadU(d, cells.t1.data() + first);
  const Cell x_span = hn::Sub(x1, x0), t_span = hn::Sub(t1, t0);
  const Cell alpha2 = hn::Mul(alpha, alpha), less_alpha2 = hn::Sub(one, alpha2), twice_alpha = hn::Add(alpha, alpha);

  struct Place {
    Cell x, y, turn;
  };
  const auto place = [&](Cell x, Cell inner) ETENDUE_INLINE_LAMBDA {
    const Cell tau = hn::Mul(hn::Mul(kappa, x), inner);
    const Cell over = inverse(d, hn::MulAdd(hn::MulAdd(hz2, tau, hz1), tau, hz0));
    return Place{hn::Mul(hn::MulAdd(hn::MulAdd(hx2, tau, hx1), tau, hx0), over),
                 hn::Mul(hn::MulAdd(hn::MulAdd(hy2, tau, hy1), tau, hy0), over),
                 hn::Mul(hn::Mul(hn::MulAdd(hn::MulAdd(turn2, tau, turn1), tau, turn0), over), over)};
  };
  const auto inner_at = [&](Cell x) ETENDUE_INLINE_LAMBDA { return inverse(d, hn::Mul(hn::Sub(one, x), hn::Add(one, x))); };
  // p is taken from the rim, u = 1 - p, where it has more digits: lights far out are thin there.
  const auto outside = [&](Cell u) ETENDUE_INLINE_LAMBDA {
    const Cell p = hn::Sub(one, u), ratio = hn::Mul(hn::Mul(u, hn::Sub(two, u)), inverse(d, hn::MulAdd(p, p, one)));
    return hn::Mul(ratio, ratio);
  };
  const auto u_at = [&](Cell t, Cell u1) ETENDUE_INLINE_LAMBDA { return hn::MulAdd(t, hn::Sub(u1, rest), rest); };
  const auto u_of = [&](Cell q_length, Cell root) ETENDUE_INLINE_LAMBDA {
    return hn::Mul(hn::Add(one, inverse(d, hn::Add(root, q_length))), inverse(d, hn::Add(one, root)));
  };

  const Place from = place(x0, inner_at(x0)), to = place(x1, inner_at(x1));
  const Cell from2 = hn::MulAdd(from.x, from.x, hn::Mul(from.y, from.y)), to2 = hn::MulAdd(to.x, to.x, hn::Mul(to.y, to.y));
  const Cell crossed = hn::MulSub(from.x, to.y, hn::Mul(from.y, to.x)), dotted = hn::MulAdd(from.x, to.x, hn::Mul(from.y, to.y));
  const Cell both = hn::Mul(hn::Sqrt(from2), hn::Sqrt(to2));
  const Cell turn = hn::CopySign(
      hn::Mul(two, arc_tangent(d, hn::Div(hn::Abs(crossed), hn::Max(hn::Add(both, dotted), hn::Mul(both, cell_number(1e-7f)))))), crossed);
  const CellMask apart = hn::Gt(base, zero);
  const CellMask far = hn::Or(apart, hn::Or(hn::Ge(x0, cell_number(0.25f)), hn::Le(x1, cell_number(-0.25f))));
  const Cell middle_x = hn::Mul(cell_number(0.5f), hn::Add(x0, x1));
  const Place middle = place(middle_x, inner_at(middle_x));
  const Cell middle2 = hn::MulAdd(middle.x, middle.x, hn::Mul(middle.y, middle.y));
  const Cell middle_u = u_of(hn::Sqrt(middle2), hn::Sqrt(hn::Add(one, middle2)));
  const CellMask exact = hn::And(far, hn::Or(hn::Not(apart), hn::Lt(outside(middle_u), hn::Mul(cell_number(0.25f), outside(rest)))));
  const Cell all = hn::IfThenElseZero(exact, hn::Sub(outside(u_at(t0, zero)), outside(u_at(t1, zero))));

  std::array<Cell, NT> column_shape, column_risen;
  for (std::size_t j = 0; j < NT; ++j) column_shape[j] = column_risen[j] = zero;
  // What a ray through q has of the remainder, times a factor.
  struct Ray {
    Cell shape, risen;
  };
  const Cell half_level = hn::Mul(cell_number(0.5f), level), half_level_risen = hn::Mul(cell_number(0.5f), level_risen);
  std::array<Cell, NT> ts;
  for (std::size_t j = 0; j < NT; ++j) ts[j] = hn::MulAdd(t_span, cell_number(gt.x[j]), t0);
  const auto ray = [&](const Place& q, Cell u1, Cell per_q, Cell factor, bool counts) ETENDUE_INLINE_LAMBDA {
    // Everything hangs on p and on the direction of q: slopes m = 2 alpha p / (1 - p^2).
    const Cell view_q = hn::Mul(hn::Mul(vx, q.x), per_q), way = hn::Sub(rest, u1);
    const Cell row =
        hn::Mul(hn::Mul(hn::Mul(factor, per_q), hn::Mul(way, per_q)), hn::Mul(cell_number(static_cast<float>(8 / pi)), t_span));
    Ray sum{zero, zero};
    each<NT>([&](auto j) ETENDUE_INLINE_LAMBDA {
      const Cell u = hn::NegMulAdd(ts[j], way, rest), p = hn::Sub(one, u);
      const Cell less = hn::Mul(u, hn::Sub(two, u)), more = hn::MulAdd(p, p, one);
      const Cell m = hn::Mul(twice_alpha, p), m2 = hn::Mul(m, m), sv = hn::Mul(m, view_q), c_signed = hn::MulAdd(vz, less, sv);
      const Cell over = inverse_sqrt(d, hn::MulAdd(less, less, m2)), c = hn::Max(c_signed, zero);
      // n.l |h'|^2 = 2 v.m (1 - p^2) + n.v ((1 - p^2)^2 - m^2), m times 1 - p^2
      const Cell up = hn::NegMulAdd(vz, m2, hn::Mul(less, hn::Add(sv, c_signed)));
      const Cell nl = hn::Max(hn::Mul(up, hn::Mul(over, over)), zero);
      const Cell root = hn::Sqrt(hn::MulAdd(hn::Mul(nl, nl), less_alpha2, alpha2));
      const Cell seen = hn::MulAdd(nl, of_height, hn::Mul(of_root, root));
      const Cell per = inverse(d, hn::Mul(hn::Mul(more, more), hn::Mul(more, seen)));
      // Halves of W and of the level.
      const Cell shape = hn::Mul(hn::Mul(nl, c), per), taken = hn::Mul(hn::Mul(seen, per), less);
      const Cell away = hn::NegMulAdd(c, over, one), away2 = hn::Mul(away, away);
      const Cell w = hn::Mul(hn::Mul(away2, away2), away), f = hn::Mul(row, p);
      const Cell f_shape = hn::Mul(f, hn::NegMulAdd(taken, half_level, shape));
      const Cell f_risen = hn::Mul(f, hn::NegMulAdd(taken, half_level_risen, hn::Mul(shape, w)));
      const Cell weight = cell_number(gt.weight[j]);
      sum.shape = hn::MulAdd(f_shape, weight, sum.shape), sum.risen = hn::MulAdd(f_risen, weight, sum.risen);
      if (counts) column_shape[j] = hn::Add(column_shape[j], f_shape), column_risen[j] = hn::Add(column_risen[j], f_risen);
    });
    return sum;
  };
  std::array<Cell, told> of_shape{zero, zero, zero, zero}, of_risen = of_shape, of_area = of_shape;
  Cell shape_sum = zero, risen_sum = zero, area_sum = zero, shape_size = zero, risen_size = zero, area_size = zero, turned = zero;
  Cell most_shape = zero, most_risen = zero, least_area = one;
  const Cell half_over_pi = cell_number(static_cast<float>(0.5 / pi));
  for (std::size_t i = 0; i < NX; ++i) {
    const Cell x = hn::MulAdd(x_span, cell_number(gx.x[i]), x0), inner = inner_at(x);
    const Place q = place(x, inner);
    const Cell weight = hn::Mul(hn::Mul(hn::Mul(cell_number(gx.weight[i]), x_span), hn::Mul(kappa, hn::MulAdd(x, x, one))),
                                hn::Mul(hn::Mul(inner, inner), q.turn));
    const Cell q2 = hn::Max(hn::MulAdd(q.x, q.x, hn::Mul(q.y, q.y)), cell_number(1e-20f)), per_q = inverse_sqrt(d, q2);
    const Cell q_length = hn::Mul(q2, per_q), u1 = u_of(q_length, hn::Sqrt(hn::Add(one, q2)));
    const Cell turns = hn::Mul(weight, hn::Mul(per_q, per_q));
    turned = hn::Add(turned, turns);
    // r^2 at both ends, and of their difference what does not cancel, r = 2 p / (1 + p^2); where W is told apart from all of the turn, what
    // is outside of both.
    const Cell ua = u_at(t0, u1), ub = u_at(t1, u1), pa = hn::Sub(one, ua), pb = hn::Sub(one, ub);
    const Cell per_a = inverse(d, hn::MulAdd(pa, pa, one)), per_b = inverse(d, hn::MulAdd(pb, pb, one));
    const Cell r_sum = hn::Mul(two, hn::MulAdd(pa, per_a, hn::Mul(pb, per_b)));
    const Cell r_step =
        hn::Mul(hn::Mul(two, hn::Mul(t_span, hn::Sub(rest, u1))), hn::Mul(hn::NegMulAdd(ua, ub, hn::Add(ua, ub)), hn::Mul(per_a, per_b)));
    const Cell out_a = hn::Mul(hn::Mul(ua, hn::Sub(two, ua)), per_a), out_b = hn::Mul(hn::Mul(ub, hn::Sub(two, ub)), per_b);
    const Cell apart_area = hn::Sub(hn::MulSub(out_a, out_a, all), hn::Mul(out_b, out_b));
    const Cell area = hn::Mul(hn::Mul(turns, half_over_pi), hn::IfThenElse(exact, apart_area, hn::Mul(r_sum, r_step)));
    const Ray in = ray(q, u1, per_q, weight, true);
    for (std::size_t k = 0; k < told; ++k) {
      const Cell high = cell_number(gx.high[i][k]);
      of_shape[k] = hn::MulAdd(in.shape, high, of_shape[k]), of_risen[k] = hn::MulAdd(in.risen, high, of_risen[k]);
      of_area[k] = hn::MulAdd(area, high, of_area[k]);
    }
    shape_sum = hn::Add(shape_sum, in.shape), risen_sum = hn::Add(risen_sum, in.risen), area_sum = hn::Add(area_sum, area);
    shape_size = hn::Add(shape_size, hn::Abs(in.shape)), risen_size = hn::Add(risen_size, hn::Abs(in.risen));
    area_size = hn::Add(area_size, hn::Abs(area));
    const Cell over_turns = inverse(d, hn::Max(hn::Abs(turns), cell_number(1e-25f)));
    most_shape = hn::Max(most_shape, hn::Mul(hn::Abs(in.shape), over_turns));
    most_risen = hn::Max(most_risen, hn::Mul(hn::Abs(in.risen), over_turns));
    least_area = hn::Min(least_area, hn::Mul(hn::Abs(area), over_turns));
  }
  const Cell off = hn::Abs(hn::Sub(turn, turned));
  const CellMask missed = hn::And(far, hn::Gt(off, hn::Mul(cell_number(0.01f), hn::Abs(turn))));
  if (HWY_UNLIKELY(!hn::AllFalse(d, missed))) {
    for (const auto& [q, squared] : {std::pair(from, from2), std::pair(to, to2)}) {
      const Cell q2 = hn::Max(squared, cell_number(1e-20f)), per_q = inverse_sqrt(d, q2);
      const Ray in = ray(q, u_of(hn::Mul(q2, per_q), hn::Sqrt(hn::Add(one, q2))), per_q, q2, false);
      most_shape = hn::Max(most_shape, hn::IfThenElseZero(missed, hn::Abs(in.shape)));
      most_risen = hn::Max(most_risen, hn::IfThenElseZero(missed, hn::Abs(in.risen)));
    }
  }
  Cell area_error = left_over(of_area);
  area_error = hn::Max(area_error, hn::IfThenZeroElse(exact, hn::Mul(least_area, off)));
  area_sum = hn::MulAdd(hn::Mul(turn, half_over_pi), all, area_sum);
  // Roundings: of p close to the base, and of all that is added up.
  const Cell middle_p = hn::Sub(one, middle_u), less = hn::Mul(middle_u, hn::Sub(two, middle_u));
  const Cell rounding = hn::MulAdd(cell_number(1.5e-7f), hn::Mul(hn::Mul(hn::Abs(turn), middle_u), hn::Mul(middle_p, less)),
                                   hn::Mul(cell_number(1e-6f), area_size));
  std::array<Cell, told> t_shape{zero, zero, zero, zero}, t_risen = t_shape;
  each<NT>([&](auto j) ETENDUE_INLINE_LAMBDA {
    for (std::size_t k = 0; k < told; ++k) {
      const Cell high = cell_number(gt.high[j][k] * gt.weight[j]);
      t_shape[k] = hn::MulAdd(column_shape[j], high, t_shape[k]), t_risen[k] = hn::MulAdd(column_risen[j], high, t_risen[k]);
    }
  });
  const Cell far_off = hn::IfThenElseZero(far, off);
  const Cell sx = hn::MulAdd(level, area_error, hn::MulAdd(far_off, most_shape, left_over(of_shape)));
  const Cell rx = hn::MulAdd(level_risen, area_error, hn::MulAdd(far_off, most_risen, left_over(of_risen)));
  const Cell st = left_over(t_shape), rt = left_over(t_risen);
  // What is told, in units of what the coefficients say.
  const Cell safety = cell_number(2), noise = cell_number(1e-6f);
  hn::StoreU(hn::MulAdd(level, area_sum, shape_sum), d, cells.shape.data() + first);
  hn::StoreU(hn::MulAdd(level_risen, area_sum, risen_sum), d, cells.risen.data() + first);
  hn::StoreU(hn::MulAdd(safety, hn::Add(sx, st), hn::MulAdd(noise, shape_size, hn::Mul(level, rounding))), d,
             cells.shape_error.data() + first);
  hn::StoreU(hn::MulAdd(safety, hn::Add(rx, rt), hn::MulAdd(noise, risen_size, hn::Mul(level_risen, rounding))), d,
             cells.risen_error.data() + first);
  hn::StoreU(hn::Sub(hn::Add(st, rt), hn::Add(sx, rx)), d, cells.along_t.data() + first);
}

template <std::size_t NX, std::size_t NT>
void measure_all(const SideBlock& block, CellList& cells) {
  for (std::size_t i = 0; i < cells.count; i += hn::Lanes(CellFloats())) measure<NX, NT>(block, cells, i);
}
void Measure(const SideBlock& block, double tolerance, CellList& cells) {
  if (cells.count == 0) return;
  cells.fill_up();
  if (tolerance >= 5e-3) return measure_all<6, 4>(block, cells);
  if (tolerance >= 5e-4) return measure_all<7, 5>(block, cells);
  measure_all<8, 6>(block, cells);
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {

HWY_EXPORT(Measure);
HWY_EXPORT(LaySides);

void lay_sides(const RectWithin& light, const PlaceBlock& places, std::size_t count, SideBlock& block) {
  HWY_DYNAMIC_DISPATCH(LaySides)(light, places, count, block);
}
void measure(const SideBlock& block, double tolerance, CellList& cells) { HWY_DYNAMIC_DISPATCH(Measure)(block, tolerance, cells); }

}  // namespace etendue::eval
#endif
