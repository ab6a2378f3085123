#include "number_text.h"

#include <charconv>

namespace etendue {
namespace {
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_blank(char c) { return c == ' ' || c == '\t'; }
}  // namespace

const char* take_decimal(std::string_view& text, double& value) {
  std::string_view digits = text;
  const bool negative = !digits.empty() && digits.front() == '-';
  if (negative || (!digits.empty() && digits.front() == '+')) digits.remove_prefix(1);
  if (digits.empty() || !(is_digit(digits.front()) || digits.front() == '.')) return "it does not start with a number";

  const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (status == std::errc::result_out_of_range) return "the number is beyond the range of a double";
  if (status != std::errc()) return "it does not start with a number";
  digits.remove_prefix(static_cast<std::size_t>(end - digits.data()));
  if (negative) value = -value;
  text = digits;
  return nullptr;
}

const char* take_number(std::string_view& text, double& value) {
  std::string_view rest = text;
  if (const char* const why = take_decimal(rest, value)) return why;
  if (!rest.empty() && (is_digit(rest.front()) || std::string_view(".,'_").find(rest.front()) != std::string_view::npos))
    return "the decimal mark is a point, and digits are not grouped";
  text = rest;
  return nullptr;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace etendue
