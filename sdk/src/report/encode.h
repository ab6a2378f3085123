// Float pictures as text: half floats with a common factor, in base64.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace etendue::report_detail {

// IEEE 754 binary16, round to nearest even; beyond its range the largest finite value.
std::uint16_t to_half(float value);

// value = factor * half; the factor is a power of two that brings the largest value near the top of the range.
struct Encoded {
  double factor = 1;
  std::string base64;  // little-endian halves (RFC 4648, section 4)
};
Encoded encode(const std::vector<float>& values);

}  // namespace etendue::report_detail
