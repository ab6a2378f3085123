// A search over metal masks whose cost has several valleys, a lane for each pair of colours. Nothing is fused (-ffp-contract=off), so that
// what is stored does not depend on the machine.
#include "best_masks.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "picture/best_masks.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "metal_rough_colours.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

constexpr double never = std::numeric_limits<double>::infinity();
HWY_INLINE V set(double x) { return hn::Set(D(), x); }
HWY_INLINE V clamped(V x, V high) { return hn::Min(hn::Max(x, hn::Zero(D())), high); }

struct Best {
  V metal, cost;
};

class Lanes {
 public:
  HWY_INLINE Lanes(const double (&numbers)[6][hn::MaxLanes(D())], double weight) : weight_(set(weight)), both_(set(1 + weight)) {
    for (int c = 0; c < 3; ++c) d_[c] = hn::Load(D(), numbers[c]), f_[c] = hn::Load(D(), numbers[3 + c]);
  }

  // metal_rough_cost() of metal_rough_of_held(); k s, s = 1 - m, stands for k.
  HWY_INLINE V cost(V m) const {
    const V zero = hn::Zero(D()), one = set(1), s = hn::Sub(one, m), mm = hn::Mul(m, m), dark = hn::Mul(set(core_f0), s);
    const V across = hn::Add(hn::Mul(both_, hn::Mul(s, s)), mm), per_across = hn::Div(one, across);
    const V per_bound = hn::Div(one, hn::Add(across, hn::Mul(weight_, mm)));
    V core = zero, full = zero;
    for (int c = 0; c < 3; ++c) {
      const V towards = hn::Add(hn::Mul(hn::Mul(both_, s), d_[c]), hn::Mul(m, hn::Sub(f_[c], dark)));
      V base = hn::Mul(towards, per_across);
      const V ks = hn::Sub(f_[c], hn::Mul(m, base));
      const M bound = hn::Or(hn::Or(hn::Lt(ks, zero), hn::Gt(ks, s)), hn::Eq(s, zero));
      const V left = hn::Sub(f_[c], hn::IfThenElseZero(hn::Gt(ks, zero), s));
      const V at_bound = hn::Mul(hn::Add(towards, hn::Mul(hn::Mul(weight_, m), left)), per_bound);
      base = clamped(hn::IfThenElse(bound, at_bound, base), one);
      const V diffuse = hn::Sub(hn::Mul(s, base), d_[c]), rest = hn::Sub(hn::Mul(m, base), f_[c]), in_core = hn::Add(dark, rest);
      const V in_full = hn::Add(rest, clamped(hn::Neg(rest), s)), square = hn::Mul(diffuse, diffuse);
      core = hn::Add(core, hn::Add(square, hn::Mul(in_core, in_core)));
      full = hn::Add(full, hn::Add(square, hn::Mul(in_full, in_full)));
    }
    return hn::Add(core, hn::Mul(weight_, full));
  }

  HWY_INLINE void consider(Best& best, V m, M lanes) const {
    const V here = cost(m);
    const M better = hn::And(lanes, hn::Lt(here, best.cost));
    best = {hn::IfThenElse(better, m, best.metal), hn::IfThenElse(better, here, best.cost)};
  }

  HWY_INLINE void refine(Best& best, V width) const {
    for (int halving = 0; halving < 12; ++halving, width = hn::Mul(set(0.5), width)) {
      const V at = best.metal;
      consider(best, hn::Max(hn::Sub(at, width), hn::Zero(D())), every());
      consider(best, hn::Min(hn::Add(at, width), set(1)), every());
    }
  }

  static constexpr std::size_t most_kinks = 12;
  using Kinks = std::array<V, most_kinks>;
  // Where a bound begins to hold, sorted; `never` where it does not. With s = 1 - m a full reader's b = d / s and k = (f - m b) / s are
  // exact while b <= 1, that is s >= d; k >= 0, that is m <= f / (f + d); and k <= 1, that is s^2 - (f + d) s + d >= 0.
  HWY_INLINE void sorted_kinks(Kinks& kinks) const {
    const V zero = hn::Zero(D()), one = set(1);
    const auto inside = [&](V m, M exists)
                            HWY_ATTR { return hn::IfThenElse(hn::And(exists, hn::And(hn::Gt(m, zero), hn::Lt(m, one))), m, set(never)); };
    std::size_t count = 0;
    for (int c = 0; c < 3; ++c) {
      const V d = d_[c], f = f_[c], sum = hn::Add(f, d), half = hn::Mul(set(0.5), sum), square = hn::Sub(hn::Mul(half, half), d);
      const V root = hn::Sqrt(hn::Max(square, zero)), middle = hn::Sub(one, half);
      const M both = hn::And(hn::Gt(f, zero), hn::Gt(d, zero)), real = hn::Gt(square, zero);
      kinks[count++] = inside(hn::Sub(one, d), every());
      kinks[count++] = inside(hn::Div(f, hn::IfThenElse(both, sum, one)), both);
      kinks[count++] = inside(hn::Sub(middle, root), real);
      kinks[count++] = inside(hn::Add(middle, root), real);
    }
    for (std::size_t end = most_kinks; end > 1; --end)
      for (std::size_t i = 1; i < end; ++i) {
        const V low = hn::Min(kinks[i - 1], kinks[i]), high = hn::Max(kinks[i - 1], kinks[i]);
        kinks[i - 1] = low, kinks[i] = high;
      }
  }

  // From the best point of a grid, and from the best of the kinks and the middles between these, in steps that halve: a large weight makes
  // valleys narrow.
  HWY_INLINE Best best() const {
    constexpr int steps = 20;
    Best best{hn::Zero(D()), set(never)}, of_kinks = best;
    for (int i = 0; i <= steps; ++i) consider(best, set(static_cast<double>(i) / steps), every());
    V last = hn::Zero(D()), widest = last;
    Kinks kinks;
    sorted_kinks(kinks);
    for (const V kink : kinks) {
      const M exists = hn::Lt(kink, set(1));
      if (hn::AllFalse(D(), exists)) break;
      const V at = hn::IfThenElse(exists, kink, last);
      consider(of_kinks, at, exists);
      consider(of_kinks, hn::Mul(set(0.5), hn::Add(last, at)), exists);
      widest = hn::Max(widest, hn::Sub(at, last));
      last = at;
    }
    refine(best, set(0.5 / steps));
    refine(of_kinks, hn::Min(hn::Mul(set(0.25), widest), set(0.5 / steps)));
    const M ahead = hn::Lt(of_kinks.cost, best.cost);
    return {hn::IfThenElse(ahead, of_kinks.metal, best.metal), hn::IfThenElse(ahead, of_kinks.cost, best.cost)};
  }

 private:
  static HWY_INLINE M every() { return hn::Ge(set(1), hn::Zero(D())); }
  V d_[3], f_[3], weight_, both_;
};

void BestMasks(const ColourPair* pairs, std::size_t count, double weight, MaskCost* out) {
  const std::size_t lanes = hn::Lanes(D());
  HWY_ALIGN double numbers[6][hn::MaxLanes(D())] = {}, metal[hn::MaxLanes(D())], cost[hn::MaxLanes(D())];
  for (std::size_t begin = 0; begin < count; begin += lanes) {
    const std::size_t some = std::min(lanes, count - begin);
    for (std::size_t i = 0; i < some; ++i)
      for (int c = 0; c < 3; ++c) numbers[c][i] = pairs[begin + i].diffuse[c], numbers[3 + c][i] = pairs[begin + i].f0[c];
    const Best best = Lanes(numbers, weight).best();
    hn::Store(best.metal, D(), metal);
    hn::Store(best.cost, D(), cost);
    for (std::size_t i = 0; i < some; ++i) out[begin + i] = {metal[i], cost[i]};
  }
}

}  // namespace
}  // namespace etendue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue {
namespace {
HWY_EXPORT(BestMasks);
}

void best_masks(std::span<const ColourPair> pairs, double weight, std::span<MaskCost> out) {
  HWY_DYNAMIC_DISPATCH(BestMasks)(pairs.data(), std::min(pairs.size(), out.size()), weight, out.data());
}

}  // namespace etendue
#endif  // HWY_ONCE
