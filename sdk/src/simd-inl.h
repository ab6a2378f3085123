// What kernels share: a loop over whole vectors, and powers and logarithms to the base two. Compiled once for each instruction set: include
// it in a kernel's file after HWY_TARGET_INCLUDE and hwy/foreach_target.h, as batch_exposure.cpp does.
#if defined(ETENDUE_SIMD_INL_H) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard, once an instruction set
#ifdef ETENDUE_SIMD_INL_H
#undef ETENDUE_SIMD_INL_H
#else
#define ETENDUE_SIMD_INL_H
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace etendue::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// body(in, out) for each vector of elements, of which `In` numbers are read and `Out` are written each (interleaved). What is left at the
// end goes through a vector of its own, filled up with `padding`, which should be a number that the body does not count. In place is
// allowed where In = Out.
template <std::size_t In, std::size_t Out, class D, class TI, class TO, class Body>
HWY_INLINE void for_each_vector(D d, const TI* in, TO* out, std::size_t count, TI padding, Body body) {
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + 4 * lanes <= count; i += 4 * lanes)
    for (std::size_t j = i; j < i + 4 * lanes; j += lanes) body(in + j * In, out + j * Out);
  for (; i + lanes <= count; i += lanes) body(in + i * In, out + i * Out);
  if (i == count) return;
  HWY_ALIGN TI last_in[In * hn::MaxLanes(d)];
  HWY_ALIGN TO last_out[Out * hn::MaxLanes(d)];
  std::fill_n(last_in, In * lanes, padding);
  std::copy(in + i * In, in + count * In, last_in);
  body(last_in, last_out);
  std::copy(last_out, last_out + (count - i) * Out, out + i * Out);
}

// Stores r0 g0 b0 r1 g1 b1 ...: number p of them, channel p % 3 of pixel p / 3, is lane p % N of vector p / N. As 3 divides no N, no two
// pixels' reds meet in a lane, nor their greens or blues: each channel is put in order once, for all three vectors. (Highway's
// StoreInterleaved3 takes eight times as long with AVX-512.)
template <class D>
class StoreThree {
 public:
  explicit StoreThree(D d) {
    const hn::RebindToSigned<D> di;
    const std::size_t lanes = hn::Lanes(d);
    HWY_ALIGN std::int32_t pixels[3][hn::MaxLanes(d)], channels[3][hn::MaxLanes(d)];
    for (std::size_t p = 0; p < 3 * lanes; ++p) {
      pixels[p % 3][p % lanes] = static_cast<std::int32_t>(p / 3);
      channels[p / lanes][p % lanes] = static_cast<std::int32_t>(p % 3);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      pixel_[k] = hn::Load(di, pixels[k]);
      channel_[k] = hn::Load(di, channels[k]);
    }
  }
  template <class V>
  HWY_INLINE void operator()(D d, V r, V g, V b, float* to) const {
    const hn::RebindToSigned<D> di;
    const V red = hn::TableLookupLanes(r, hn::IndicesFromVec(d, pixel_[0])),
            green = hn::TableLookupLanes(g, hn::IndicesFromVec(d, pixel_[1])),
            blue = hn::TableLookupLanes(b, hn::IndicesFromVec(d, pixel_[2]));
    for (std::size_t k = 0; k < 3; ++k) {
      const auto is_red = hn::RebindMask(d, hn::Eq(channel_[k], hn::Zero(di))),
                 is_blue = hn::RebindMask(d, hn::Eq(channel_[k], hn::Set(di, 2)));
      hn::StoreU(hn::IfThenElse(is_blue, blue, hn::IfThenElse(is_red, red, green)), d, to + k * hn::Lanes(d));
    }
  }

 private:
  hn::Vec<hn::RebindToSigned<D>> pixel_[3], channel_[3];
};

// x within limits; NaN stays NaN. Highway leaves it open what Min and Max make of NaN; x86's return their second operand then, at half the
// price of comparisons.
template <class V>
HWY_INLINE V held_within(V low, V x, V high) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
  return hn::Max(low, hn::Min(high, x));
#else
  const V held = hn::IfThenElse(hn::Gt(x, high), high, x);
  return hn::IfThenElse(hn::Lt(held, low), low, held);
#endif
}

// factor 2^(whole + f), factor positive, whole an integer, |f| <= .6, the result a normal float. 2^f is the polynomial of sixth degree with
// 2^0 = 1 that is nearest over |f| <= 1/2, to a relative 2e-9; with its roundings, relative error <= 2e-7, none where f = 0. A whole number
// of powers of two is added to the exponent's bits.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V exp2_of(D d, V whole, V f, V factor) {
  const hn::RebindToSigned<D> di;
  V p = hn::Set(d, 1.53533616e-4f);
  p = hn::MulAdd(p, f, hn::Set(d, 1.33988744e-3f));
  p = hn::MulAdd(p, f, hn::Set(d, 9.61843736e-3f));
  p = hn::MulAdd(p, f, hn::Set(d, 5.55033247e-2f));
  p = hn::MulAdd(p, f, hn::Set(d, 2.40226479e-1f));
  p = hn::MulAdd(p, f, hn::Set(d, 6.93147203e-1f));
  p = hn::MulAdd(p, f, hn::Set(d, 1.0f));
  return hn::BitCast(d, hn::Add(hn::BitCast(di, hn::Mul(p, factor)), hn::ShiftLeft<23>(hn::ConvertTo(di, whole))));
}

// log2(x) as whole + fraction, |fraction| <= 1/2, of positive finite floats that are no subnormals. x = 2^e m, m in [sqrt(1/2), sqrt(2)),
// and log2(m) = 2/ln 2 (z + z^3/3 + z^5/5 + z^7/7 + z^9/9), z = (m - 1)/(m + 1), |z| <= .1716: the next term is 1e-9. Absolute error of the
// fraction <= 6e-8.
template <class V>
struct Log2Parts {
  V whole, fraction;
};
inline constexpr float least_normal = 1.17549435e-38f;
template <class D, class V = hn::Vec<D>>
HWY_INLINE Log2Parts<V> log2_of_normal(D d, V x) {
  const hn::RebindToSigned<D> di;
  const auto bits = hn::BitCast(di, x);
  const auto e = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(di, 0x3f3504f3)));  // the bits of sqrt(1/2)
  const V m = hn::BitCast(d, hn::Sub(bits, hn::ShiftLeft<23>(e)));
  const V one = hn::Set(d, 1.0f);
  const V z = hn::Div(hn::Sub(m, one), hn::Add(m, one));
  const V squared = hn::Mul(z, z);
  V p = hn::Set(d, 0.32059890f);                        // 2 / (9 ln 2)
  p = hn::MulAdd(p, squared, hn::Set(d, 0.41219858f));  // 2 / (7 ln 2)
  p = hn::MulAdd(p, squared, hn::Set(d, 0.57707802f));  // 2 / (5 ln 2)
  p = hn::MulAdd(p, squared, hn::Set(d, 0.96179669f));  // 2 / (3 ln 2)
  p = hn::MulAdd(p, squared, hn::Set(d, 2.8853901f));   // 2 / ln 2
  return {hn::ConvertTo(d, e), hn::Mul(p, z)};
}
// The same of subnormals as well: they are scaled by 2^24 first.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Log2Parts<V> log2_of(D d, V x) {
  const auto small = hn::Lt(x, hn::Set(d, least_normal));
  Log2Parts<V> log = log2_of_normal(d, hn::IfThenElse(small, hn::Mul(x, hn::Set(d, 16777216.0f)), x));
  log.whole = hn::Add(log.whole, hn::IfThenElseZero(small, hn::Set(d, -24.0f)));
  return log;
}

// x^e = 2^(e log2 x) of positive finite x, for results within normal floats, else one near the nearest of these. e = high + low, high of 14
// bits, so that its product with a logarithm's whole part is exact and the error stays that of the fraction: relative <= 4e-7 for 0 < e
// <= 2.4.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V power_of(D d, V x, double e) {
  constexpr double bits = 4096;
  const auto high = static_cast<float>(static_cast<int>(e * bits) / bits), low = static_cast<float>(e - high);
  const auto log = log2_of(d, x);
  const V product = hn::Mul(log.whole, hn::Set(d, high));
  const V sum = hn::MulAdd(log.fraction, hn::Set(d, high), product);
  const V whole = hn::Round(hn::Min(hn::Max(sum, hn::Set(d, -125.0f)), hn::Set(d, 127.0f)));
  const V rest =
      hn::MulAdd(log.fraction, hn::Set(d, static_cast<float>(e)), hn::MulAdd(log.whole, hn::Set(d, low), hn::Sub(product, whole)));
  return exp2_of(d, whole, hn::Min(hn::Max(rest, hn::Set(d, -0.6f)), hn::Set(d, 0.6f)), hn::Set(d, 1.0f));
}

}  // namespace etendue::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif  // include guard
