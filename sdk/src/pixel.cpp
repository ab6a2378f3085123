// The definitions of the packed formats, in double; spans of those that need no wide instructions.
#include "etendue/pixel.h"

#include "parameter_error.h"

#include "etendue/colour.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

// What is stored of one channel of a format without a sign.
double admitted(double x, double largest, PackCounts& counts) {
  if (std::isnan(x)) return ++counts.nan, 0;
  if (x < 0) return ++counts.negative, 0;
  if (x > largest) return ++counts.overflow, largest;
  return x;
}
Rgb admitted(const Rgb& c, double largest, PackCounts& counts) {
  return {admitted(c.x, largest, counts), admitted(c.y, largest, counts), admitted(c.z, largest, counts)};
}
double brightest(const Rgb& c) { return std::max({c.x, c.y, c.z}); }

// floor(log2 x) of x > 0.
int floor_log2(double x) {
  int e = 0;
  std::frexp(x, &e);
  return e - 1;
}

// 0 <= x <= largest finite number of a float with 5 bits of exponent and m of mantissa. With the exponent e, at least -14, a unit of the
// last place is 2^(e - m); n of them, the hidden bit included, are the code (e + 14) 2^m + n: also where n rounds up to the next power of
// two, and for e = -14, where n < 2^m is a number without hidden bit.
std::uint32_t pack_small_float(double x, int m) {
  const int e = x > 0 ? std::max(floor_log2(x), -14) : -14;
  const double n = std::nearbyint(std::ldexp(x, m - e));
  return (static_cast<std::uint32_t>(e + 14) << m) + static_cast<std::uint32_t>(n);
}
double unpack_small_float(std::uint32_t code, int m) {
  const int exponent = static_cast<int>(code >> m), mantissa = static_cast<int>(code & ((1U << m) - 1));
  if (exponent == 31) return mantissa != 0 ? std::nan("") : HUGE_VAL;
  if (exponent == 0) return std::ldexp(mantissa, -14 - m);
  return std::ldexp(mantissa + (1 << m), exponent - 15 - m);
}

// floor(x + 1/2), whose sum would round up for the double just below 1/2.
double round_half_up(double x) {
  const double whole = std::floor(x);
  return x - whole < 0.5 ? whole : whole + 1;
}
std::uint8_t byte(double x) { return static_cast<std::uint8_t>(x); }
constexpr double white_u = 0.19783, white_v = 0.46834;  // u', v' of D65

}  // namespace

std::uint16_t pack_half(double x, PackCounts& counts) {
  if (std::isnan(x)) return ++counts.nan, 0;
  if (std::fabs(x) > half_max) ++counts.overflow;
  const std::uint32_t magnitude = pack_small_float(std::min(std::fabs(x), half_max), 10);
  return static_cast<std::uint16_t>(magnitude | (std::signbit(x) ? 0x8000U : 0U));
}
double unpack_half(std::uint16_t code) {
  const double magnitude = unpack_small_float(code & 0x7fffU, 10);
  return (code & 0x8000U) != 0 ? -magnitude : magnitude;
}

std::uint32_t pack_r11g11b10f(const Rgb& rgb, PackCounts& counts) {
  return pack_small_float(admitted(rgb.x, r11_max, counts), 6) | pack_small_float(admitted(rgb.y, r11_max, counts), 6) << 11 |
         pack_small_float(admitted(rgb.z, b10_max, counts), 5) << 22;
}
Rgb unpack_r11g11b10f(std::uint32_t code) {
  return {unpack_small_float(code & 0x7ffU, 6), unpack_small_float(code >> 11 & 0x7ffU, 6), unpack_small_float(code >> 22, 5)};
}

// The exponent is stored + 15, and a mantissa of n means n 2^(exponent - 15 - 9). In the extension's words: exp_shared = max(-16,
// floor(log2 max)) + 1 + 15, one more if max then rounds to 512.
std::uint32_t pack_rgb9e5(const Rgb& rgb, PackCounts& counts) {
  const Rgb c = admitted(rgb, rgb9e5_max, counts);
  const double max = brightest(c);
  int exponent = (max > 0 ? std::max(-16, floor_log2(max)) : -16) + 16;
  if (round_half_up(std::ldexp(max, 24 - exponent)) == 512) ++exponent;
  const auto mantissa = [&](double x) { return static_cast<std::uint32_t>(round_half_up(std::ldexp(x, 24 - exponent))); };
  return mantissa(c.x) | mantissa(c.y) << 9 | mantissa(c.z) << 18 | static_cast<std::uint32_t>(exponent) << 27;
}
Rgb unpack_rgb9e5(std::uint32_t code) {
  const int exponent = static_cast<int>(code >> 27) - 24;
  const auto channel = [&](int shift) { return std::ldexp(static_cast<double>(code >> shift & 0x1ffU), exponent); };
  return {channel(0), channel(9), channel(18)};
}

// max = f 2^e with 1/2 <= f < 1: mantissas floor(c 2^(8 - e)) from 128 to 255 for the brightest.
Bytes4 pack_rgbe(const Rgb& rgb, PackCounts& counts) {
  const double below_limit = std::nextafter(rgbe_limit, 0);
  const auto admit = [&](double x) { return x == rgbe_limit ? ++counts.overflow, below_limit : admitted(x, below_limit, counts); };
  const Rgb c{admit(rgb.x), admit(rgb.y), admit(rgb.z)};
  const double max = brightest(c);
  if (max < 0x1p-128) return {0, 0, 0, 0};
  const int e = floor_log2(max) + 1;
  const auto mantissa = [&](double x) { return byte(std::ldexp(x, 8 - e)); };
  return {mantissa(c.x), mantissa(c.y), mantissa(c.z), static_cast<std::uint8_t>(e + 128)};
}
Rgb unpack_rgbe(const Bytes4& code) {
  if (code[3] == 0) return {};
  const auto channel = [&](std::uint8_t m) { return std::ldexp(m + 0.5, code[3] - 128 - 8); };
  return {channel(code[0]), channel(code[1]), channel(code[2])};
}

Bytes4 pack_rgbm(const Rgb& rgb, double range, PackCounts& counts) {
  const Rgb c = admitted(rgb, range, counts) / range;
  const double m = std::ceil(brightest(c) * 255);
  if (m == 0) return {0, 0, 0, 0};
  // c / (m / 255) is at most 1: its 255 levels.
  const auto level = [&](double x) { return byte(std::min(round_half_up(x * 65025 / m), 255.0)); };
  return {level(c.x), level(c.y), level(c.z), byte(m)};
}
Rgb unpack_rgbm(const Bytes4& code, double range) {
  const auto channel = [&](std::uint8_t x) { return range * (x * code[3]) / 65025; };
  return {channel(code[0]), channel(code[1]), channel(code[2])};
}

Bytes4 pack_rgbd(const Rgb& rgb, double range, PackCounts& counts) {
  const Rgb c = admitted(rgb, range, counts) / range;
  const double max = brightest(c);
  const double d = max > 0 ? std::clamp(std::floor(1 / max), 1.0, 255.0) : 255;
  const auto level = [&](double x) { return byte(std::min(round_half_up(x * d * 255), 255.0)); };
  return {level(c.x), level(c.y), level(c.z), byte(d)};
}
Rgb unpack_rgbd(const Bytes4& code, double range) {
  const int d = std::max<int>(code[3], 1);
  const auto channel = [&](std::uint8_t x) { return range * x / (255 * d); };
  return {channel(code[0]), channel(code[1]), channel(code[2])};
}

std::uint32_t pack_logluv(const Rgb& rgb, PackCounts& counts) {
  constexpr double y_limit = 0x1p64;
  double luminance = luminance_of(rgb);
  if (std::isnan(luminance)) return ++counts.nan, 0;
  const std::uint32_t sign = std::signbit(luminance) ? 0x80000000U : 0U;
  luminance = std::fabs(luminance);
  Uv uv{white_u, white_v};
  std::uint32_t level = 0x7fff;
  if (luminance >= y_limit) {
    ++counts.overflow;
  } else {
    if (luminance < 0x1p-64) return 0;
    // Level 0 means black: the darkest 1/256 of a stop is stored as level 1.
    level = static_cast<std::uint32_t>(std::clamp(std::floor(256 * (std::log2(luminance) + 64)), 1.0, 32767.0));
  }
  if (std::isfinite(luminance)) {
    const Uv exact = to_uv1960(to_chromaticity(rgb));
    const Uv in_units{410 * exact.u, 410 * 1.5 * exact.v};
    if (in_units.u >= 0 && in_units.u < 256 && in_units.v >= 0 && in_units.v < 256)
      uv = {exact.u, 1.5 * exact.v};
    else
      ++counts.negative;
  }
  return sign | level << 16 | static_cast<std::uint32_t>(410 * uv.u) << 8 | static_cast<std::uint32_t>(410 * uv.v);
}
Rgb unpack_logluv(std::uint32_t code) {
  const std::uint32_t level = code >> 16 & 0x7fffU;
  if (level == 0) return {};
  const double luminance = std::exp2((level + 0.5) / 256 - 64);
  const Uv uv{((code >> 8 & 0xffU) + 0.5) / 410, ((code & 0xffU) + 0.5) / 410 / 1.5};
  return to_rgb(from_uv1960(uv)) * ((code & 0x80000000U) != 0 ? -luminance : luminance);
}

std::uint32_t pack_rgb10a2(const Rgb& rgb, double alpha, PackCounts& counts) {
  const auto level = [&](double x, double levels) { return static_cast<std::uint32_t>(round_half_up(admitted(x, 1, counts) * levels)); };
  return level(rgb.x, 1023) | level(rgb.y, 1023) << 10 | level(rgb.z, 1023) << 20 | level(alpha, 3) << 30;
}
Rgb unpack_rgb10a2(std::uint32_t code) {
  const auto channel = [&](int shift) { return (code >> shift & 0x3ffU) / 1023.0; };
  return {channel(0), channel(10), channel(20)};
}

namespace {

Error lengths_differ(std::size_t from, std::size_t to) {
  return {"BATCH_SIZES_DIFFER", fmt::format("expected as many elements out as in, found {} and {}", to, from), {}, {}, {}};
}
Error bad_range(double range) {
  return parameter_error("range", "RANGE_INVALID", fmt::format("expected a range above 0 and finite, found {}", range));
}
bool is_range(double range) { return range > 0 && std::isfinite(range); }

template <class From, class To, class Pack>
Result<PackCounts> pack_each(std::span<const From> from, std::span<To> to, Pack pack) {
  if (from.size() != to.size()) return lengths_differ(from.size(), to.size());
  PackCounts counts;
  for (std::size_t i = 0; i < from.size(); ++i) to[i] = pack(vec_cast<double>(from[i]), counts);
  return counts;
}
template <class From, class Unpack>
Status unpack_each(std::span<const From> from, std::span<Vec3f> to, Unpack unpack) {
  if (from.size() != to.size()) return lengths_differ(from.size(), to.size());
  for (std::size_t i = 0; i < from.size(); ++i) to[i] = vec_cast<float>(unpack(from[i]));
  return Done{};
}

}  // namespace

Result<PackCounts> pack_rgbm(std::span<const Vec3f> from, std::span<Bytes4> to, double range) {
  if (!is_range(range)) return bad_range(range);
  return pack_each(from, to, [=](const Rgb& c, PackCounts& counts) { return pack_rgbm(c, range, counts); });
}
Status unpack_rgbm(std::span<const Bytes4> from, std::span<Vec3f> to, double range) {
  if (!is_range(range)) return bad_range(range);
  return unpack_each(from, to, [=](const Bytes4& code) { return unpack_rgbm(code, range); });
}
Result<PackCounts> pack_rgbd(std::span<const Vec3f> from, std::span<Bytes4> to, double range) {
  if (!is_range(range)) return bad_range(range);
  return pack_each(from, to, [=](const Rgb& c, PackCounts& counts) { return pack_rgbd(c, range, counts); });
}
Status unpack_rgbd(std::span<const Bytes4> from, std::span<Vec3f> to, double range) {
  if (!is_range(range)) return bad_range(range);
  return unpack_each(from, to, [=](const Bytes4& code) { return unpack_rgbd(code, range); });
}
Result<PackCounts> pack_logluv(std::span<const Vec3f> from, std::span<std::uint32_t> to) {
  return pack_each(from, to, [](const Rgb& c, PackCounts& counts) { return pack_logluv(c, counts); });
}
Status unpack_logluv(std::span<const std::uint32_t> from, std::span<Vec3f> to) {
  return unpack_each(from, to, [](std::uint32_t code) { return unpack_logluv(code); });
}
Result<PackCounts> pack_rgb10a2(std::span<const Vec3f> from, std::span<std::uint32_t> to) {
  return pack_each(from, to, [](const Rgb& c, PackCounts& counts) { return pack_rgb10a2(c, 1, counts); });
}
Status unpack_rgb10a2(std::span<const std::uint32_t> from, std::span<Vec3f> to) {
  return unpack_each(from, to, [](std::uint32_t code) { return unpack_rgb10a2(code); });
}

}  // namespace etendue
