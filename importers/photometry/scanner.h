// The text of a photometric file: lines, numbers and where they stand. Nothing is copied; line and column are counted when somebody asks.
#pragma once

#include "importers/photometry/options.h"

#include <span>
#include <string>
#include <string_view>

namespace etendue::photometric {

constexpr bool is_blank(char c) { return c == ' ' || c == '\t'; }
constexpr bool is_eol(char c) { return c == '\n' || c == '\r'; }

inline std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (is_blank(text.front()) || is_eol(text.front()))) text.remove_prefix(1);
  while (!text.empty() && (is_blank(text.back()) || is_eol(text.back()))) text.remove_suffix(1);
  return text;
}
constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";  // of UTF-8

// ASCII in upper case, without blanks.
std::string squeezed(std::string_view text);
// Valid UTF-8 as it is, anything else read as Latin-1.
std::string to_utf8(std::string_view text);

// A number at p: decimal, '+' and Fortran's D exponents allowed. The end of it, or nullptr if none stands there (also where it is infinite,
// NaN or beyond double).
const char* parse_number(const char* p, const char* end, double& value);

// Bytes as text: a byte order mark is dropped, UTF-16 becomes UTF-8 (in `storage`). Errors: FILE_EMPTY, NUL_BYTES, ENCODING_INVALID.
Result<std::string_view> decode(std::span<const std::byte> bytes, const std::string& file, std::string& storage, Diagnostics& diagnostics);

// Says what is wrong: a repair is a warning when tolerant and the error that ends a strict reading.
class Reporter {
 public:
  Reporter(std::string_view text, std::string file, bool strict, Diagnostics& diagnostics)
      : text_(text), file_(std::move(file)), strict_(strict), diagnostics_(diagnostics) {}

  Where where(const char* p) const;
  Error error(const char* code, std::string text, const char* p, std::string hint) const;
  // False: the reading is strict and ends with failure().
  [[nodiscard]] bool repair(const char* code, std::string text, const char* p, std::string hint = {});
  void note(const char* code, std::string text, const char* p) { diagnostics_.note(code, std::move(text), where(p)); }
  const Error& failure() const { return failure_; }

 private:
  std::string_view text_;
  std::string file_;
  bool strict_;
  Diagnostics& diagnostics_;
  Error failure_;
};

// The next line from p, without its end; p moves behind the end (CR LF, LF or CR).
inline std::string_view take_line(const char*& p, const char* end) {
  const char* const begin = p;
  while (p != end && !is_eol(*p)) ++p;
  const std::string_view line(begin, static_cast<std::size_t>(p - begin));
  if (p != end && *p++ == '\r' && p != end && *p == '\n') ++p;
  return line;
}

// Notes once what is unusual about the ends and lengths of the lines up to `end`; a repair if lines end in CR alone.
[[nodiscard]] bool review_lines(Reporter& reporter, std::string_view text, std::size_t longest);

}  // namespace etendue::photometric
