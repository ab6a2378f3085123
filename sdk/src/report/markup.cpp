#include "markup.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace etendue::report_detail {

std::string escaped(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += static_cast<unsigned char>(c) < 0x20 && c != '\n' ? ' ' : c;
    }
  }
  return result;
}

std::string percent(double ratio, bool sign) {
  const double value = 100 * ratio, size = std::abs(value);
  // Two digits that matter, never more than four places, never fewer than none.
  const int places = size > 0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(size))), 0, 4) : 0;
  std::string digits = fmt::format("{:.{}f}", size, places);
  if (digits.find('.') != std::string::npos) {
    digits.erase(digits.find_last_not_of('0') + 1);
    if (digits.back() == '.') digits.pop_back();
  }
  const char* mark = digits == "0" ? "" : value < 0 ? "\u2212" : sign ? "+" : "";
  return mark + digits + "\u202f%";
}

}  // namespace etendue::report_detail
