// Spans of half, R11G11B10F, RGB9E5 and RGBE, compiled for every instruction set and chosen at run time (Highway).
// Integer arithmetic on the bits of floats gives the codes that pixel.cpp defines, without an exception: each step below is exact or rounds
// as the definition does.
#include "etendue/pixel.h"

#include <fmt/format.h>

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pixel_batch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace etendue {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::ScalableTag<float>;
using U = hn::RebindToUnsigned<F>;
using I = hn::RebindToSigned<F>;
using VF = hn::Vec<F>;
using VU = hn::Vec<U>;

HWY_INLINE VF power_of_two(VU biased_exponent) { return hn::BitCast(F(), hn::ShiftLeft<23>(biased_exponent)); }
HWY_INLINE VU truncated(VF x) { return hn::BitCast(U(), hn::ConvertTo(I(), x)); }

// Floats from 0 to `largest` are those whose bits, as a whole number, are at most its bits: negative ones and NaN are above.
HWY_INLINE bool all_within(VU bits, float largest) {
  const U u;
  return HWY_LIKELY(hn::AllFalse(u, hn::Gt(bits, hn::BitCast(u, hn::Set(F(), largest)))));
}
// What is stored of channels that are not all within 0 and `largest`, with their counts. Minus zero is zero.
HWY_INLINE VF admitted(VF x, float largest, PackCounts& counts) {
  const F f;
  const VF zero = hn::Zero(f), most = hn::Set(f, largest);
  counts.nan += hn::CountTrue(f, hn::Not(hn::Eq(x, x)));  // Ne is false of NaN on some
  counts.negative += hn::CountTrue(f, hn::Lt(x, zero));
  counts.overflow += hn::CountTrue(f, hn::Gt(x, most));
  return hn::Min(hn::IfThenElseZero(hn::Gt(x, zero), x), most);  // NaN is not above zero
}

struct Pixel {
  VF r, g, b;
  HWY_INLINE VU brightest_bits() const {
    const U u;
    return hn::Max(hn::Max(hn::BitCast(u, r), hn::BitCast(u, g)), hn::BitCast(u, b));
  }
};
HWY_INLINE Pixel load(const Vec3f* from) {
  Pixel p;
  hn::LoadInterleaved3(F(), &from->x, p.r, p.g, p.b);
  return p;
}

// x from 0 to the largest finite number of a float with 5 bits of exponent and M of mantissa. Above 2^-14: adding half a unit of the last
// place that stays, less one bit if that is even, carries where nearest-even rounds up; exponents are biased by 127 and 15. Below: in
// x + 2^(9 - M) a unit of the last place is that of these numbers, and the adder rounds to nearest-even.
template <int M>
HWY_INLINE VU pack_small_float(VF x) {
  const F f;
  const U u;
  constexpr int shift = 23 - M;
  const VU bits = hn::BitCast(u, x);
  const VU odd = hn::And(hn::ShiftRight<shift>(bits), hn::Set(u, 1));
  const VU rounded = hn::ShiftRight<shift>(hn::Add(hn::Add(bits, hn::Set(u, (1U << (shift - 1)) - 1)), odd));
  const VU above = hn::Sub(rounded, hn::Set(u, 112U << M));
  const VF magic = power_of_two(hn::Set(u, 127 + 9 - M));
  const VU below = hn::Sub(hn::BitCast(u, hn::Add(x, magic)), hn::BitCast(u, magic));
  return hn::IfThenElse(hn::RebindMask(u, hn::Lt(x, hn::Set(f, 0x1p-14F))), below, above);
}

// The inverse. Numbers without hidden bit are whole multiples of 2^(-14 - M); exponent 31 becomes 255, infinity and NaN.
template <int M>
HWY_INLINE VF unpack_small_float(VU code) {
  const F f;
  const U u;
  const VU exponent = hn::ShiftRight<M>(code);
  const VU moved = hn::ShiftLeft<23 - M>(code);
  const VU finite = hn::Add(moved, hn::Set(u, 112U << 23));
  const VU special = hn::Or(moved, hn::Set(u, 255U << 23));
  const VF normal = hn::BitCast(f, hn::IfThenElse(hn::Eq(exponent, hn::Set(u, 31)), special, finite));
  const VF denormal = hn::Mul(hn::ConvertTo(f, hn::BitCast(I(), code)), power_of_two(hn::Set(u, 127 - 14 - M)));
  return hn::IfThenElse(hn::RebindMask(f, hn::Eq(exponent, hn::Zero(u))), denormal, normal);
}

// Runs `vector` on as many elements as fill whole vectors and `scalar` on the rest, by index.
template <class Vector, class Scalar>
HWY_INLINE void each(std::size_t count, Vector vector, Scalar scalar) {
  const std::size_t lanes = hn::Lanes(F());
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) vector(i);
  for (; i < count; ++i) scalar(i);
}

static_assert(sizeof(Vec3f) == 12 && sizeof(Bytes4) == 4);

PackCounts pack_half(const float* from, std::uint16_t* to, std::size_t count) {
  PackCounts counts;
  const F f;
  const U u;
  const hn::Rebind<std::uint16_t, F> u16;
  each(
      count,
      [&](std::size_t i) HWY_ATTR {
        const VF x = hn::LoadU(f, from + i);
        VU sign = hn::And(hn::BitCast(u, x), hn::Set(u, 0x80000000U));
        VF magnitude = hn::Abs(x);
        const VF most = hn::Set(f, 65504);
        if (HWY_UNLIKELY(!hn::AllTrue(f, hn::Le(magnitude, most)))) {
          const auto number = hn::Eq(x, x);
          counts.nan += hn::CountTrue(f, hn::Not(number));
          counts.overflow += hn::CountTrue(f, hn::Gt(magnitude, most));
          sign = hn::IfThenElseZero(hn::RebindMask(u, number), sign);
          magnitude = hn::Min(hn::IfThenElseZero(number, magnitude), most);
        }
        const VU code = hn::Or(pack_small_float<10>(magnitude), hn::ShiftRight<16>(sign));
        hn::StoreU(hn::DemoteTo(u16, hn::BitCast(I(), code)), u16, to + i);
      },
      [&](std::size_t i) { to[i] = etendue::pack_half(from[i], counts); });
  return counts;
}
void unpack_half(const std::uint16_t* from, float* to, std::size_t count) {
  const F f;
  const U u;
  const hn::Rebind<std::uint16_t, F> u16;
  each(
      count,
      [&](std::size_t i) HWY_ATTR {
        const VU code = hn::PromoteTo(u, hn::LoadU(u16, from + i));
        const VU sign = hn::ShiftLeft<16>(hn::And(code, hn::Set(u, 0x8000)));
        const VF magnitude = unpack_small_float<10>(hn::And(code, hn::Set(u, 0x7fff)));
        hn::StoreU(hn::BitCast(f, hn::Or(hn::BitCast(u, magnitude), sign)), f, to + i);
      },
      [&](std::size_t i) { to[i] = static_cast<float>(etendue::unpack_half(from[i])); });
}

PackCounts pack_r11g11b10f(const Vec3f* from, std::uint32_t* to, std::size_t count) {
  PackCounts counts;
  each(
      count,
      [&](std::size_t i) HWY_ATTR {
        Pixel p = load(from + i);
        if (!all_within(hn::Max(hn::BitCast(U(), p.r), hn::BitCast(U(), p.g)), 65024) || !all_within(hn::BitCast(U(), p.b), 64512))
          p = {admitted(p.r, 65024, counts), admitted(p.g, 65024, counts), admitted(p.b, 64512, counts)};
        const VU red = pack_small_float<6>(p.r), green = pack_small_float<6>(p.g), blue = pack_small_float<5>(p.b);
        hn::StoreU(hn::Or(hn::Or(red, hn::ShiftLeft<11>(green)), hn::ShiftLeft<22>(blue)), U(), to + i);
      },
      [&](std::size_t i) { to[i] = etendue::pack_r11g11b10f(vec_cast<double>(from[i]), counts); });
  return counts;
}
void unpack_r11g11b10f(const std::uint32_t* from, Vec3f* to, std::size_t count) {
  const U u;
  each(
      count,
      [&](std::size_t i) HWY_ATTR {
        const VU code = hn::LoadU(u, from + i), low = hn::Set(u, 0x7ff);
        hn::StoreInterleaved3(unpack_small_float<6>(hn::And(code, low)), unpack_small_float<6>(hn::And(hn::ShiftRight<11>(code), low)),
                              unpack_small_float<5>(hn::ShiftRight<22>(code)), F(), &to[i].x);
      },
      [&](std::size_t i) { to[i] = vec_cast<float>(etendue::unpack_r11g11b10f(from[i])); });
}

// Rounding the brightest channel to 9 bits, half up, is adding 2^14 to its bits, which steps the exponent where it comes to 512. A mantissa
// floor(x + 1/2) is (floor(2 x) + 1) / 2, so that no sum is rounded: .5 - 2^-25 plus .5 would be.
PackCounts pack_rgb9e5(const Vec3f* from, std::uint32_t* to, std::size_t count) {
  PackCounts counts;
  const U u;
  each(
      count,
      [&](std::size_t i) HWY_ATTR {
        Pixel p = load(from + i);
        VU brightest = p.brightest_bits();
        if (!all_within(brightest, 65408)) {
          p = {admitted(p.r, 65408, counts), admitted(p.g, 65408, counts), admitted(p.b, 65408, counts)};
          brightest = p.brightest_bits();
        }
        const VU biased = hn::ShiftRight<23>(hn::Add(brightest, hn::Set(u, 1U << 14)));
        const VU exponent = hn::Sub(hn::Max(biased, hn::Set(u, 127 - 16)), hn::Set(u, 127 - 16));
        const VF twice_scale = power_of_two(hn::Sub(hn::Set(u, 127 + 25), exponent));
        const auto mantissa = [&](VF x) HWY_ATTR { return hn::ShiftRight<1>(hn::Add(truncated(hn::Mul(x, twice_scale)), hn::Set(u, 1))); };
        const VU red_green = hn::Or(mantissa(p.r), hn::ShiftLeft<9>(mantissa(p.g)));
        hn::StoreU(hn::Or(red_green, hn::Or(hn::ShiftLeft<18>(mantissa(p.b)), hn::ShiftLeft<27>(exponent))), u, to + i);
      },
      [&](std::size_t i) { to[i] = etendue::pack_rgb9e5(vec_cast<double>(from[i]), counts); });
  return counts;
}
void unpack_rgb9e5(const std::uint32_t* from, Vec3f* to, std::size_t count) {
  const F f;
  const U u;
  each(
      count,
      [&](std::size_t i) HWY_ATTR {
        const VU code = hn::LoadU(u, from + i);
        const VF unit = power_of_two(hn::Add(hn::ShiftRight<27>(code), hn::Set(u, 127 - 24)));
        const auto channel = [&](VU shifted) HWY_ATTR {
          return hn::Mul(hn::ConvertTo(f, hn::BitCast(I(), hn::And(shifted, hn::Set(u, 0x1ff)))), unit);
        };
        hn::StoreInterleaved3(channel(code), channel(hn::ShiftRight<9>(code)), channel(hn::ShiftRight<18>(code)), f, &to[i].x);
      },
      [&](std::size_t i) { to[i] = vec_cast<float>(etendue::unpack_rgb9e5(from[i])); });
}

// With the biased exponent B of the brightest channel, its e is B - 126, and mantissas are floor(c 2^(8 - e)). 2^(8 - e) is a normal float
// for B from 9 to 253; darker pixels than that, black ones apart, go one by one.
PackCounts pack_rgbe(const Vec3f* from, Bytes4* to, std::size_t count) {
  PackCounts counts;
  const U u;
  const float below_limit = 0x1.fffffep126F;
  const auto one = [&](std::size_t i) { to[i] = etendue::pack_rgbe(vec_cast<double>(from[i]), counts); };
  each(
      count,
      [&](std::size_t i) HWY_ATTR {
        Pixel p = load(from + i);
        PackCounts here;
        VU brightest = p.brightest_bits();
        if (!all_within(brightest, below_limit)) {
          p = {admitted(p.r, below_limit, here), admitted(p.g, below_limit, here), admitted(p.b, below_limit, here)};
          brightest = p.brightest_bits();
        }
        const VU biased = hn::ShiftRight<23>(brightest);
        const auto lit = hn::Gt(brightest, hn::Zero(u));
        if (HWY_UNLIKELY(!hn::AllFalse(u, hn::And(lit, hn::Lt(biased, hn::Set(u, 9)))))) {
          for (std::size_t lane = 0; lane < hn::Lanes(u); ++lane) one(i + lane);
          return;
        }
        counts += here;
        const VF scale = power_of_two(hn::Sub(hn::Set(u, 261), biased));
        const VU red_green = hn::Or(truncated(hn::Mul(p.r, scale)), hn::ShiftLeft<8>(truncated(hn::Mul(p.g, scale))));
        const VU exponent = hn::Add(biased, hn::Set(u, 2));
        const VU code = hn::Or(red_green, hn::Or(hn::ShiftLeft<16>(truncated(hn::Mul(p.b, scale))), hn::ShiftLeft<24>(exponent)));
        // Lanes hold the lowest byte first, as the machines that have wide instructions do.
        HWY_ALIGN std::uint32_t lanes[hn::MaxLanes(U())];
        hn::Store(hn::IfThenElseZero(lit, code), u, lanes);
        std::memcpy(to + i, lanes, hn::Lanes(u) * sizeof(Bytes4));
      },
      one);
  return counts;
}
// (m + 1/2) 2^(e - 136), by two factors: one alone would not always be a normal float.
void unpack_rgbe(const Bytes4* from, Vec3f* to, std::size_t count) {
  const F f;
  const U u;
  each(
      count,
      [&](std::size_t i) HWY_ATTR {
        HWY_ALIGN std::uint32_t lanes[hn::MaxLanes(U())];
        std::memcpy(lanes, from + i, hn::Lanes(u) * sizeof(Bytes4));
        const VU code = hn::Load(u, lanes);
        const VU e = hn::ShiftRight<24>(code), half = hn::ShiftRight<1>(e);
        const VF first = power_of_two(hn::Add(half, hn::Set(u, 127 - 68))),
                 second = power_of_two(hn::Add(hn::Sub(e, half), hn::Set(u, 127 - 68)));
        const auto lit = hn::RebindMask(f, hn::Gt(e, hn::Zero(u)));
        const auto channel = [&](VU shifted) HWY_ATTR {
          const VF m = hn::ConvertTo(f, hn::BitCast(I(), hn::And(shifted, hn::Set(u, 0xff))));
          return hn::IfThenElseZero(lit, hn::Mul(hn::Mul(hn::Add(m, hn::Set(f, 0.5F)), first), second));
        };
        hn::StoreInterleaved3(channel(code), channel(hn::ShiftRight<8>(code)), channel(hn::ShiftRight<16>(code)), f, &to[i].x);
      },
      [&](std::size_t i) { to[i] = vec_cast<float>(etendue::unpack_rgbe(from[i])); });
}

}  // namespace HWY_NAMESPACE
}  // namespace etendue
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue {
namespace {

HWY_EXPORT(pack_half);
HWY_EXPORT(unpack_half);
HWY_EXPORT(pack_r11g11b10f);
HWY_EXPORT(unpack_r11g11b10f);
HWY_EXPORT(pack_rgb9e5);
HWY_EXPORT(unpack_rgb9e5);
HWY_EXPORT(pack_rgbe);
HWY_EXPORT(unpack_rgbe);

template <class From, class To>
std::optional<Error> lengths_differ(std::span<const From> from, std::span<To> to) {
  if (from.size() == to.size()) return std::nullopt;
  return Error{
      "BATCH_SIZES_DIFFER", fmt::format("expected as many elements out as in, found {} and {}", to.size(), from.size()), {}, {}, {}};
}

}  // namespace

Result<PackCounts> pack_half(std::span<const float> from, std::span<std::uint16_t> to) {
  if (const auto error = lengths_differ(from, to)) return *error;
  return HWY_DYNAMIC_DISPATCH(pack_half)(from.data(), to.data(), from.size());
}
Status unpack_half(std::span<const std::uint16_t> from, std::span<float> to) {
  if (const auto error = lengths_differ(from, to)) return *error;
  HWY_DYNAMIC_DISPATCH(unpack_half)(from.data(), to.data(), from.size());
  return Done{};
}
Result<PackCounts> pack_r11g11b10f(std::span<const Vec3f> from, std::span<std::uint32_t> to) {
  if (const auto error = lengths_differ(from, to)) return *error;
  return HWY_DYNAMIC_DISPATCH(pack_r11g11b10f)(from.data(), to.data(), from.size());
}
Status unpack_r11g11b10f(std::span<const std::uint32_t> from, std::span<Vec3f> to) {
  if (const auto error = lengths_differ(from, to)) return *error;
  HWY_DYNAMIC_DISPATCH(unpack_r11g11b10f)(from.data(), to.data(), from.size());
  return Done{};
}
Result<PackCounts> pack_rgb9e5(std::span<const Vec3f> from, std::span<std::uint32_t> to) {
  if (const auto error = lengths_differ(from, to)) return *error;
  return HWY_DYNAMIC_DISPATCH(pack_rgb9e5)(from.data(), to.data(), from.size());
}
Status unpack_rgb9e5(std::span<const std::uint32_t> from, std::span<Vec3f> to) {
  if (const auto error = lengths_differ(from, to)) return *error;
  HWY_DYNAMIC_DISPATCH(unpack_rgb9e5)(from.data(), to.data(), from.size());
  return Done{};
}
Result<PackCounts> pack_rgbe(std::span<const Vec3f> from, std::span<Bytes4> to) {
  if (const auto error = lengths_differ(from, to)) return *error;
  return HWY_DYNAMIC_DISPATCH(pack_rgbe)(from.data(), to.data(), from.size());
}
Status unpack_rgbe(std::span<const Bytes4> from, std::span<Vec3f> to) {
  if (const auto error = lengths_differ(from, to)) return *error;
  HWY_DYNAMIC_DISPATCH(unpack_rgbe)(from.data(), to.data(), from.size());
  return Done{};
}

}  // namespace etendue
#endif
