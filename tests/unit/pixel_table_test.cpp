// Frostbite's table 14 against what the formats hold, and errata E15, E16 and E19.
#include "pixel_limits.h"

#include <gtest/gtest.h>

namespace etendue {
namespace {

PixelLimits limits_of(const std::string& name) {
  for (const PixelFormat& format : pixel_formats())
    if (format.name == name) return measured_limits(format);
  ADD_FAILURE() << name;
  return {};
}

// Largest, smallest with the full precision and smallest number: closed forms of each format. The error of p bits is 2^-p at most, reached
// just above a power of two, where 2^17 samples of a stop find it within 2 %.
TEST(Table14, IsWhatTheFormatsHold) {
  struct Row {
    const char* name;
    double largest, least_precise, smallest;
    int bits;
  };
  const Row rows[] = {{"half", 65504, 0x1p-14, 0x1p-24, 11},
                      {"R11 G11", 65024, 0x1p-14, 0x1p-20, 7},
                      {"B10", 64512, 0x1p-14, 0x1p-19, 6},
                      {"RGB9E5", 65408, 0x1p-16, 0x1p-24, 9}};
  for (const Row& row : rows) {
    const PixelLimits m = limits_of(row.name);
    EXPECT_EQ(m.largest, row.largest) << row.name;
    EXPECT_EQ(m.least_precise, row.least_precise) << row.name;
    EXPECT_EQ(m.smallest, row.smallest) << row.name;
    EXPECT_NEAR(m.relative_error, std::exp2(-row.bits), 0.02 * std::exp2(-row.bits)) << row.name;
    EXPECT_NEAR(m.digits, row.bits * std::log10(2), 0.01) << row.name;
    for (const int steps : m.steps_a_stop) EXPECT_EQ(steps, 1 << (row.bits - 1)) << row.name;
  }
  EXPECT_NEAR(limits_of("RGBE").relative_error, 1.0 / 256, 1e-4);                               // half of 1/128
  EXPECT_NEAR(limits_of("LogLuv (luminance)").relative_error, std::exp2(1.0 / 512) - 1, 2e-5);  // half of 1/256 stop
}

// What Frostbite says of integer formats: they band where it is dark. 16 stops below white nothing is left of 10 bits.
TEST(Table14, IntegerFormatsBand) {
  const PixelLimits ten = limits_of("10-10-10-2"), rgbm = limits_of("RGBM 8"), half = limits_of("half");
  EXPECT_EQ(ten.steps_a_stop[2], 2);
  EXPECT_EQ(ten.steps_a_stop[3], 0);
  EXPECT_GT(rgbm.steps_a_stop[0], 128);
  EXPECT_LT(rgbm.steps_a_stop[3], 3);
  EXPECT_EQ(half.steps_a_stop[3], 1024);
}
// "A small hue shift": blue has one bit less than red; at a number where red is exact and blue is halfway it moves by 2^-6 of itself.
TEST(Table14, GreyIsTintedInR11G11B10F) { EXPECT_NEAR(largest_tint_of_r11g11b10f(), 1.0 / 65, 2e-4); }

// E15: RGB9E5's smallest value is printed as 6.10e-5. Full 9 bits go down to 2^-16 = 1.53e-5, and 2^-24 = 5.96e-8 is not 0. Its digits, and
// those of 11 and 10 bits, are printed as 3.16, 2.5 and 2.32, while 7.22 and 3.31 of the first two rows are p log10(2) for 24 and 11 bits:
// that gives 2.71, 2.11 and 1.81. "About 30 stops" is right for none of its stops: 32 with all bits, 40 in all.
TEST(Errata, E15SharedExponentReachesFurther) {
  EXPECT_NEAR(24 * std::log10(2), 7.22, 0.005);
  const PixelLimits half = limits_of("half"), shared = limits_of("RGB9E5");
  EXPECT_NEAR(half.digits, 3.31, 0.005);
  EXPECT_NEAR(shared.least_precise, 1.53e-5, 5e-8);
  EXPECT_NEAR(shared.smallest, 5.96e-8, 5e-11);
  EXPECT_NEAR(6.10e-5 / shared.least_precise, 4, 0.01);  // printed for what is measured
  EXPECT_NEAR(shared.digits, 2.71, 0.005);
  EXPECT_NEAR(limits_of("R11 G11").digits, 2.11, 0.005);
  EXPECT_NEAR(limits_of("B10").digits, 1.81, 0.005);
  EXPECT_GT(3.16 - shared.digits, 0.4);  // printed minus measured
  EXPECT_NEAR(std::log2(shared.largest / shared.least_precise), 32, 0.01);
  EXPECT_NEAR(shared.stops(), 40, 0.01);
  EXPECT_NEAR(std::log2(half.largest / half.least_precise), 30, 0.01);
}

// E16: the version notes write the largest values as powers: (511/512)^16 = .969 for 65408 and (1 + 1023/1024)^maxExp for 65504. The
// mantissa multiplies a power of two.
TEST(Errata, E16LargestIsMantissaTimesPowerOfTwo) {
  EXPECT_NEAR(std::pow(511.0 / 512, 16), 0.969, 5e-4);
  EXPECT_EQ(511.0 / 512 * 0x1p16, limits_of("RGB9E5").largest);
  EXPECT_NEAR(std::pow(1 + 1023.0 / 1024, 15), 32528.8, 0.1);
  EXPECT_EQ((1 + 1023.0 / 1024) * 0x1p15, limits_of("half").largest);
}

// E19: listing 30's approximations of the sRGB curve. A power of a negative number, as out-of-gamut colours have, is NaN; gamma 2.2 is off
// by up to .0085 decoding and .0335 encoding, the latter at .00216.
TEST(Errata, E19GammaIsNotSrgb) {
  EXPECT_TRUE(std::isnan(std::pow(-0.1, 2.2)));
  EXPECT_TRUE(std::isnan(std::pow(-0.1, 1 / 2.2)));
  const auto decode = [](double x) { return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4); };
  const auto encode = [](double x) { return x <= 0.0031308 ? x * 12.92 : 1.055 * std::pow(x, 1 / 2.4) - 0.055; };
  double decoding = 0, encoding = 0, at = 0;
  for (int i = 0; i <= 1000000; ++i) {
    const double x = i / 1e6;
    decoding = std::max(decoding, std::abs(std::pow(x, 2.2) - decode(x)));
    if (const double error = std::abs(std::pow(x, 1 / 2.2) - encode(x)); error > encoding) encoding = error, at = x;
  }
  EXPECT_NEAR(decoding, 0.0085, 5e-5);
  EXPECT_NEAR(encoding, 0.0335, 5e-5);
  EXPECT_NEAR(at, 0.00216, 5e-6);
}

}  // namespace
}  // namespace etendue
