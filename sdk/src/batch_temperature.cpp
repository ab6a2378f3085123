// Correlated colour temperature and Duv, many at once: the nearest point of the Planckian locus, as in colour_temperature.cpp, on arcs of
// fifth degree that meet the locus with its first two derivatives.
#include "etendue/batch.h"

#include "batch_error.h"
#include "planck_locus.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "batch_temperature.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include "simd-inl.h"

#include <array>
#include <cstddef>
#include <cstdint>

#ifndef ETENDUE_BATCH_TEMPERATURE_SHARED
#define ETENDUE_BATCH_TEMPERATURE_SHARED
namespace etendue {
namespace {
#include "colour_fits.inc"

// Arcs over equal intervals of 1/T from infinite temperature to 500 K: with 256 of them the arcs are within 7e-13 of the locus, which moves
// temperatures by 2e-5 K at 40000 K and 1.7e-8 of them anywhere (from Hermite's error term; the test measures it).
constexpr int arc_count = 256;
constexpr double least_K = 500, largest_K = 100000, largest_duv = 0.05;
constexpr double arc_mired = 1e6 / least_K / arc_count;
// u = sum c_k t^k, then v, over t from 0 to 1.
constexpr int arc_terms = 6;
using Arcs = std::array<double, arc_count * arc_terms * 2>;
}  // namespace
}  // namespace etendue
#endif

HWY_BEFORE_NAMESPACE();
namespace etendue::HWY_NAMESPACE {
namespace {

// sum over i + j <= Degree of c x^i y^j, in the order of colour_fits.py's nested().
template <int Degree, class D, class T, class V>
HWY_INLINE V bivariate(D d, const T* c, V x, V y) {
  V sum = hn::Zero(d);
  for (int i = Degree; i >= 0; --i) {
    V inner = hn::Set(d, *c++);
    for (int j = Degree - i; j > 0; --j) inner = hn::MulAdd(inner, y, hn::Set(d, *c++));
    sum = i == Degree ? inner : hn::MulAdd(sum, x, inner);
  }
  return sum;
}

// One arc in each lane, and where on it: position = index of the arc + t.
template <class D>
struct LaneArcs {
  using V = hn::Vec<D>;
  V first;              // the arcs' indices
  V uv[2 * arc_terms];  // of u, then of v

  // Anything beside the table (NaN as well) is sent to its first arc: it does not converge there, or is found out of range.
  LaneArcs(D d, const double* arcs, V position) {
    const hn::RebindToSigned<D> di;
    const auto inside = hn::And(hn::Ge(position, hn::Zero(d)), hn::Lt(position, hn::Set(d, static_cast<double>(arc_count))));
    const auto last =
        hn::IfThenElse(hn::Ge(position, hn::Set(d, static_cast<double>(arc_count))), hn::Set(d, arc_count - 1.0), hn::Zero(d));
    first = hn::IfThenElse(inside, hn::Floor(position), last);
    const auto index = hn::ConvertTo(di, hn::Mul(first, hn::Set(d, 2.0 * arc_terms)));
#if HWY_TARGET == HWY_AVX2
    // Its gathers take most of the time: rows are loaded and turned instead, four numbers of four arcs at once.
    static_assert(hn::MaxLanes(D()) == 4 && 2 * arc_terms % 4 == 0);
    HWY_ALIGN std::int64_t rows[4];
    hn::Store(index, di, rows);
    for (int k = 0; k < 2 * arc_terms; k += 4) {
      const V a = hn::LoadU(d, arcs + rows[0] + k), b = hn::LoadU(d, arcs + rows[1] + k), c = hn::LoadU(d, arcs + rows[2] + k),
              e = hn::LoadU(d, arcs + rows[3] + k);
      const V even_ab = hn::InterleaveLower(d, a, b), odd_ab = hn::InterleaveUpper(d, a, b), even_ce = hn::InterleaveLower(d, c, e),
              odd_ce = hn::InterleaveUpper(d, c, e);
      uv[k] = hn::ConcatLowerLower(d, even_ce, even_ab);
      uv[k + 1] = hn::ConcatLowerLower(d, odd_ce, odd_ab);
      uv[k + 2] = hn::ConcatUpperUpper(d, even_ce, even_ab);
      uv[k + 3] = hn::ConcatUpperUpper(d, odd_ce, odd_ab);
    }
#else
    for (int k = 0; k < 2 * arc_terms; ++k) uv[k] = hn::GatherIndex(d, arcs + k, index);
#endif
  }
};

template <class V>
struct Curve {
  V value, first, second;
};
template <class D, class V>
HWY_INLINE Curve<V> curve_of(D d, const V* c, V t) {
  V value = c[arc_terms - 1], first = hn::Zero(d), half_second = hn::Zero(d);
  for (int k = arc_terms - 2; k >= 0; --k) {
    half_second = hn::MulAdd(half_second, t, first);
    first = hn::MulAdd(first, t, value);
    value = hn::MulAdd(value, t, c[k]);
  }
  return {value, first, hn::Add(half_second, half_second)};
}

// Newton's step for (c - q) . c' = 0.
template <class D, class V>
HWY_INLINE V newton_step(D d, const LaneArcs<D>& arcs, V position, V u, V v) {
  const V t = hn::Sub(position, arcs.first);
  const Curve<V> cu = curve_of(d, arcs.uv, t), cv = curve_of(d, arcs.uv + arc_terms, t);
  const V away_u = hn::Sub(cu.value, u), away_v = hn::Sub(cv.value, v);
  const V along = hn::MulAdd(away_u, cu.first, hn::Mul(away_v, cv.first));
  const V speed = hn::MulAdd(cu.first, cu.first, hn::Mul(cv.first, cv.first));
  const V slope = hn::Add(speed, hn::MulAdd(away_u, cu.second, hn::Mul(away_v, cv.second)));
  return hn::Div(along, slope);
}

std::size_t ColourTemperatures(const double* xy, const double* table, double* kelvin_duv, std::size_t count, ColourTemperature where_none) {
  const hn::ScalableTag<double> d;
  const auto set = [&](double x) { return hn::Set(d, x); };
  std::size_t without = 0;
  for_each_vector<2, 2>(d, xy, kelvin_duv, count, 1.0 / 3, [&](const double* from, double* to) {
    hn::Vec<decltype(d)> x, y;
    hn::LoadInterleaved2(d, from, x, y);
    const auto scale = hn::Div(set(1), hn::MulAdd(set(-2), x, hn::MulAdd(set(12), y, set(3))));
    const auto u = hn::Mul(hn::Mul(set(4), x), scale), v = hn::Mul(hn::Mul(set(6), y), scale);

    // The first guess is within 3.3 mired, and each step squares what it left: .14 mired, then, on the arc found by now, 2e-4 and 6e-10.
    const auto a = hn::Sub(u, set(0.3)), b = hn::Sub(v, set(0.32));
    const auto guess = hn::Div(bivariate<4>(d, mired_numerator, a, b), bivariate<3>(d, mired_denominator, a, b));
    auto position = hn::Mul(guess, set(1 / arc_mired));
    position = hn::Sub(position, newton_step(d, LaneArcs(d, table, position), position, u, v));
    const LaneArcs arcs(d, table, position);
    position = hn::Sub(position, newton_step(d, arcs, position, u, v));
    const auto last_step = newton_step(d, arcs, position, u, v);
    position = hn::Sub(position, last_step);

    const auto t = hn::Sub(position, arcs.first);
    const auto cu = curve_of(d, arcs.uv, t), cv = curve_of(d, arcs.uv + arc_terms, t);
    const auto speed = hn::Sqrt(hn::MulAdd(cu.first, cu.first, hn::Mul(cv.first, cv.first)));
    // (q - c) . n, n the tangent turned left: (-c'_v, c'_u).
    const auto duv = hn::Div(hn::MulSub(hn::Sub(v, cv.value), cu.first, hn::Mul(hn::Sub(u, cu.value), cv.first)), speed);
    const auto kelvin = hn::Div(set(1e6 / arc_mired), position);

    // What the arcs' error may move the ends by still counts as within. A foot point within .05 is the nearest: the locus' least
    // radius of curvature is .100, and it does not come back to itself.
    constexpr double slack = 4e-8, converged = 1e-4;
    auto valid = hn::And(hn::Gt(y, hn::Zero(d)), hn::Le(hn::Abs(duv), set(largest_duv * (1 + 1e-9))));
    valid = hn::And(valid, hn::Le(hn::Abs(last_step), set(converged)));
    valid = hn::And(valid, hn::And(hn::Ge(kelvin, set(least_K * (1 - slack))), hn::Le(kelvin, set(largest_K * (1 + slack)))));
    const auto held = hn::Min(hn::Max(kelvin, set(least_K)), set(largest_K));
    hn::StoreInterleaved2(hn::IfThenElse(valid, held, set(where_none.kelvin)), hn::IfThenElse(valid, duv, set(where_none.duv)), d, to);
    without += hn::CountTrue(d, hn::Not(valid));
  });
  return without;
}

std::size_t FitColourTemperature(const float* xy, float* kelvin, std::size_t count, float where_none) {
  const hn::ScalableTag<float> d;
  const auto set = [&](float x) { return hn::Set(d, x); };
  std::size_t without = 0;
  for_each_vector<2, 1>(d, xy, kelvin, count, 1.0f / 3, [&](const float* from, float* to) {
    hn::Vec<decltype(d)> x, y;
    hn::LoadInterleaved2(d, from, x, y);
    const auto a = hn::Sub(x, set(0.33f)), b = hn::Sub(y, set(0.33f));
    const auto t = hn::Div(bivariate<3>(d, kelvin_numerator, a, b), bivariate<3>(d, kelvin_denominator, a, b));
    // The quadratic is within .034 for |Duv| <= .02, and nothing that it gives less than .035, with x + y <= 1.25, is further
    // away than .05.
    const auto real = hn::And(hn::Gt(y, set(0)), hn::Le(hn::Add(x, y), set(1.25f)));
    const auto near = hn::And(real, hn::Le(hn::Abs(bivariate<2>(d, duv_quadratic, a, b)), set(0.035f)));
    const auto valid = hn::And(near, hn::And(hn::Ge(t, set(990.0f)), hn::Le(t, set(40400.0f))));
    hn::StoreU(hn::IfThenElse(valid, t, set(where_none)), d, to);
    without += hn::CountTrue(d, hn::Not(valid));
  });
  return without;
}

}  // namespace
}  // namespace etendue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue {
namespace {

HWY_EXPORT(ColourTemperatures);
HWY_EXPORT(FitColourTemperature);

static_assert(sizeof(Chromaticity) == 2 * sizeof(double) && sizeof(ColourTemperature) == 2 * sizeof(double));

// From value, slope and second derivative at both ends of an interval of width 1, with e = what constant, slope and curvature at the left
// end leave over at the right one: c3 = 10 e - 4 e' + e''/2, c4 = -15 e + 7 e' - e'', c5 = 6 e - 3 e' + e''/2.
void write_arc(double* c, double left, double left1, double left2, double right, double right1, double right2) {
  const double e = right - left - left1 - left2 / 2, e1 = right1 - left1 - left2, e2 = right2 - left2;
  const double terms[arc_terms] = {left, left1, left2 / 2, 10 * e - 4 * e1 + e2 / 2, -15 * e + 7 * e1 - e2, 6 * e - 3 * e1 + e2 / 2};
  std::copy(std::begin(terms), std::end(terms), c);
}

const Arcs& arcs() {
  static const Arcs all = [] {
    Arcs made;
    constexpr double h = arc_mired * 1e-6;
    LocusPoint left = planck_locus(0);
    for (int i = 0; i < arc_count; ++i) {
      const LocusPoint right = planck_locus((i + 1) * h);
      double* c = made.data() + static_cast<std::ptrdiff_t>(i) * arc_terms * 2;
      write_arc(c, left.uv.x, left.first.x * h, left.second.x * h * h, right.uv.x, right.first.x * h, right.second.x * h * h);
      write_arc(c + arc_terms, left.uv.y, left.first.y * h, left.second.y * h * h, right.uv.y, right.first.y * h, right.second.y * h * h);
      left = right;
    }
    return made;
  }();
  return all;
}

}  // namespace

BatchOutcome to_colour_temperature(std::span<const Chromaticity> xy, std::span<ColourTemperature> temperature,
                                   ColourTemperature where_none) {
  if (xy.size() != temperature.size()) return batch_sizes_differ(xy.size(), temperature.size());
  return HWY_DYNAMIC_DISPATCH(ColourTemperatures)(reinterpret_cast<const double*>(xy.data()), arcs().data(),
                                                  reinterpret_cast<double*>(temperature.data()), xy.size(), where_none);
}

BatchOutcome fit_colour_temperature(std::span<const Vec2f> xy, std::span<float> temperature_K, float where_none) {
  if (xy.size() != temperature_K.size()) return batch_sizes_differ(xy.size(), temperature_K.size());
  return HWY_DYNAMIC_DISPATCH(FitColourTemperature)(reinterpret_cast<const float*>(xy.data()), temperature_K.data(), xy.size(), where_none);
}

}  // namespace etendue
#endif  // HWY_ONCE
