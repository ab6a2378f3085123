// The globally best Disney parameters of many colour pairs in float: the profile of metal_profile.h over a grid of metal masks with its
// slope, and the valley of the most promising cell.
#include "etendue/material_fit_batch.h"

#include "batch_error.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "material_fit_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include "simd-inl.h"

#include <algorithm>
#include <array>
#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace etendue::HWY_NAMESPACE {
namespace {

constexpr float largest_k = static_cast<float>(largest_dielectric_f0), core_k = static_cast<float>(largest_dielectric_f0 / 4);
// The grid, and how often the valley of the most promising cell and of the next one is narrowed down.
constexpr int cells = 10, refinements = 3, second_refinements = 2;

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

HWY_INLINE V set(float x) { return hn::Set(D(), x); }

// A metal mask, the dielectric part that suits it, what is left of the six squares, and half its derivative in m.
struct Point {
  V m, k, residual, slope;
};
HWY_INLINE Point choose(M which, const Point& yes, const Point& no) {
  return {hn::IfThenElse(which, yes.m, no.m), hn::IfThenElse(which, yes.k, no.k), hn::IfThenElse(which, yes.residual, no.residual),
          hn::IfThenElse(which, yes.slope, no.slope)};
}
HWY_INLINE Point better(const Point& a, const Point& b) { return choose(hn::Lt(a.residual, b.residual), a, b); }

// A metal mask, with s = 1 - m, n = s^2 + m^2 and what divides by them; on the grid all of it is known.
struct Metal {
  V m, s, per_n, per_s;
};
constexpr float tiny = 1e-6f;
HWY_INLINE Metal metal_of(V m) {
  const V s = hn::Sub(set(1), m);
  return {m, s, hn::Div(set(1), hn::MulAdd(s, s, hn::Mul(m, m))), hn::Div(set(1), hn::Max(s, set(tiny)))};
}
HWY_INLINE Metal metal_of(int cell) {
  const float m = static_cast<float>(cell) / cells, s = 1 - m;
  return {set(m), set(s), set(1 / (s * s + m * m)), set(1 / std::max(s, tiny))};
}

class Profile {
 public:
  HWY_INLINE Profile(const V* diffuse, const V* f0, bool core) : core_(core) {
    for (int c = 0; c < 3; ++c) d_[c] = diffuse[c], f_[c] = f0[c];
    f_sum_ = hn::Add(f_[0], hn::Add(f_[1], f_[2]));
    f_mean_ = hn::Mul(set(1.0f / 3), f_sum_);
    d_mean_ = hn::Mul(set(1.0f / 3), hn::Add(d_[0], hn::Add(d_[1], d_[2])));
  }

  // The base colours at (m, k): the best of each channel, held within [0, 1].
  HWY_INLINE void base(V m, V k, V* b) const {
    const V s = hn::Sub(set(1), m), per_n = hn::Div(set(1), hn::MulAdd(s, s, hn::Mul(m, m)));
    for (int c = 0; c < 3; ++c) {
      const V g = hn::Sub(f_[c], k);
      b[c] = held_within(hn::Zero(D()), hn::Mul(hn::MulAdd(s, d_[c], hn::Mul(m, g)), per_n), set(1));
    }
  }

  // Where no base colour is at a bound, k is the mean of f - d m / s. From there Newton's steps: half the derivative in k,
  // 3 k - sum f + m sum b, has straight pieces, and a step within one ends at its root. On the grid, which only shows where to look, one.
  template <int steps = 2>
  HWY_INLINE Point at(const Metal& metal) const {
    const V zero = hn::Zero(D()), one = set(1), m = metal.m, s = metal.s;
    const V across = hn::Mul(s, metal.per_n), t = hn::Mul(m, metal.per_n);
    V free[3], b[3];  // the base colour without bounds is free - t k
    for (int c = 0; c < 3; ++c) free[c] = hn::MulAdd(across, d_[c], hn::Mul(t, f_[c]));
    V k = hn::Mul(set(core_k), s);
    if (!core_) {
      const V highest = hn::Mul(set(largest_k), s), mt = hn::Mul(m, t);
      k = held_within(zero, hn::NegMulAdd(hn::Mul(m, metal.per_s), d_mean_, f_mean_), highest);
      for (int step = 0; step < steps; ++step) {
        V sum = zero, curvature = set(3);
        for (const V& at_zero : free) {
          const V wanted = hn::NegMulAdd(t, k, at_zero), got = held_within(zero, wanted, one);
          sum = hn::Add(sum, got);
          curvature = hn::Sub(curvature, hn::IfThenElseZero(hn::Eq(wanted, got), mt));
        }
        const V derivative = hn::MulAdd(m, sum, hn::MulSub(set(3), k, f_sum_));
        k = held_within(zero, hn::Sub(k, hn::Div(derivative, hn::Max(curvature, set(tiny)))), highest);
      }
    }
    V residual = zero, slope = zero, specular_sum = zero;
    for (int c = 0; c < 3; ++c) {
      b[c] = held_within(zero, hn::NegMulAdd(t, k, free[c]), one);
      const V diffuse = hn::MulSub(s, b[c], d_[c]), specular = hn::MulAdd(m, b[c], hn::Sub(k, f_[c]));
      residual = hn::MulAdd(diffuse, diffuse, hn::MulAdd(specular, specular, residual));
      slope = hn::MulAdd(b[c], hn::Sub(specular, diffuse), slope);
      specular_sum = hn::Add(specular_sum, specular);
    }
    // k = kappa s moves with m.
    return {m, k, residual, hn::NegMulAdd(hn::Mul(k, metal.per_s), specular_sum, slope)};
  }

  // Where the residual is least without any bound, k that of the mean, and what it is there.
  HWY_INLINE V free_metal(V* least) const {
    const Squares squares = squares_about(d_mean_, f_mean_);
    const V m = squares.valley();
    *least = squares.residual(m);
    return m;
  }
  // Where it is least if k = 0 and no base colour is at a bound.
  HWY_INLINE V metal_without_dielectric() const { return squares_about(hn::Zero(D()), hn::Zero(D())).valley(); }

  // If k is at its bound kappa s and no base colour at one, what is left of a channel is (d m - f s + kappa s^2)^2 / n. Of the mean channel
  // it vanishes at a root of kappa m^2 + (d + f - 2 kappa) m + kappa - f: nearly grey pairs have a valley there, narrower than a cell.
  HWY_INLINE V metal_at_bound() const {
    const V kappa = bound(), excess = hn::Max(hn::Sub(f_mean_, kappa), hn::Zero(D()));
    const V half = hn::NegMulAdd(set(0.5f), hn::Add(d_mean_, f_mean_), kappa);  // minus half the coefficient of m
    const V root = hn::Sqrt(hn::MulAdd(half, half, hn::Mul(kappa, excess)));
    return held_within(hn::Zero(D()), hn::Div(excess, hn::Max(hn::Sub(root, half), set(tiny))), set(1));
  }
  // One step of Gauss and Newton from there: the slope over the sum of the squared derivatives of the three residuals.
  HWY_INLINE V towards_valley_at_bound(const Point& from) const {
    const Metal metal = metal_of(from.m);
    const V kappa = bound(), turn = hn::Mul(hn::Sub(metal.m, metal.s), metal.per_n), ks = hn::Mul(kappa, metal.s);
    V curvature = hn::Zero(D());
    for (int c = 0; c < 3; ++c) {
      const V left = hn::MulAdd(d_[c], metal.m, hn::Mul(metal.s, hn::Sub(ks, f_[c])));
      const V derivative = hn::NegMulAdd(left, turn, hn::NegMulAdd(set(2), ks, hn::Add(d_[c], f_[c])));
      curvature = hn::MulAdd(derivative, derivative, curvature);
    }
    const V step = hn::Div(from.slope, hn::Max(hn::Mul(curvature, metal.per_n), set(tiny)));
    return held_within(hn::Zero(D()), hn::Sub(from.m, step), set(1));
  }

 private:
  // FreeOptimum of material_fit.cpp: sums of squares and products of d and f, the residual of the best plain multiple of (1 - m, m) to each
  // channel as a quotient of m, and the valley of that with tan(t) for the half angle, t = atan2(2 X, D - F) / 2.
  struct Squares {
    V dd, df, ff;

    HWY_INLINE V valley() const {
      const V twice = hn::Add(df, df), p = hn::Sub(dd, ff), h = hn::Sqrt(hn::MulAdd(p, p, hn::Mul(twice, twice)));
      // tan t = 2X / (h + p) = (h - p) / 2X, whichever does not cancel.
      const M positive = hn::Gt(p, hn::Zero(D()));
      const V up = hn::IfThenElse(positive, twice, hn::Sub(h, p)), across = hn::IfThenElse(positive, hn::Add(h, p), twice);
      const V m = held_within(hn::Zero(D()), hn::Div(up, hn::Max(hn::Add(up, across), set(1e-30f))), set(1));
      return hn::IfThenElse(hn::Gt(df, hn::Zero(D())), m, hn::IfThenElseZero(hn::Lt(p, hn::Zero(D())), set(1)));
    }
    HWY_INLINE V residual(V m) const {
      const V s = hn::Sub(set(1), m);
      const V quotient = hn::MulAdd(dd, hn::Mul(m, m), hn::MulSub(ff, hn::Mul(s, s), hn::Mul(hn::Add(df, df), hn::Mul(m, s))));
      return hn::Div(quotient, hn::MulAdd(s, s, hn::Mul(m, m)));
    }
  };
  HWY_INLINE Squares squares_about(V d, V f) const {
    V dd = hn::Zero(D()), df = dd, ff = dd;
    for (int c = 0; c < 3; ++c) {
      const V a = hn::Sub(d_[c], d), b = hn::Sub(f_[c], f);
      dd = hn::MulAdd(a, a, dd), df = hn::MulAdd(a, b, df), ff = hn::MulAdd(b, b, ff);
    }
    return {dd, df, ff};
  }
  HWY_INLINE V bound() const { return set(core_ ? core_k : largest_k); }

  V d_[3], f_[3], f_sum_, d_mean_, f_mean_;
  bool core_;
};

// Where the cubic with these values and slopes at both ends has its valley, how low it is, and whether it has one between them. Its place
// is held a tenth of the width from both ends: beside a kink of the profile the cubic would creep.
struct Valley {
  V m, residual;
  M exists;
};
HWY_INLINE Valley valley_between(const Point& a, const Point& b, V width, V per_width) {
  const V ga = hn::Add(a.slope, a.slope), gb = hn::Add(b.slope, b.slope);
  const V rise = hn::Mul(hn::Sub(b.residual, a.residual), per_width);
  const V d1 = hn::NegMulAdd(set(3), rise, hn::Add(ga, gb));
  const V radicand = hn::NegMulAdd(ga, gb, hn::Mul(d1, d1)), d2 = hn::Sqrt(hn::Max(radicand, hn::Zero(D())));
  const V below = hn::Max(hn::Add(hn::Sub(gb, ga), hn::Add(d2, d2)), set(1e-20f));
  const V place = hn::Sub(set(1), hn::Div(hn::Sub(hn::Add(gb, d2), d1), below));
  const M exists = hn::And(hn::Ge(radicand, hn::Zero(D())), hn::Eq(place, held_within(hn::Zero(D()), place, set(1))));
  const V x = held_within(set(0.1f), place, set(0.9f));
  // a + width x (ga + x ((3 rise - 2 ga - gb) + x (ga + gb - 2 rise)))
  const V c3 = hn::NegMulAdd(set(2), rise, hn::Add(ga, gb)), c2 = hn::Sub(hn::NegMulAdd(set(2), ga, hn::Mul(set(3), rise)), gb);
  const V depth = hn::MulAdd(x, hn::MulAdd(x, c3, c2), ga);
  return {hn::MulAdd(width, x, a.m), hn::MulAdd(hn::Mul(width, x), depth, a.residual), exists};
}

// Between two neighbours of the grid: the left one's m, residuals and slopes at both ends, and its valley's depth.
struct Cell {
  V m, left, right, left_slope, right_slope, depth;
};
HWY_INLINE Cell choose(M which, const Cell& yes, const Cell& no) {
  return {hn::IfThenElse(which, yes.m, no.m),
          hn::IfThenElse(which, yes.left, no.left),
          hn::IfThenElse(which, yes.right, no.right),
          hn::IfThenElse(which, yes.left_slope, no.left_slope),
          hn::IfThenElse(which, yes.right_slope, no.right_slope),
          hn::IfThenElse(which, yes.depth, no.depth)};
}

HWY_INLINE Point optimum(const Profile& profile, bool core) {
  const V zero = hn::Zero(D());
  const auto with_margin = [](V residual) HWY_ATTR { return hn::MulAdd(residual, set(4e-6f), hn::Add(residual, set(1e-10f))); };
  const Point first = profile.at(metal_of(0)), last = profile.at(metal_of(cells));
  const auto whole_if_equal = [&](const Point& found) HWY_ATTR {
    const Point one = choose(hn::Le(last.residual, with_margin(found.residual)), last, found);
    return choose(hn::Le(first.residual, with_margin(one.residual)), first, one);
  };
  Point best = better(first, last);
  // No lane's answer depends on another's: those that are done keep theirs while the others go on.
  M done = hn::Lt(set(1), zero);
  if (!core) {
    V least;
    const V m = profile.free_metal(&least);
    best = better(profile.at(metal_of(m)), best);
    done = hn::Le(best.residual, with_margin(least));
    if (hn::AllTrue(D(), done)) return whole_if_equal(best);
  }
  const auto consider = [&](const Point& point, M lanes) HWY_ATTR {
    best = choose(hn::AndNot(done, hn::And(lanes, hn::Lt(point.residual, best.residual))), point, best);
  };
  const M every = hn::Ge(set(1), zero);
  if (!core) consider(profile.at(metal_of(profile.metal_without_dielectric())), every);
  const Point at_bound = profile.at(metal_of(profile.metal_at_bound()));
  consider(at_bound, every);
  consider(profile.at(metal_of(profile.towards_valley_at_bound(at_bound))), every);
  const V unlikely = set(1e30f);
  Cell deepest{zero, first.residual, last.residual, first.slope, last.slope, unlikely}, second = deepest;
  Point before = first;
  for (int i = 1; i <= cells; ++i) {
    const Point here = i == cells ? last : profile.at<1>(metal_of(i));
    consider(here, every);
    const Valley valley = valley_between(before, here, set(1.0f / cells), set(cells));
    const Cell cell{before.m,     before.residual, here.residual,
                    before.slope, here.slope,      hn::IfThenElse(valley.exists, valley.residual, unlikely)};
    const M ahead = hn::Lt(cell.depth, deepest.depth);
    second = choose(ahead, deepest, choose(hn::Lt(cell.depth, second.depth), cell, second));
    deepest = choose(ahead, cell, deepest);
    before = here;
  }
  const auto refine = [&](const Cell& cell, int times, M lanes) HWY_ATTR {
    const V unknown = zero;  // k, which nobody asks for
    Point left{cell.m, unknown, cell.left, cell.left_slope},
        right{hn::Add(cell.m, set(1.0f / cells)), unknown, cell.right, cell.right_slope};
    for (int i = 0; i < times; ++i) {
      const V width = hn::Sub(right.m, left.m), per_width = hn::Div(set(1), hn::Max(width, set(1e-20f)));
      const Point here = profile.at(metal_of(valley_between(left, right, width, per_width).m));
      consider(here, lanes);
      const M falling = hn::Lt(here.slope, zero);
      left = choose(falling, here, left), right = choose(falling, right, here);
    }
  };
  refine(deepest, refinements, every);
  // A cubic's depth is a guess: the second goes on if it may be lower.
  const M doubtful = hn::AndNot(done, hn::Lt(hn::Mul(second.depth, set(0.9f)), best.residual));
  if (!hn::AllFalse(D(), doubtful)) refine(second, second_refinements, doubtful);
  return whole_if_equal(best);
}

// One vector of pairs, interleaved r0 g0 b0 r1 ...
HWY_INLINE void fit_one(const float* diffuse, const float* f0, bool core, float* base, float* metal, float* reflectance) {
  const D tag;
  V d[3], f[3], b[3];
  hn::LoadInterleaved3(tag, diffuse, d[0], d[1], d[2]);
  hn::LoadInterleaved3(tag, f0, f[0], f[1], f[2]);
  for (V* x : {d, f})
    for (int c = 0; c < 3; ++c) x[c] = hn::IfThenElseZero(hn::Eq(x[c], x[c]), held_within(set(-65504), x[c], set(65504)));
  const Profile profile(d, f, core);
  const Point best = optimum(profile, core);
  profile.base(best.m, best.k, b);
  hn::StoreInterleaved3(b[0], b[1], b[2], tag, base);
  hn::StoreU(best.m, tag, metal);
  const V s = hn::Sub(set(1), best.m), share = hn::Div(best.k, hn::Max(hn::Mul(set(largest_k), s), set(1e-20f)));
  const V free = hn::Min(hn::Sqrt(share), set(1));
  hn::StoreU(hn::IfThenElse(hn::Gt(s, hn::Zero(tag)), core ? set(0.5f) : free, set(0.5f)), tag, reflectance);
}

void FitDisney(const float* diffuse, const float* f0, bool core, std::size_t count, float* base, float* metal, float* reflectance) {
  const std::size_t lanes = hn::Lanes(D());
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) fit_one(diffuse + 3 * i, f0 + 3 * i, core, base + 3 * i, metal + i, reflectance + i);
  if (i == count) return;
  constexpr std::size_t most = hn::MaxLanes(D());
  HWY_ALIGN float last_d[3 * most] = {}, last_f[3 * most] = {}, last_b[3 * most], last_m[most], last_r[most];
  std::copy(diffuse + 3 * i, diffuse + 3 * count, last_d);
  std::copy(f0 + 3 * i, f0 + 3 * count, last_f);
  fit_one(last_d, last_f, core, last_b, last_m, last_r);
  std::copy(last_b, last_b + 3 * (count - i), base + 3 * i);
  std::copy(last_m, last_m + (count - i), metal + i);
  std::copy(last_r, last_r + (count - i), reflectance + i);
}

}  // namespace
}  // namespace etendue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue {
namespace {
HWY_EXPORT(FitDisney);
}

Status fit_disney(std::span<const Vec3f> diffuse, std::span<const Vec3f> f0, DisneyColumns out, DielectricF0 dielectric) {
  const std::size_t count = diffuse.size();
  for (const std::size_t size : {f0.size(), out.base_colour.size(), out.metal.size(), out.reflectance.size()})
    if (size != count) return batch_sizes_differ(count, size);
  if (count == 0) return Done{};
  HWY_DYNAMIC_DISPATCH(FitDisney)
  (&diffuse[0].x, &f0[0].x, dielectric == DielectricF0::core, count, &out.base_colour[0].x, out.metal.data(), out.reflectance.data());
  return Done{};
}

}  // namespace etendue
#endif  // HWY_ONCE
