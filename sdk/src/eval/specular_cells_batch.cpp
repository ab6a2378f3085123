// Cells of specular_cells.h in vectors: a cell a lane of floats.
#include "specular_cells.h"

#include "gauss_rule.h"
#include "light_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/specular_cells_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include <algorithm>
#include <utility>

#include "eval/arc_tangent-inl.h"
#include "eval/light_batch-inl.h"
#include "eval/specular_curve-inl.h"

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

template <std::size_t NX, std::size_t NT, bool Rims>
HWY_NOINLINE void measure(const SideBlock& block, CellList& cells, std::size_t first) {
  const CellFloats d;
  const hn::RebindToSigned<CellFloats> di;
  const GaussFloats<NX>& gx = gauss_floats<NX>();
  const GaussFloats<NT>& gt = gauss_floats<NT>();
  const Cell zero = cell_number(0), one = cell_number(1), two = cell_number(2);
  const auto at_point = hn::LoadU(di, cells.point.data() + first), at_side = hn::LoadU(di, cells.side.data() + first);
  const auto of_point = [&](SideBlock::OfPoint k) ETENDUE_INLINE_LAMBDA { return hn::GatherIndex(d, block.point[k].data(), at_point); };
  const auto of_side = [&](SideBlock::OfSide k) ETENDUE_INLINE_LAMBDA { return hn::GatherIndex(d, block.side[k].data(), at_side); };
  const Cell turn0 = of_side(SideBlock::turn0), turn1 = of_side(SideBlock::turn1), turn2 = of_side(SideBlock::turn2);
  const Cell kappa = of_side(SideBlock::kappa);
  const Cell alpha = of_point(SideBlock::alpha), vx = of_point(SideBlock::view_x), vz = of_point(SideBlock::view_z);
  const Cell of_height = of_point(SideBlock::of_height), of_root = of_point(SideBlock::of_root), base = of_point(SideBlock::base),
             rest = of_point(SideBlock::rest);
  const Cell level = of_point(SideBlock::level), level_risen = of_point(SideBlock::level_risen);
  const Cell origin = hn::LoadU(d, cells.origin.data() + first), to_end = hn::Sub(one, origin), to_begin = hn::Add(one, origin);
  const Cell x0 = hn::LoadU(d, cells.x0.data() + first), x1 = hn::LoadU(d, cells.x1.data() + first);
  const Cell t0 = hn::LoadU(d, cells.t0.data() + first), t1 = hn::LoadU(d, cells.t1.data() + first);
  const Cell x_span = hn::Sub(x1, x0), t_span = hn::Sub(t1, t0);
  const Cell alpha2 = hn::Mul(alpha, alpha), less_alpha2 = hn::Sub(one, alpha2), twice_alpha = hn::Add(alpha, alpha);

  const SideCurve<Rims, CellFloats> curve(of_side, vx, vz, alpha);
  struct Place {
    Cell x, y, turn;
  };
  const auto place = [&](Cell x, Cell inner) ETENDUE_INLINE_LAMBDA {
    const Cell tau = hn::Mul(hn::Mul(kappa, hn::Add(origin, x)), inner);
    const auto h = curve.at(tau);
    const Cell over = inverse(d, h.z);
    Cell turn = hn::MulAdd(hn::MulAdd(turn2, tau, turn1), tau, turn0);
    if constexpr (Rims) turn = hn::Add(turn, curve.more_turn(tau, h));
    return Place{hn::Mul(h.x, over), hn::Mul(h.y, over), hn::Mul(hn::Mul(turn, over), over)};
  };
  const auto inner_at = [&](Cell x) ETENDUE_INLINE_LAMBDA { return inverse(d, hn::Mul(hn::Sub(to_end, x), hn::Add(to_begin, x))); };
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
  const CellMask far =
      hn::Or(apart, hn::Or(hn::Ge(hn::Add(origin, x0), cell_number(0.25f)), hn::Le(hn::Add(origin, x1), cell_number(-0.25f))));
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
    const Cell x = hn::MulAdd(x_span, cell_number(gx.x[i]), x0), whole = hn::Add(origin, x), inner = inner_at(x);
    const Place q = place(x, inner);
    const Cell weight = hn::Mul(hn::Mul(hn::Mul(cell_number(gx.weight[i]), x_span), hn::Mul(kappa, hn::MulAdd(whole, whole, one))),
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
  const Cell rounding = hn::MulAdd(cell_number(8e-8f), hn::Mul(hn::Mul(hn::Abs(turn), middle_u), hn::Mul(middle_p, less)),
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
  const auto all = [&](const auto& one) {
    for (std::size_t i = 0; i < cells.count; i += hn::Lanes(CellFloats())) one(block, cells, i);
  };
  if (block.rims) return all(measure<NX, NT, true>);
  all(measure<NX, NT, false>);
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

void measure(const SideBlock& block, double tolerance, CellList& cells) { HWY_DYNAMIC_DISPATCH(Measure)(block, tolerance, cells); }

}  // namespace etendue::eval
#endif
