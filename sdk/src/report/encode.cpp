#include "encode.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace etendue::report_detail {
namespace {

std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < left ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= left ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

}  // namespace

std::uint16_t to_half(float value) {
  constexpr float largest = 65504;                         // (2 - 2^-10) 2^15
  constexpr int mantissa_bits = 10, least_exponent = -14;  // of binary16's normal numbers
  const std::uint16_t sign = std::signbit(value) ? 0x8000 : 0;
  const float size = std::min(std::abs(value), largest);
  if (!(size > 0)) return sign;
  int exponent = 0;
  std::frexp(size, &exponent);  // size = m 2^exponent, m in [.5, 1)
  const int scale = std::max(exponent - 1, least_exponent);
  // In units of the last place; a normal number's leading bit is the exponent field's lowest, so rounding up carries over by itself.
  const auto units = static_cast<std::uint32_t>(std::nearbyint(std::ldexp(size, mantissa_bits - scale)));
  return static_cast<std::uint16_t>(sign + (static_cast<std::uint32_t>(scale - least_exponent) << mantissa_bits) + units);
}

Encoded encode(const std::vector<float>& values) {
  float largest = 0;
  for (float value : values) largest = std::isfinite(value) ? std::max(largest, std::abs(value)) : largest;
  int exponent = 0;
  if (largest > 0) std::frexp(largest, &exponent);
  Encoded result;
  result.factor = std::ldexp(1.0, exponent - 15);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(2 * values.size());
  for (float value : values) {
    const std::uint16_t half = std::isfinite(value) ? to_half(static_cast<float>(value / result.factor)) : std::uint16_t{0};
    bytes.push_back(static_cast<std::uint8_t>(half & 0xff));
    bytes.push_back(static_cast<std::uint8_t>(half >> 8));
  }
  result.base64 = base64(bytes);
  return result;
}

}  // namespace etendue::report_detail
