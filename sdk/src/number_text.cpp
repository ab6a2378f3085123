#include "number_text.h"

#include <charconv>

namespace etendue {
namespace {
bool is_digit(char c) { return c >= '0' && c <= '9'; }
}  // namespace

const char* take_number(std::string_view& text, double& value) {
  std::string_view digits = text;
  const bool negative = !digits.empty() && digits.front() == '-';
  if (negative || (!digits.empty() && digits.front() == '+')) digits.remove_prefix(1);
  if (digits.empty() || !(is_digit(digits.front()) || digits.front() == '.')) return "it does not start with a number";

  const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (status == std::errc::result_out_of_range) return "the number is beyond the range of a double";
  if (status != std::errc()) return "it does not start with a number";
  digits.remove_prefix(static_cast<std::size_t>(end - digits.data()));
  if (!digits.empty() && (is_digit(digits.front()) || std::string_view(".,'_").find(digits.front()) != std::string_view::npos))
    return "the decimal mark is a point, and digits are not grouped";
  if (negative) value = -value;
  text = digits;
  return nullptr;
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace etendue
