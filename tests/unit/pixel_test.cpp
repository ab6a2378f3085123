#include "etendue/pixel.h"

#include "instruction_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

// Oracles here know the formats as tables of numbers, not as arithmetic on bits: a code is right if its number is the nearest in the
// table (ties to the even code), or what the format's own rule says in exact arithmetic.
namespace etendue {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const double not_a_number = std::nan("");

// The finite numbers of a float with 5 bits of exponent and m of mantissa, in the order of their codes: 0, then 31 octaves of 2^m numbers.
std::vector<double> small_floats(int m) {
  std::vector<double> numbers;
  numbers.reserve(31U << m);
  for (int k = 0; k < 1 << m; ++k) numbers.push_back(k * std::pow(2.0, -14 - m));
  for (int e = -14; e <= 15; ++e)
    for (int k = 0; k < 1 << m; ++k) numbers.push_back((1 + k / std::pow(2.0, m)) * std::pow(2.0, e));
  return numbers;
}
// The code of the nearest one, of two equally near the even one. Differences of doubles this close are exact.
std::uint32_t nearest_even(const std::vector<double>& numbers, double x) {
  const auto above = std::lower_bound(numbers.begin(), numbers.end(), x);
  if (above == numbers.end()) return static_cast<std::uint32_t>(numbers.size() - 1);
  const auto code = static_cast<std::uint32_t>(above - numbers.begin());
  if (*above == x || code == 0) return code;
  const double up = *above - x, down = x - numbers[code - 1];
  if (up != down) return up < down ? code : code - 1;
  return code % 2 == 0 ? code : code - 1;
}

// Every number of the format, every midpoint between two, and the doubles and floats beside both.
std::vector<double> edges(const std::vector<double>& numbers) {
  std::vector<double> all;
  const auto around = [&](double x) {
    for (const double y : {x, std::nextafter(x, 0), std::nextafter(x, infinity)}) all.push_back(y);
    const auto f = static_cast<float>(x);
    for (const float y : {std::nextafter(f, 0.0F), std::nextafter(f, 1e9F)}) all.push_back(y);
  };
  for (std::size_t i = 0; i + 1 < numbers.size(); ++i) {
    around(numbers[i]);
    around((numbers[i] + numbers[i + 1]) / 2);
  }
  return all;
}

// Floats that go through every path: all exponents, signs, specials, and numbers at the formats' ends.
std::vector<float> awkward_floats(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  const float special[] = {0.0F,
                           -0.0F,
                           std::numeric_limits<float>::infinity(),
                           -std::numeric_limits<float>::infinity(),
                           std::numeric_limits<float>::quiet_NaN(),
                           std::numeric_limits<float>::denorm_min(),
                           std::numeric_limits<float>::max(),
                           -1.0F,
                           65504.0F,
                           65408.0F,
                           65024.0F,
                           64512.0F,
                           65520.0F,
                           1e6F,
                           0x1p127F,
                           0.5F - 0x1p-25F,
                           0x1p-16F,
                           0x1p-24F,
                           0x1p-25F,
                           0x1.8p-24F};
  std::vector<float> x(count);
  for (float& f : x) {
    const unsigned kind = random() % 8;
    if (kind == 0) f = special[random() % std::size(special)];
    if (kind == 1) f = std::bit_cast<float>(static_cast<std::uint32_t>(random()));  // anything
    if (kind >= 2) f = std::ldexp(static_cast<float>(random() % 4096) / 2048, static_cast<int>(random() % 36) - 20);
  }
  return x;
}
std::vector<Vec3f> awkward_pixels(std::size_t count, unsigned seed) {
  const std::vector<float> x = awkward_floats(3 * count, seed);
  std::vector<Vec3f> pixels(count);
  for (std::size_t i = 0; i < count; ++i) pixels[i] = {x[3 * i], x[3 * i + 1], x[3 * i + 2]};
  return pixels;
}
bool same(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) || (std::isnan(a) && std::isnan(b));
}
bool same(const Vec3f& a, const Vec3f& b) { return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z); }

template <class Code, class Pack, class PackAll>
void expect_batch_is_scalar(const std::vector<Vec3f>& pixels, Pack pack, PackAll pack_all) {
  PackCounts expected_counts;
  std::vector<Code> expected;
  expected.reserve(pixels.size());
  for (const Vec3f& p : pixels) expected.push_back(pack(vec_cast<double>(p), expected_counts));
  on_each_instruction_set([&] {
    std::vector<Code> codes(pixels.size());
    const Result<PackCounts> counts = pack_all(std::span<const Vec3f>(pixels), std::span<Code>(codes));
    ASSERT_TRUE(counts.ok());
    EXPECT_EQ(*counts, expected_counts);
    EXPECT_EQ(codes, expected);
  });
}
template <class Code, class Unpack, class UnpackAll>
void expect_batch_reads_scalar(const std::vector<Code>& codes, Unpack unpack, UnpackAll unpack_all) {
  on_each_instruction_set([&] {
    std::vector<Vec3f> pixels(codes.size());
    ASSERT_TRUE(unpack_all(std::span<const Code>(codes), std::span<Vec3f>(pixels)).ok());
    std::size_t different = 0;
    for (std::size_t i = 0; i < codes.size(); ++i) different += same(pixels[i], vec_cast<float>(unpack(codes[i]))) ? 0 : 1;
    EXPECT_EQ(different, 0U);
  });
}

TEST(Half, ReadsEveryCode) {
  const std::vector<double> numbers = small_floats(10);
  ASSERT_EQ(numbers.back(), 65504);
  for (std::uint32_t code = 0; code < numbers.size(); ++code) {
    EXPECT_EQ(unpack_half(static_cast<std::uint16_t>(code)), numbers[code]);
    EXPECT_EQ(unpack_half(static_cast<std::uint16_t>(code | 0x8000U)), -numbers[code]);
  }
  EXPECT_EQ(unpack_half(0x7c00), infinity);
  EXPECT_EQ(unpack_half(0xfc00), -infinity);
  for (std::uint32_t code = 0x7c01; code <= 0x7fff; ++code) EXPECT_TRUE(std::isnan(unpack_half(static_cast<std::uint16_t>(code))));
  EXPECT_TRUE(std::signbit(unpack_half(0x8000)));
}

TEST(Half, WritesEveryNumberAndEveryEdge) {
  const std::vector<double> numbers = small_floats(10);
  PackCounts counts;
  for (const double x : edges(numbers)) {
    const std::uint32_t code = nearest_even(numbers, x);
    ASSERT_EQ(pack_half(x, counts), code) << x;
    ASSERT_EQ(pack_half(-x, counts), code | 0x8000U) << x;
  }
  EXPECT_EQ(counts.total(), 0U);
}

TEST(Half, CountsWhatDoesNotFit) {
  PackCounts counts;
  EXPECT_EQ(pack_half(not_a_number, counts), 0);
  EXPECT_EQ(counts, (PackCounts{1, 0, 0}));
  EXPECT_EQ(pack_half(65505, counts), 0x7bff);  // 65504, and what was above it is counted
  EXPECT_EQ(pack_half(65520, counts), 0x7bff);  // where IEEE rounding gives infinity
  EXPECT_EQ(pack_half(1.6e9, counts), 0x7bff);  // the Sun's disc
  EXPECT_EQ(pack_half(infinity, counts), 0x7bff);
  EXPECT_EQ(pack_half(-infinity, counts), 0xfbff);
  EXPECT_EQ(counts, (PackCounts{1, 0, 5}));
  EXPECT_EQ(pack_half(-0.0, counts), 0x8000);
  EXPECT_EQ(counts.total(), 6U);
}

TEST(Half, SpansAreTheScalarOnEveryInstructionSet) {
  // All floats that are exact in half, all neighbours of midpoints, all 2^16 high halves of a float, and awkward ones.
  std::vector<float> x = awkward_floats(20011, 1);
  for (const double edge : edges(small_floats(10))) x.push_back(static_cast<float>(edge));
  for (std::uint32_t high = 0; high < 65536; ++high) x.push_back(std::bit_cast<float>(high << 16));
  PackCounts expected_counts;
  std::vector<std::uint16_t> expected;
  expected.reserve(x.size());
  for (const float f : x) expected.push_back(pack_half(f, expected_counts));
  std::vector<std::uint16_t> every_code(65536 + 5);
  for (std::size_t i = 0; i < every_code.size(); ++i) every_code[i] = static_cast<std::uint16_t>(i);
  on_each_instruction_set([&] {
    std::vector<std::uint16_t> codes(x.size());
    const Result<PackCounts> counts = pack_half(x, codes);
    ASSERT_TRUE(counts.ok());
    EXPECT_EQ(*counts, expected_counts);
    EXPECT_EQ(codes, expected);
    std::vector<float> numbers(every_code.size());
    ASSERT_TRUE(unpack_half(every_code, numbers).ok());
    for (std::size_t i = 0; i < numbers.size(); ++i) ASSERT_TRUE(same(numbers[i], static_cast<float>(unpack_half(every_code[i])))) << i;
  });
}

TEST(R11G11B10F, EveryCodeBothWays) {
  const std::vector<double> eleven = small_floats(6), ten = small_floats(5);
  ASSERT_EQ(eleven.back(), r11_max);
  ASSERT_EQ(ten.back(), b10_max);
  PackCounts counts;
  for (std::uint32_t code = 0; code < eleven.size(); ++code) {
    EXPECT_EQ(unpack_r11g11b10f(code), (Rgb{eleven[code], 0, 0}));
    EXPECT_EQ(unpack_r11g11b10f(code << 11), (Rgb{0, eleven[code], 0}));
    EXPECT_EQ(pack_r11g11b10f({eleven[code], 0, 0}, counts), code);
    EXPECT_EQ(pack_r11g11b10f({0, eleven[code], 0}, counts), code << 11);
  }
  for (std::uint32_t code = 0; code < ten.size(); ++code) {
    EXPECT_EQ(unpack_r11g11b10f(code << 22), (Rgb{0, 0, ten[code]}));
    EXPECT_EQ(pack_r11g11b10f({0, 0, ten[code]}, counts), code << 22);
  }
  for (const double x : edges(eleven)) {
    const std::uint32_t code = nearest_even(eleven, x);
    ASSERT_EQ(pack_r11g11b10f({x, x, 0}, counts), code | code << 11) << x;
  }
  for (const double x : edges(ten)) ASSERT_EQ(pack_r11g11b10f({0, 0, x}, counts), nearest_even(ten, x) << 22) << x;
  EXPECT_EQ(counts.total(), 0U);
  // Infinity and NaN that somebody else wrote.
  EXPECT_EQ(unpack_r11g11b10f(31U << 6).x, infinity);
  EXPECT_TRUE(std::isnan(unpack_r11g11b10f(31U << 6 | 1).x));
  EXPECT_EQ(unpack_r11g11b10f(31U << 27).z, infinity);
}

TEST(R11G11B10F, CountsWhatDoesNotFit) {
  PackCounts counts;
  EXPECT_EQ(unpack_r11g11b10f(pack_r11g11b10f({not_a_number, -3, infinity}, counts)), (Rgb{0, 0, b10_max}));
  EXPECT_EQ(counts, (PackCounts{1, 1, 1}));
  EXPECT_EQ(unpack_r11g11b10f(pack_r11g11b10f({1e6, 65025, -infinity}, counts)), (Rgb{r11_max, r11_max, 0}));
  EXPECT_EQ(counts, (PackCounts{1, 2, 3}));
}

TEST(R11G11B10F, SpansAreTheScalarOnEveryInstructionSet) {
  std::vector<Vec3f> pixels = awkward_pixels(20011, 2);
  for (const double x : edges(small_floats(6))) pixels.push_back(vec_cast<float>(Vec3d{x, x, x}));
  for (const double x : edges(small_floats(5))) pixels.push_back(vec_cast<float>(Vec3d{x, x, x}));
  expect_batch_is_scalar<std::uint32_t>(
      pixels, [](const Rgb& c, PackCounts& n) { return pack_r11g11b10f(c, n); },
      [](std::span<const Vec3f> from, std::span<std::uint32_t> to) { return pack_r11g11b10f(from, to); });
  std::vector<std::uint32_t> codes;
  for (std::uint32_t code = 0; code < 2048; ++code) codes.push_back(code | (2047 - code) << 11 | (code & 1023) << 22);
  codes.push_back(5);
  expect_batch_reads_scalar(
      codes, [](std::uint32_t code) { return unpack_r11g11b10f(code); },
      [](std::span<const std::uint32_t> from, std::span<Vec3f> to) { return unpack_r11g11b10f(from, to); });
}

// The rule of EXT_texture_shared_exponent in long double, N = 9, B = 15: 64 bits of mantissa hold every sum below exactly.
std::uint32_t by_the_extension(const Vec3f& pixel) {
  const auto clamped = [](float x) -> long double { return x > 0 ? std::min<long double>(x, 65408) : 0; };  // NaN becomes 0
  const long double r = clamped(pixel.x), g = clamped(pixel.y), b = clamped(pixel.z), max = std::max({r, g, b});
  const int floor_log2 = max > 0 ? std::ilogb(max) : -200;
  int exponent = std::max(-15 - 1, floor_log2) + 1 + 15;
  if (std::floor(max / std::exp2(exponent - 15.0L - 9) + 0.5L) == 512) ++exponent;
  const long double unit = std::exp2(exponent - 15.0L - 9);
  const auto mantissa = [&](long double x) { return static_cast<std::uint32_t>(std::floor(x / unit + 0.5L)); };
  return mantissa(r) | mantissa(g) << 9 | mantissa(b) << 18 | static_cast<std::uint32_t>(exponent) << 27;
}

// Every exponent, every mantissa of the brightest channel, at the number, at the midpoint to the next, and at the floats beside both.
std::vector<Vec3f> rgb9e5_edges() {
  std::vector<Vec3f> pixels;
  for (int e = 0; e < 32; ++e)
    for (int m = 0; m < 512; ++m)
      for (const double at : {m + 0.0, m + 0.5}) {
        const auto x = static_cast<float>(std::ldexp(at, e - 24));
        for (const float y : {x, std::nextafter(x, 0.0F), std::nextafter(x, 1e9F)}) {
          pixels.push_back({y, 0, 0});
          pixels.push_back({std::ldexp(511.0F, e - 24), y, x / 3});
          pixels.push_back({std::ldexp(256.0F, e - 24), x / 1024, y});
        }
      }
  return pixels;
}

TEST(Rgb9e5, IsTheExtensionsRuleAtEveryEdge) {
  PackCounts counts;
  for (const Vec3f& p : rgb9e5_edges())
    ASSERT_EQ(pack_rgb9e5(vec_cast<double>(p), counts), by_the_extension(p)) << p.x << " " << p.y << " " << p.z;
  // .5 - 2^-25 of a unit, to which float arithmetic adds 1/2 and gets 1.
  const float just_below_half = std::ldexp(0.5F - 0x1p-25F, -24);
  EXPECT_EQ(pack_rgb9e5({just_below_half, 0, 0}, counts), 0U);
  EXPECT_EQ(pack_rgb9e5({std::ldexp(0.5 - 0x1p-54, -24), 0, 0}, counts), 0U);  // the same in double
  EXPECT_EQ(pack_rgb9e5({std::ldexp(0.5, -24), 0, 0}, counts), 1U);
}

TEST(Rgb9e5, ReadsEveryMantissaAndExponent) {
  for (std::uint32_t e = 0; e < 32; ++e)
    for (std::uint32_t m = 0; m < 512; ++m) {
      const double x = m * std::pow(2.0, static_cast<int>(e) - 24);
      EXPECT_EQ(unpack_rgb9e5(e << 27 | m), (Rgb{x, 0, 0}));
      EXPECT_EQ(unpack_rgb9e5(e << 27 | m << 9 | (511 - m) << 18).y, x);
    }
  EXPECT_EQ(unpack_rgb9e5(0xffffffffU), (Rgb{rgb9e5_max, rgb9e5_max, rgb9e5_max}));
}

TEST(Rgb9e5, CountsWhatDoesNotFit) {
  PackCounts counts;
  EXPECT_EQ(unpack_rgb9e5(pack_rgb9e5({not_a_number, -1, infinity}, counts)), (Rgb{0, 0, rgb9e5_max}));
  EXPECT_EQ(counts, (PackCounts{1, 1, 1}));
  EXPECT_EQ(pack_rgb9e5({-0.0, 0, 0}, counts), 0U);
  EXPECT_EQ(counts.total(), 3U);
}

TEST(Rgb9e5, SpansAreTheScalarOnEveryInstructionSet) {
  std::vector<Vec3f> pixels = rgb9e5_edges();
  for (const Vec3f& p : awkward_pixels(20011, 3)) pixels.push_back(p);
  expect_batch_is_scalar<std::uint32_t>(
      pixels, [](const Rgb& c, PackCounts& n) { return pack_rgb9e5(c, n); },
      [](std::span<const Vec3f> from, std::span<std::uint32_t> to) { return pack_rgb9e5(from, to); });
  std::vector<std::uint32_t> codes;
  for (std::uint32_t i = 0; i < 32 * 512 + 3; ++i)
    codes.push_back(i % 512 | (i * 7 % 512) << 9 | (i * 13 % 512) << 18 | i / 512 % 32 << 27);
  expect_batch_reads_scalar(
      codes, [](std::uint32_t code) { return unpack_rgb9e5(code); },
      [](std::span<const std::uint32_t> from, std::span<Vec3f> to) { return unpack_rgb9e5(from, to); });
}

// Ward's rule: the exponent that brings the brightest channel to 128..255, floors, half a unit when read.
TEST(Rgbe, FloorsAndReadsHalfAUnitMore) {
  PackCounts counts;
  EXPECT_EQ(pack_rgbe({1, 0.5, 0}, counts), (Bytes4{128, 64, 0, 129}));
  EXPECT_EQ(unpack_rgbe({128, 64, 0, 129}), (Rgb{128.5 / 128, 64.5 / 128, 0.5 / 128}));
  EXPECT_EQ(pack_rgbe({0, 0, 0}, counts), (Bytes4{0, 0, 0, 0}));
  EXPECT_EQ(unpack_rgbe({7, 7, 7, 0}), (Rgb{0, 0, 0}));
  for (int e = 1; e < 256; ++e)
    for (int m = 128; m < 256; ++m) {
      const Bytes4 code{static_cast<std::uint8_t>(m), static_cast<std::uint8_t>(255 - m), 3, static_cast<std::uint8_t>(e)};
      // What is read is in the middle of what floors to this code, and so comes back.
      ASSERT_EQ(pack_rgbe(unpack_rgbe(code), counts), code);
      ASSERT_EQ(pack_rgbe({m * std::pow(2.0, e - 136), 0, 0}, counts)[0], m);
      ASSERT_EQ(pack_rgbe({std::nextafter((m + 1) * std::pow(2.0, e - 136), 0), 0, 0}, counts)[0], m);
    }
  EXPECT_EQ(counts.total(), 0U);
}

TEST(Rgbe, CountsWhatDoesNotFit) {
  PackCounts counts;
  EXPECT_EQ(pack_rgbe({not_a_number, -1, 0x1p127}, counts), (Bytes4{0, 0, 255, 255}));
  EXPECT_EQ(pack_rgbe({infinity, 0x1p126, 0}, counts), (Bytes4{255, 128, 0, 255}));
  EXPECT_EQ(counts, (PackCounts{1, 1, 2}));
}

TEST(Rgbe, SpansAreTheScalarOnEveryInstructionSet) {
  std::vector<Vec3f> pixels = awkward_pixels(20011, 4);
  std::vector<Bytes4> codes;
  for (int e = 0; e < 256; ++e)
    for (int m = 0; m < 256; ++m) {
      const auto at = [](int i) { return static_cast<std::uint8_t>(i); };
      codes.push_back({at(m), at(m * 7), at(m * 13), at(e)});
      pixels.push_back(vec_cast<float>(unpack_rgbe(codes.back())));
      const float x = std::ldexp(static_cast<float>(m), e - 136);
      pixels.push_back({x, std::nextafter(x, 0.0F), x / 3});
    }
  codes.push_back({1, 2, 3, 4});
  expect_batch_is_scalar<Bytes4>(
      pixels, [](const Rgb& c, PackCounts& n) { return pack_rgbe(c, n); },
      [](std::span<const Vec3f> from, std::span<Bytes4> to) { return pack_rgbe(from, to); });
  expect_batch_reads_scalar(
      codes, [](const Bytes4& code) { return unpack_rgbe(code); },
      [](std::span<const Bytes4> from, std::span<Vec3f> to) { return unpack_rgbe(from, to); });
}

// Half a level of the multiplier's step is the most that a channel moves, for RGBM range m / 65025 with m <= 255 max / range + 1, for RGBD
// range / (510 d).
TEST(Rgbm, IsWithinHalfALevel) {
  PackCounts counts;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 100000; ++i) {
    const double brightness = 8 * std::pow(uniform(random), 4);
    const Rgb c{brightness * uniform(random), brightness, brightness * uniform(random)};
    const Rgb m = unpack_rgbm(pack_rgbm(c, 8, counts), 8), d = unpack_rgbd(pack_rgbd(c, 8, counts), 8);
    const double m_step = 8 * (255 * brightness / 8 + 1) / 65025, d_step = 8 / (255 * std::clamp(std::floor(8 / brightness), 1.0, 255.0));
    for (int channel = 0; channel < 3; ++channel) {
      ASSERT_LE(std::abs(m[channel] - c[channel]), m_step / 2 * (1 + 1e-12));
      ASSERT_LE(std::abs(d[channel] - c[channel]), d_step / 2 * (1 + 1e-12));
    }
  }
  EXPECT_EQ(counts.total(), 0U);
  // Every code is read into its range; white at the range is the last code.
  EXPECT_EQ(pack_rgbm({8, 8, 8}, 8, counts), (Bytes4{255, 255, 255, 255}));
  EXPECT_EQ(pack_rgbd({8, 8, 8}, 8, counts), (Bytes4{255, 255, 255, 1}));
  EXPECT_EQ(unpack_rgbm({255, 255, 255, 255}, 8), (Rgb{8, 8, 8}));
  EXPECT_EQ(unpack_rgbd({255, 255, 255, 0}, 8), (Rgb{8, 8, 8}));
  EXPECT_EQ(unpack_rgbm(pack_rgbm({not_a_number, -1, 9}, 8, counts), 8), (Rgb{0, 0, 8}));
  EXPECT_EQ(unpack_rgbd(pack_rgbd({not_a_number, -1, infinity}, 8, counts), 8), (Rgb{0, 0, 8}));
  EXPECT_EQ(counts, (PackCounts{2, 2, 2}));
}

// Larson: 256 levels an octave, so 2^(1/512) - 1 = .14 % at most from the middle that is read; u' and v' within 1/820.
TEST(LogLuv, LuminanceAndChromaticityWithinHalfALevel) {
  PackCounts counts;
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 20000; ++i) {
    const Rgb c = Rgb{uniform(random), uniform(random) + 1e-3, uniform(random)} * std::exp2(120 * (uniform(random) - 0.5));
    const Rgb read = unpack_logluv(pack_logluv(c, counts));
    const double stops = std::log2((0.2126 * read.x + 0.7152 * read.y + 0.0722 * read.z) / (0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z));
    ASSERT_LE(std::abs(stops), 1.0 / 512 + 1e-12);
    // XYZ to u'v' by the rounded matrix of IEC 61966-2-1, independent of ours: its digits move u'v' by 1e-4 at most.
    const auto u_v = [](const Rgb& s) {
      const double x = 0.4124 * s.x + 0.3576 * s.y + 0.1805 * s.z, y = 0.2126 * s.x + 0.7152 * s.y + 0.0722 * s.z,
                   z = 0.0193 * s.x + 0.1192 * s.y + 0.9505 * s.z;
      return Vec2d{4 * x / (x + 15 * y + 3 * z), 9 * y / (x + 15 * y + 3 * z)};
    };
    ASSERT_NEAR(u_v(read).x, u_v(c).x, 1.0 / 820 + 2e-4);
    ASSERT_NEAR(u_v(read).y, u_v(c).y, 1.0 / 820 + 2e-4);
  }
  EXPECT_EQ(counts.total(), 0U);
}
TEST(LogLuv, EveryLevelComesBack) {
  PackCounts counts;
  for (std::uint32_t level = 1; level < 32768; ++level) {
    const std::uint32_t code = level << 16 | 81U << 8 | 192U;  // near D65
    ASSERT_EQ(pack_logluv(unpack_logluv(code), counts), code);
    ASSERT_EQ(pack_logluv(unpack_logluv(code) * -1, counts), code | 0x80000000U);
  }
  EXPECT_EQ(pack_logluv({0, 0, 0}, counts), 0U);
  EXPECT_EQ(counts.total(), 0U);
  EXPECT_EQ(pack_logluv({not_a_number, 1, 1}, counts), 0U);
  EXPECT_EQ(pack_logluv({infinity, 1, 1}, counts) >> 16, 0x7fffU);
  EXPECT_EQ(pack_logluv({-1, 0.3, -1.0}, counts) >> 31, 1U);
  EXPECT_EQ(counts, (PackCounts{1, counts.negative, 1}));
}

TEST(Rgb10a2, EveryCodeAndEveryMidpoint) {
  PackCounts counts;
  for (std::uint32_t code = 0; code < 1024; ++code) {
    const double x = unpack_rgb10a2(code).x;
    EXPECT_EQ(x, code / 1023.0);
    EXPECT_EQ(pack_rgb10a2({x, x, x}, 1, counts), code | code << 10 | code << 20 | 3U << 30);
    // Down to the last float below a midpoint the code is the lower one.
    const auto middle = static_cast<float>((code + 0.5) / 1023);
    const double below = std::nextafter(middle, 0.0F), above = std::nextafter(middle, 2.0F);
    if (code < 1023) {
      EXPECT_EQ(pack_rgb10a2({below, 0, 0}, 0, counts), code);
      EXPECT_EQ(pack_rgb10a2({above, 0, 0}, 0, counts), code + 1);
    }
  }
  EXPECT_EQ(counts.total(), 0U);
  EXPECT_EQ(pack_rgb10a2({not_a_number, -1, 2}, 0.5, counts), 1023U << 20 | 2U << 30);
  EXPECT_EQ(counts, (PackCounts{1, 1, 1}));
}

// The formats without wide instructions: the span is the scalar, counts included.
TEST(Spans, OfTheOtherFormatsAreTheScalar) {
  const std::vector<Vec3f> pixels = awkward_pixels(1003, 7);
  expect_batch_is_scalar<Bytes4>(
      pixels, [](const Rgb& c, PackCounts& n) { return pack_rgbm(c, 16, n); },
      [](std::span<const Vec3f> from, std::span<Bytes4> to) { return pack_rgbm(from, to, 16); });
  expect_batch_is_scalar<Bytes4>(
      pixels, [](const Rgb& c, PackCounts& n) { return pack_rgbd(c, 16, n); },
      [](std::span<const Vec3f> from, std::span<Bytes4> to) { return pack_rgbd(from, to, 16); });
  expect_batch_is_scalar<std::uint32_t>(
      pixels, [](const Rgb& c, PackCounts& n) { return pack_logluv(c, n); },
      [](std::span<const Vec3f> from, std::span<std::uint32_t> to) { return pack_logluv(from, to); });
  expect_batch_is_scalar<std::uint32_t>(
      pixels, [](const Rgb& c, PackCounts& n) { return pack_rgb10a2(c, 1, n); },
      [](std::span<const Vec3f> from, std::span<std::uint32_t> to) { return pack_rgb10a2(from, to); });
}

TEST(Spans, OfDifferentLengthsAreRefused) {
  const std::vector<Vec3f> pixels(3);
  std::vector<std::uint32_t> codes(2);
  std::vector<Bytes4> bytes(3);
  EXPECT_EQ(pack_rgb9e5(pixels, codes).error().code, "BATCH_SIZES_DIFFER");
  EXPECT_EQ(pack_logluv(pixels, codes).error().code, "BATCH_SIZES_DIFFER");
  EXPECT_EQ(pack_rgbm(pixels, bytes, 0).error().code, "RANGE_INVALID");
  EXPECT_EQ(pack_rgbd(pixels, bytes, infinity).error().code, "RANGE_INVALID");
  EXPECT_TRUE(pack_rgb9e5(std::span<const Vec3f>(), std::span<std::uint32_t>()).ok());
}

}  // namespace
}  // namespace etendue
