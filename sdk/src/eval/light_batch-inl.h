// What the kernels of light_batch.h share, once for each instruction set: include it after HWY_TARGET_INCLUDE and hwy/foreach_target.h.
#if defined(ETENDUE_LIGHT_BATCH_INL_H) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard, once an instruction set
#ifdef ETENDUE_LIGHT_BATCH_INL_H
#undef ETENDUE_LIGHT_BATCH_INL_H
#else
#define ETENDUE_LIGHT_BATCH_INL_H
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <type_traits>
#include <utility>

#include "eval/light_batch.h"

#undef ETENDUE_INLINE_LAMBDA
#define ETENDUE_INLINE_LAMBDA __attribute__((always_inline))

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
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
HWY_INLINE Vector<V> operator+(const Vector<V>& a, const Vector<V>& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
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

// f(0), f(1), ... of constants: loops that are not left to the optimiser, which takes care that what is independent stands side by side.
template <class F, std::size_t... I>
HWY_INLINE void each_of(std::index_sequence<I...>, F f) {
  (f(std::integral_constant<std::size_t, I>()), ...);
}
template <std::size_t N, class F>
HWY_INLINE void each(F f) {
  each_of(std::make_index_sequence<N>(), f);
}

template <class D>
constexpr bool in_floats = std::is_same_v<hn::TFromD<D>, float>;
template <class D, class V = hn::Vec<D>>
HWY_INLINE V number(D d, double x) {
  return hn::Set(d, static_cast<hn::TFromD<D>>(x));
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE V number(D d, const Constant& x) {
  if constexpr (in_floats<D>)
    return hn::Set(d, x.single);
  else
    return hn::Set(d, x.whole);
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vector<V> numbers(D d, const Direction& v) {
  return {number(d, v.x), number(d, v.y), number(d, v.z)};
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vector<V> numbers(D d, const Vec3d& v) {
  return {number(d, v.x), number(d, v.y), number(d, v.z)};
}

// 1 / sqrt(x) to 12 bits or more.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V near_inverse_sqrt(D d, V x) {
#if HWY_ARCH_X86 && HWY_TARGET < HWY_EMU128
  if constexpr (in_floats<D>) return hn::ApproximateReciprocalSqrt(x);
#endif
  return hn::Div(number(d, 1), hn::Sqrt(x));
}
// Within 4e-7 of it in floats: one step of Newton's.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V inverse_sqrt(D d, V x) {
  const V guess = near_inverse_sqrt(d, x), half = hn::Mul(x, number(d, 0.5));
  return hn::Mul(guess, hn::NegMulAdd(hn::Mul(half, guess), guess, number(d, 1.5)));
}
// The same with as many digits as terms that cancel are worth: within 4e-7 in floats, 1e-13 in doubles without a division.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V inverse_root(D d, V x) {
  if constexpr (in_floats<D>) {
    return inverse_sqrt(d, x);
  } else {
#if HWY_ARCH_X86 && HWY_TARGET < HWY_EMU128
    // From 12 bits to 48: (1 - e)^(-1/2) in e, to its cube.
    const hn::Rebind<float, D> floats;
    const V guess = hn::PromoteTo(d, hn::ApproximateReciprocalSqrt(hn::DemoteTo(floats, x))), scaled = hn::Mul(x, guess);
    const V e = hn::NegMulAdd(scaled, guess, number(d, 1));
    const V more = hn::Mul(e, hn::MulAdd(hn::MulAdd(e, number(d, 0.3125), number(d, 0.375)), e, number(d, 0.5)));
    return hn::MulAdd(guess, more, guess);
#else
    return hn::Div(number(d, 1), hn::Sqrt(x));
#endif
  }
}

// 1 / x, within 2e-7 of it in floats.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V inverse(D d, V x) {
#if HWY_ARCH_X86 && HWY_TARGET < HWY_EMU128
  if constexpr (in_floats<D>) {
    const V guess = hn::ApproximateReciprocal(x);
    return hn::Mul(guess, hn::NegMulAdd(x, guess, number(d, 2)));
  }
#endif
  return hn::Div(number(d, 1), x);
}

// c0 + c1 x + c2 x^2 + ...
template <class D, std::size_t N, class V = hn::Vec<D>>
HWY_INLINE V polynomial(D d, V x, const std::array<double, N>& c) {
  V p = number(d, c[N - 1]);
  for (std::size_t i = N - 1; i-- > 0;) p = hn::MulAdd(p, x, number(d, c[i]));
  return p;
}

// The same of several x side by side, even and odd powers apart: half as many steps that wait for each other.
template <std::size_t N, class D, std::size_t C, class V = hn::Vec<D>>
HWY_INLINE std::array<V, N> polynomials(D d, const std::array<V, N>& x, const std::array<double, C>& c) {
  std::array<V, N> square, high, low;
  each<N>([&](auto i) ETENDUE_INLINE_LAMBDA {
    square[i] = hn::Mul(x[i], x[i]);
    high[i] = number(d, c[C - 1]);
    low[i] = number(d, c[C - 2]);
  });
  each<C - 2>([&](auto k) ETENDUE_INLINE_LAMBDA {
    const V next = number(d, c[C - 3 - k]);
    each<N>([&](auto i) ETENDUE_INLINE_LAMBDA {
      if constexpr (k % 2 == 0)
        high[i] = hn::MulAdd(high[i], square[i], next);
      else
        low[i] = hn::MulAdd(low[i], square[i], next);
    });
  });
  each<N>([&](auto i) ETENDUE_INLINE_LAMBDA {
    if constexpr (C % 2 == 0)
      high[i] = hn::MulAdd(high[i], x[i], low[i]);
    else
      high[i] = hn::MulAdd(low[i], x[i], high[i]);
  });
  return high;
}

// (atan(q) / q - 1) / q^2 as a polynomial in z = q^2, q <= tan(22.5 deg), such that atan(q) has a relative error below 1.3e-9 in floats,
// and of the series' 18 terms (below 1e-15) in doubles.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V atan_rest(D d, V z) {
  if constexpr (in_floats<D>) {
    return polynomial(d, z, std::array{-0.33333308, 0.19998182, -0.14239533, 0.10569829, -0.060263049});
  } else {
    constexpr auto series = [] {
      std::array<double, 18> c{};
      for (std::size_t i = 0; i < c.size(); ++i) c[i] = (i % 2 == 0 ? -1.0 : 1.0) / static_cast<double>(2 * i + 3);
      return c;
    }();
    return polynomial(d, z, series);
  }
}

// The angle of (x, y), y >= 0: 0 to pi, with a relative error of a few roundings; 0 for (0, 0).
template <class D, class V = hn::Vec<D>>
HWY_INLINE V angle_of(D d, V y, V x) {
  const V ax = hn::Abs(x), longer = hn::Max(ax, y), shorter = hn::Min(ax, y), zero = hn::Zero(d);
  const auto far = hn::Gt(shorter, hn::Mul(number(d, 0.41421356237309503), longer));
  const V numerator = hn::Sub(shorter, hn::IfThenElseZero(far, longer)), denominator = hn::Add(longer, hn::IfThenElseZero(far, shorter));
  const V q = hn::IfThenElseZero(hn::Gt(denominator, zero), hn::Div(numerator, denominator)), z = hn::Mul(q, q);
  const V octant = hn::Add(hn::MulAdd(hn::Mul(atan_rest(d, z), z), q, q), hn::IfThenElseZero(far, number(d, pi / 4)));
  const V quadrant = hn::IfThenElse(hn::Gt(y, ax), hn::Sub(number(d, pi / 2), octant), octant);
  return hn::IfThenElse(hn::Lt(x, zero), hn::Sub(number(d, pi), quadrant), quadrant);
}

// A cap of directions, half angle sigma, that the horizon cuts: |up| < sin(sigma). With u = up, s and c the sine and cosine of sigma, phi
// half the angle of the circle's part above and psi half the angle of the horizon's part below the cap, the integral of half b x db gives
//     phi s^2 u - c q + psi,   q = sqrt(s^2 - u^2), phi = angle(-c u, q), psi = atan(k), k = q / c,
// and with c q = c^2 k = k - s^2 k it is s^2 (phi u + k) - (k - atan k), whose terms are no larger than the result's order s^3.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V cut_cap(D d, V up, V s, V c) {
  const V zero = hn::Zero(d), s2 = hn::Mul(s, s), q = hn::Sqrt(hn::Max(hn::Mul(hn::Sub(s, up), hn::Add(s, up)), zero));
  const V phi = angle_of(d, q, hn::Neg(hn::Mul(c, up)));
  // atan k in eighths of a turn, as angle_of() has it.
  const V longer = hn::Max(q, c), shorter = hn::Min(q, c), tan_eighth = number(d, 0.41421356237309503);
  const auto low = hn::Lt(q, hn::Mul(c, tan_eighth)), middle = hn::Gt(shorter, hn::Mul(longer, tan_eighth));
  const V over = hn::IfThenElse(middle, hn::Sub(q, c), hn::IfThenElse(low, q, hn::Neg(c)));
  const V x = hn::Div(over, hn::IfThenElse(middle, hn::Add(q, c), longer)), z = hn::Mul(x, x);
  const V rest = hn::Mul(hn::Mul(atan_rest(d, z), z), x), lit = hn::Mul(s2, phi);
  const V narrow = hn::MulAdd(s2, hn::MulAdd(phi, up, x), rest);
  const V from = hn::IfThenElse(middle, number(d, pi / 4), number(d, pi / 2));
  const V wide = hn::Add(hn::Add(hn::MulSub(lit, up, hn::Mul(c, q)), from), hn::Add(x, rest));
  return hn::Max(hn::IfThenElse(low, narrow, wide), zero);
}

// ln(more / less), more >= less > 0, `difference` between both: with a relative error of a few roundings, whatever is left of either.
// After a power of two is taken out, 2 atanh((f - 1) / (f + 1)) by its series, |f| within sqrt(2) of 1.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V log_ratio(D d, V more, V less, V difference) {
  const hn::RebindToSigned<D> integers;
  constexpr int mantissa = in_floats<D> ? 23 : 52;
  const V smallest = number(d, in_floats<D> ? 1e-30 : 1e-280), root_half = number(d, 0.7071067811865476);
  less = hn::Max(less, smallest);
  const auto exponent = hn::ShiftRight<mantissa>(hn::Sub(hn::BitCast(integers, hn::Div(more, less)), hn::BitCast(integers, root_half)));
  const V power = hn::BitCast(d, hn::Add(hn::ShiftLeft<mantissa>(exponent), hn::BitCast(integers, number(d, 1))));
  const V raised = hn::Mul(power, less);
  const V x = hn::Div(hn::NegMulAdd(hn::Sub(power, number(d, 1)), less, difference), hn::Add(more, raised)), z = hn::Mul(x, x);
  constexpr auto series = [] {
    std::array<double, in_floats<D> ? 5 : 12> c{};
    for (std::size_t i = 0; i < c.size(); ++i) c[i] = 2.0 / static_cast<double>(2 * i + 1);
    return c;
  }();
  return hn::MulAdd(hn::ConvertTo(d, exponent), number(d, 0.6931471805599453), hn::Mul(x, polynomial(d, z, series)));
}

template <class V>
struct Point {
  Vector<V> position, normal;  // in the light's unit; of length 1
};
template <class D, class V = hn::Vec<D>>
HWY_INLINE V away(D d, const Coordinate& c, V p) {
  if constexpr (in_floats<D>)
    return hn::Add(hn::Sub(hn::Set(d, c.high), p), hn::Set(d, c.low));
  else
    return hn::Sub(hn::Set(d, c.whole), p);
}
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vector<V> towards(D d, const Place& place, const Vector<V>& position) {
  return {away(d, place.x, position.x), away(d, place.y, position.y), away(d, place.z, position.z)};
}

// 0 where all is finite: no number less itself is zero, and neither is infinity.
template <class V>
HWY_INLINE V less_itself(const Vector<V>& a, const Vector<V>& b) {
  const auto part = [](const Vector<V>& v)
                        ETENDUE_INLINE_LAMBDA { return hn::Add(hn::Add(hn::Sub(v.x, v.x), hn::Sub(v.y, v.y)), hn::Sub(v.z, v.z)); };
  return hn::Add(part(a), part(b));
}

// Coordinates whose squares are out of range are infinitely far: no light.
template <class D, class V>
HWY_INLINE V sane(D d, V value, double bound) {
  return hn::IfThenElseZero(hn::Lt(value, number(d, bound)), value);
}

// Points at a time: what a kernel refuses of them is looked through afterwards, so that nothing waits for the last of a lane's steps.
inline constexpr std::size_t block = 1024;

// The lanes that a kernel refuses, as bits.
template <class D>
class Marks {
 public:
  HWY_INLINE void set(D d, hn::Mask<D> marked, std::size_t vector) { hn::StoreMaskBits(d, marked, bits_.data() + vector * bytes(d)); }
  // The number of each marked lane of as many vectors, which are `indices` then. How many.
  std::size_t list(D d, std::size_t vectors, std::array<std::uint16_t, block>& indices) {
    const std::size_t end = vectors * bytes(d), of_byte = std::min<std::size_t>(hn::Lanes(d), 8);
    std::fill_n(bits_.begin() + end, word, std::uint8_t{0});
    std::size_t count = 0;
    for (std::size_t at = 0; at < end; at += word) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, bits_.data() + at, word);
      for (; bits != 0; bits &= bits - 1) {
        const auto bit = static_cast<std::size_t>(std::countr_zero(bits));
        indices[count++] = static_cast<std::uint16_t>((at + bit / 8) * of_byte + bit % 8);
      }
    }
    return count;
  }

 private:
  static constexpr std::size_t word = sizeof(std::uint64_t);
  static std::size_t bytes(D d) { return (hn::Lanes(d) + 7) / 8; }
  std::array<std::uint8_t, block + word> bits_;
};

// Points that floats are not enough for, evaluated in vectors of doubles, and what those refuse one by one. How many are not finite.
template <class Kernel>
std::size_t in_doubles(const Emitter& white, double scale, const PointBatch& points, std::size_t first,
                       std::span<const std::uint16_t> indices, std::span<float> out, float where_none, Kernel kernel, double bound) {
  const hn::ScalableTag<double> d;
  using V = hn::Vec<decltype(d)>;
  const std::size_t lanes = hn::Lanes(d);
  const hn::Rebind<float, decltype(d)> floats;
  const std::array<const float*, 6> in{points.px.data(), points.py.data(), points.pz.data(),
                                       points.nx.data(), points.ny.data(), points.nz.data()};
  HWY_ALIGN std::array<std::array<float, block>, 6> at;
  for (std::size_t c = 0; c < 6; ++c) {
    for (std::size_t i = 0; i < indices.size(); ++i) at[c][i] = in[c][first + indices[i]];
    std::fill_n(at[c].begin() + indices.size(), (lanes - indices.size() % lanes) % lanes, 1.0f);
  }
  HWY_ALIGN std::array<float, hn::MaxLanes(d)> values;
  HWY_ALIGN std::array<double, hn::MaxLanes(d)> refused;
  const V unit = hn::Set(d, scale);
  std::size_t not_finite = 0;
  for (std::size_t i = 0; i < indices.size(); i += lanes) {
    const auto part = [&](std::size_t c) { return hn::PromoteTo(d, hn::Load(floats, at[c].data() + i)); };
    const Vector<V> position{part(0), part(1), part(2)};
    Vector<V> normal{part(3), part(4), part(5)};
    const V nothing = less_itself(position, normal);
    if constexpr (!requires { Kernel::linear_in_normal; }) {
      // A float's rounding of the normal's length counts where the terms cancel.
      const V inverse = inverse_root(d, dot(normal, normal));
      normal = {hn::Mul(normal.x, inverse), hn::Mul(normal.y, inverse), hn::Mul(normal.z, inverse)};
    }
    auto marked = hn::FirstN(d, 0);
    const V value = kernel(d, Point<V>{{hn::Mul(position.x, unit), hn::Mul(position.y, unit), hn::Mul(position.z, unit)}, normal}, marked);
    hn::Store(hn::DemoteTo(floats, sane(d, value, bound)), floats, values.data());
    const std::size_t number = std::min(lanes, indices.size() - i);
    for (std::size_t k = 0; k < number; ++k) out[first + indices[i + k]] = values[k];
    const auto finite = hn::Eq(nothing, hn::Zero(d));
    if (HWY_LIKELY(hn::AllTrue(d, hn::AndNot(marked, finite)))) continue;
    hn::Store(hn::IfThenElse(finite, hn::IfThenElseZero(marked, hn::Set(d, 1.0)), hn::Set(d, -1.0)), d, refused.data());
    for (std::size_t k = 0; k < number; ++k) {
      const std::size_t to = first + indices[i + k];
      if (refused[k] > 0) out[to] = in_double(white, points, to);
      if (refused[k] < 0) out[to] = where_none, ++not_finite;
    }
  }
  return not_finite;
}

// kernel(d, point, mask&), inlined, gives the value of every lane, in floats and in doubles, and marks the lanes that it refuses: those of
// a point that is not finite among them if it says so (refuses_not_finite). `scale`: the light's units a metre. No value reaches `bound`.
// How many points are not finite; they become `where_none`.
template <class Kernel>
HWY_INLINE std::size_t at_every_point(const Emitter& white, double scale, const PointBatch& points, std::span<float> out, float where_none,
                                      Kernel kernel, double bound = 4) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  const std::size_t lanes = hn::Lanes(d);
  const V unit = hn::Set(d, static_cast<float>(scale));
  Marks<decltype(d)> marks;
  std::array<std::uint16_t, block> indices;
  HWY_ALIGN std::array<std::array<float, hn::MaxLanes(d)>, 7> last;
  std::size_t without = 0;
  for (std::size_t first = 0; first < out.size();) {
    const std::size_t left = out.size() - first, whole = std::min(left - left % lanes, block), count = whole > 0 ? whole : left;
    std::array<const float*, 6> in{points.px.data(), points.py.data(), points.pz.data(),
                                   points.nx.data(), points.ny.data(), points.nz.data()};
    for (const float*& from : in) from += first;
    float* to = out.data() + first;
    if (whole == 0) {
      // The last points stand in a vector of their own.
      for (std::size_t k = 0; k < 6; ++k) {
        std::fill_n(last[k].begin(), lanes, 1.0f);
        std::copy_n(in[k], count, last[k].begin());
        in[k] = last[k].data();
      }
      to = last[6].data();
    }
    for (std::size_t i = 0, vector = 0; i < count; i += lanes, ++vector) {
      const Vector<V> position{hn::LoadU(d, in[0] + i), hn::LoadU(d, in[1] + i), hn::LoadU(d, in[2] + i)};
      const Vector<V> normal{hn::LoadU(d, in[3] + i), hn::LoadU(d, in[4] + i), hn::LoadU(d, in[5] + i)};
      auto marked = hn::FirstN(d, 0);
      const Point<V> point{{hn::Mul(position.x, unit), hn::Mul(position.y, unit), hn::Mul(position.z, unit)}, normal};
      V value = sane(d, kernel(d, point, marked), bound);
      if constexpr (!requires { Kernel::refuses_not_finite; })
        marked = hn::Or(marked, hn::Not(hn::Eq(less_itself(position, normal), hn::Zero(d))));
      hn::StoreU(value, d, to + i);
      marks.set(d, marked, vector);
    }
    if (whole == 0) std::copy_n(last[6].begin(), count, out.data() + first);
    std::size_t doubtful = marks.list(d, (count + lanes - 1) / lanes, indices);
    while (doubtful > 0 && indices[doubtful - 1] >= count) --doubtful;
    if (doubtful > 0)
      without += in_doubles(white, scale, points, first, std::span(indices.data(), doubtful), out, where_none, kernel, bound);
    first += count;
  }
  return without;
}

}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
