// Packed pixel formats: what each stores, bit for bit, and what it could not store.
//   PackCounts lost;
//   std::uint32_t code = pack_rgb9e5({1200, 900, 400}, lost);   // lost.overflow counts channels that did not fit
//   auto counts = pack_r11g11b10f(pixels, codes);               // a whole span, on the machine's widest instructions
// The scalars in double define each format; the spans give the same codes bit for bit on every instruction set.
#pragma once

#include "etendue/result.h"
#include "etendue/vec.h"

#include <array>
#include <cstdint>
#include <span>

namespace etendue {

// Channels that a format could not hold. What is stored instead: 0 for NaN, 0 for negative numbers where a format has no sign, the largest
// finite number for everything above it, infinity included (and, where there is a sign, its negative for everything below).
struct PackCounts {
  std::uint64_t nan = 0, negative = 0, overflow = 0;
  std::uint64_t total() const { return nan + negative + overflow; }
  PackCounts& operator+=(const PackCounts& o) { return nan += o.nan, negative += o.negative, overflow += o.overflow, *this; }
  friend bool operator==(const PackCounts&, const PackCounts&) = default;
};

// IEEE 754 binary16, to nearest, ties to even. A NaN or an infinity that a file brings is read as such.
inline constexpr double half_max = 65504;
std::uint16_t pack_half(double x, PackCounts& counts);
double unpack_half(std::uint16_t code);

// R11G11B10F (EXT_packed_float): no sign, 5 bits of exponent as in half, 6, 6 and 5 of mantissa; red in the lowest bits. To nearest, ties
// to even. Blue is rounded twice as coarsely as red and green: grey takes a tint of up to 2.3 %.
inline constexpr double r11_max = 65024, b10_max = 64512;
std::uint32_t pack_r11g11b10f(const Rgb& rgb, PackCounts& counts);
Rgb unpack_r11g11b10f(std::uint32_t code);

// RGB9E5 (EXT_texture_shared_exponent): 9 bits a channel without a hidden one, one exponent of 5; red in the lowest bits, exponent in the
// highest. Rounded as the extension says: half up, in the exponent that the brightest channel has after its own rounding.
inline constexpr double rgb9e5_max = 65408;  // 511/512 2^16
std::uint32_t pack_rgb9e5(const Rgb& rgb, PackCounts& counts);
Rgb unpack_rgb9e5(std::uint32_t code);

// Four bytes in the order in which they stand in a file.
using Bytes4 = std::array<std::uint8_t, 4>;

// RGBE (Ward, Real Pixels, Graphics Gems II; Radiance): mantissas r, g, b and the exponent of the brightest channel + 128. Written by
// flooring, read with a half added, so that the mean error is 0. A pixel whose channels are all below 2^-128 is 0 0 0 0, which reads as
// black. Reading one that was written gives the same code again.
inline constexpr double rgbe_limit = 0x1p127;  // from here on channels overflow
Bytes4 pack_rgbe(const Rgb& rgb, PackCounts& counts);
Rgb unpack_rgbe(const Bytes4& code);

// RGBM (Karis 2009): rgb = range m rgb8, with m rounded up to n/255 so that no channel exceeds 1. `range` > 0 is the largest value.
Bytes4 pack_rgbm(const Rgb& rgb, double range, PackCounts& counts);
Rgb unpack_rgbm(const Bytes4& code, double range);

// RGBD: rgb = range / d rgb8, with d a whole number from 1 to 255, rounded down. More levels where it is dark than RGBM. A d of 0, which is
// never written, is read as 1.
Bytes4 pack_rgbd(const Rgb& rgb, double range, PackCounts& counts);
Rgb unpack_rgbd(const Bytes4& code, double range);

// LogLuv of 32 bits (Larson 1998, TIFF): sign, 15 bits of floor(256 (log2 Y + 64)), 8 bits each of floor(410 u'), floor(410 v'). It holds
// every visible colour, so negative channels are stored; what is counted negative is a chromaticity outside of its 0 to .622, which becomes
// white. Overflow from |Y| = 2^64; |Y| below 2^-64 is black.
std::uint32_t pack_logluv(const Rgb& rgb, PackCounts& counts);
Rgb unpack_logluv(std::uint32_t code);

// 10-10-10-2 unsigned normalised: floor(1023 x + 1/2), alpha floor(3 a + 1/2); red in the lowest bits, alpha in the highest.
std::uint32_t pack_rgb10a2(const Rgb& rgb, double alpha, PackCounts& counts);
Rgb unpack_rgb10a2(std::uint32_t code);

// Spans of equal length; BATCH_SIZES_DIFFER if they are not. Reading rounds the scalar's double to float, which is exact for half,
// R11G11B10F, RGB9E5 and RGBE. RANGE_INVALID unless a range is positive and finite.
Result<PackCounts> pack_half(std::span<const float> from, std::span<std::uint16_t> to);
Status unpack_half(std::span<const std::uint16_t> from, std::span<float> to);
Result<PackCounts> pack_r11g11b10f(std::span<const Vec3f> from, std::span<std::uint32_t> to);
Status unpack_r11g11b10f(std::span<const std::uint32_t> from, std::span<Vec3f> to);
Result<PackCounts> pack_rgb9e5(std::span<const Vec3f> from, std::span<std::uint32_t> to);
Status unpack_rgb9e5(std::span<const std::uint32_t> from, std::span<Vec3f> to);
Result<PackCounts> pack_rgbe(std::span<const Vec3f> from, std::span<Bytes4> to);
Status unpack_rgbe(std::span<const Bytes4> from, std::span<Vec3f> to);
Result<PackCounts> pack_rgbm(std::span<const Vec3f> from, std::span<Bytes4> to, double range);
Status unpack_rgbm(std::span<const Bytes4> from, std::span<Vec3f> to, double range);
Result<PackCounts> pack_rgbd(std::span<const Vec3f> from, std::span<Bytes4> to, double range);
Status unpack_rgbd(std::span<const Bytes4> from, std::span<Vec3f> to, double range);
Result<PackCounts> pack_logluv(std::span<const Vec3f> from, std::span<std::uint32_t> to);
Status unpack_logluv(std::span<const std::uint32_t> from, std::span<Vec3f> to);
Result<PackCounts> pack_rgb10a2(std::span<const Vec3f> from, std::span<std::uint32_t> to);  // alpha 1
Status unpack_rgb10a2(std::span<const std::uint32_t> from, std::span<Vec3f> to);

}  // namespace etendue
