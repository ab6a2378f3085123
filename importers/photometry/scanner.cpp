#include "scanner.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <iterator>

namespace etendue::photometric {
namespace {

constexpr double power_of_ten[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                   1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

// Any length and exponent, correctly rounded by from_chars, which knows neither '+' nor D.
bool long_number(const char* begin, const char* end, double& value) {
  char buffer[64];
  const char* from = *begin == '+' ? begin + 1 : begin;
  const char* const exponent = std::find_if(from, end, [](char c) { return c == 'd' || c == 'D'; });
  if (exponent != end) {
    if (end - from >= static_cast<std::ptrdiff_t>(sizeof buffer)) return false;
    char* const copied = std::copy(from, end, buffer);
    buffer[exponent - from] = 'e';
    from = buffer;
    end = copied;
  }
  // from_chars takes no sign behind the exponent's letter but '-' and '+', which is what files have.
  const auto [stopped, code] = std::from_chars(from, end, value);
  if (stopped != end) return false;
  if (code == std::errc::result_out_of_range) {
    // Too small is zero, too large is refused: the exponent's sign tells.
    const char* const e = std::find_if(from, end, [](char c) { return c == 'e' || c == 'E'; });
    value = 0;
    return e != end && e + 1 != end && e[1] == '-';
  }
  return code == std::errc() && std::isfinite(value);
}

// Eight characters at once, the first one in the lowest byte.
constexpr std::uint64_t in_each_byte(std::uint64_t x) { return x * 0x0101010101010101; }

// How many of the first bytes are digits: a byte less '0' is above 9 where it or itself plus 0x76 has its highest bit. Carries run towards
// later characters alone, behind the first one that is none.
int leading_digits(std::uint64_t characters) {
  const std::uint64_t x = characters ^ in_each_byte('0');
  return std::countr_zero(((x + in_each_byte(0x76)) | x) & in_each_byte(0x80)) / 8;
}

// The first `digits` of eight bytes as a number: pairs, then fours, then all, each time the earlier half times 10, 100 or 10^4 plus the
// later one. What is shifted out behind the digits is filled up with zeros before them.
std::uint64_t number_of(std::uint64_t characters, int digits) {
  std::uint64_t x = (characters ^ in_each_byte('0')) << (64 - 8 * digits);
  x = ((x & in_each_byte(0x0F)) * (1 + (10 << 8))) >> 8;
  x = ((x & 0x00FF00FF00FF00FF) * (1 + (100 << 16))) >> 16;
  return ((x & 0x0000FFFF0000FFFF) * (1 + (std::uint64_t{10000} << 32))) >> 32;
}

// A number that ends within eight characters, point included, and has no exponent; null: it is another one.
const char* short_number(const char* p, double& magnitude) {
  std::uint64_t characters = 0;
  std::memcpy(&characters, p, sizeof characters);
  const int whole = leading_digits(characters);
  if (whole > 6) return nullptr;
  int digits = whole, length = whole;
  if (p[whole] == '.') {
    // Without its point, behind which the rest moves up.
    const std::uint64_t before = (std::uint64_t{1} << (8 * whole)) - 1;
    characters = (characters & before) | ((characters >> 8) & ~before);
    digits = leading_digits(characters);
    length = digits + 1;
  }
  if (digits == 0 || length > 7 || (p[length] | 0x20) == 'e' || (p[length] | 0x20) == 'd') return nullptr;
  magnitude = static_cast<double>(number_of(characters, digits)) / power_of_ten[digits - whole];
  return p + length;
}

constexpr bool is_digit(char c) { return static_cast<unsigned char>(c - '0') < 10; }

char16_t unit_at(std::string_view bytes, std::size_t at, bool little) {
  const auto a = static_cast<unsigned char>(bytes[at]), b = static_cast<unsigned char>(bytes[at + 1]);
  return static_cast<char16_t>(little ? a | b << 8 : a << 8 | b);
}

void append_utf8(std::string& out, char32_t c) {
  if (c < 0x80) {
    out += static_cast<char>(c);
  } else if (c < 0x800) {
    out += {static_cast<char>(0xC0 | c >> 6), static_cast<char>(0x80 | (c & 0x3F))};
  } else if (c < 0x10000) {
    out += {static_cast<char>(0xE0 | c >> 12), static_cast<char>(0x80 | (c >> 6 & 0x3F)), static_cast<char>(0x80 | (c & 0x3F))};
  } else {
    out += {static_cast<char>(0xF0 | c >> 18), static_cast<char>(0x80 | (c >> 12 & 0x3F)), static_cast<char>(0x80 | (c >> 6 & 0x3F)),
            static_cast<char>(0x80 | (c & 0x3F))};
  }
}

bool utf16_to_utf8(std::string_view bytes, bool little, std::string& out) {
  if (bytes.size() % 2 != 0) return false;
  out.reserve(bytes.size() / 2 + 16);
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    char32_t c = unit_at(bytes, i, little);
    if (c >= 0xD800 && c < 0xDC00 && i + 2 < bytes.size()) {
      const char32_t low = unit_at(bytes, i += 2, little);
      if (low < 0xDC00 || low > 0xDFFF) return false;
      c = 0x10000 + ((c - 0xD800) << 10) + (low - 0xDC00);
    } else if (c >= 0xD800 && c < 0xE000) {
      return false;
    }
    append_utf8(out, c);
  }
  return true;
}

// Length of the valid UTF-8 sequence at i, 0 if there is none.
std::size_t utf8_length(std::string_view text, std::size_t i) {
  const auto byte = [&](std::size_t at) { return at < text.size() ? static_cast<unsigned char>(text[at]) : 0u; };
  const unsigned first = byte(i);
  const std::size_t length = first < 0x80 ? 1 : first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF5 ? 4 : 0;
  for (std::size_t k = 1; k < length; ++k)
    if ((byte(i + k) & 0xC0) != 0x80) return 0;
  const unsigned second = byte(i + 1);
  const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool beyond = (first == 0xED && second > 0x9F) || (first == 0xF4 && second > 0x8F);
  return overlong || beyond ? 0 : length;
}

}  // namespace

std::string squeezed(std::string_view text) {
  std::string out;
  for (const char c : text)
    if (!is_blank(c)) out += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return out;
}

std::string to_utf8(std::string_view text) {
  unsigned char any = 0;
  for (const char c : text) any |= static_cast<unsigned char>(c);
  if (any < 0x80) return std::string(text);
  bool valid = true;
  for (std::size_t i = 0; i < text.size() && valid;) {
    const std::size_t length = utf8_length(text, i);
    valid = length > 0;
    i += length;
  }
  if (valid) return std::string(text);
  std::string out;
  for (const char c : text) append_utf8(out, static_cast<unsigned char>(c));
  return out;
}

// Digits and point make an integer m below 2^53 and a power of ten up to 22: both are exact doubles, so one division rounds correctly
// (Clinger 1990). Whatever is longer goes the long way.
const char* parse_number(const char* p, const char* const end, double& value) {
  const char* const begin = p;
  bool negative = false;
  if (p != end && (*p == '-' || *p == '+')) negative = *p++ == '-';
  if (std::endian::native == std::endian::little && end - p >= 8) {
    if (const char* const stop = short_number(p, value)) {
      value = negative ? -value : value;
      return stop;
    }
  }
  const char* const first = p;
  std::uint64_t m = 0;
  while (p != end && is_digit(*p)) m = m * 10 + static_cast<unsigned>(*p++ - '0');
  std::ptrdiff_t digits = p - first, fraction = 0;
  if (p != end && *p == '.') {
    const char* const point = ++p;
    while (p != end && is_digit(*p)) m = m * 10 + static_cast<unsigned>(*p++ - '0');
    fraction = p - point;
    digits += fraction;
  }
  if (digits == 0) return nullptr;
  constexpr std::ptrdiff_t exact_digits = 15;
  const bool exponent = p != end && ((*p | 0x20) == 'e' || (*p | 0x20) == 'd');
  if (digits <= exact_digits && !exponent) {
    const double magnitude = static_cast<double>(m) / power_of_ten[fraction];
    value = negative ? -magnitude : magnitude;
    return p;
  }
  if (exponent) {
    ++p;
    if (p != end && (*p == '-' || *p == '+')) ++p;
    const char* const power = p;
    while (p != end && is_digit(*p)) ++p;
    if (p == power) return nullptr;
  }
  return long_number(begin, p, value) ? p : nullptr;
}

Result<std::string_view> decode(std::span<const std::byte> bytes, const std::string& file, std::string& storage, Diagnostics& diagnostics) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto fail = [&](const char* code, std::string what, std::size_t at, const char* hint) {
    const auto line = 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
    const std::size_t newline = at == 0 ? std::string_view::npos : text.rfind('\n', at - 1);
    const auto column = static_cast<int>(newline == std::string_view::npos ? at + 1 : at - newline);
    return Error{code, std::move(what), {file, line, column, {}}, hint, {}};
  };
  if (text.empty()) return fail("FILE_EMPTY", "expected a photometric file, found no bytes", 0, "the file may not have been downloaded");
  if (text.starts_with(byte_order_mark)) {
    diagnostics.note("BYTE_ORDER_MARK", "a byte order mark was skipped", {file, 1, 1, {}});
    text.remove_prefix(byte_order_mark.size());
  } else if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    if (!utf16_to_utf8(text.substr(2), text[0] == '\xFF', storage))
      return fail("ENCODING_INVALID", "expected UTF-16 behind its byte order mark, found bytes that are none", 0, "save it as plain text");
    diagnostics.warning("ENCODING_UTF16", "UTF-16 was read as text; the format is ASCII", {file, 1, 1, {}});
    text = storage;
  }
  const std::size_t nul = text.find('\0');
  if (nul != std::string_view::npos)
    return fail("NUL_BYTES", "expected text, found a NUL byte", nul, "the file is binary or was damaged: fetch it again");
  return text;
}

Where Reporter::where(const char* p) const {
  const char* const begin = text_.data();
  p = std::clamp(p, begin, begin + text_.size());
  int line = 1;
  const char* start = begin;
  for (const char* c = begin; c != p; ++c) {
    const bool crlf = *c == '\r' && c + 1 != begin + text_.size() && c[1] == '\n';
    if (*c == '\n' || (*c == '\r' && !crlf)) {
      ++line;
      start = c + 1;
    }
  }
  return {file_, line, static_cast<int>(p - start) + 1, {}};
}

Error Reporter::error(const char* code, std::string text, const char* p, std::string hint) const {
  return {code, std::move(text), where(p), std::move(hint), {}};
}

bool Reporter::repair(const char* code, std::string text, const char* p, std::string hint) {
  if (strict_) {
    failure_ = error(code, std::move(text), p, hint.empty() ? "reading it tolerantly repairs this" : std::move(hint));
    return false;
  }
  diagnostics_.add({Severity::warning, code, std::move(text), where(p), std::move(hint)});
  return true;
}

bool review_lines(Reporter& reporter, std::string_view text, std::size_t longest) {
  const char* const end = text.data() + text.size();
  const char* line = text.data();
  const char* too_long = nullptr;
  std::size_t count = 0, with_cr = 0, long_lines = 0;
  while (line != end) {
    const auto* newline = static_cast<const char*>(std::memchr(line, '\n', static_cast<std::size_t>(end - line)));
    const char* const stop = newline != nullptr ? newline : end;
    if (newline != nullptr) {
      ++count;
      if (newline != line && newline[-1] == '\r') ++with_cr;
    }
    if (static_cast<std::size_t>(stop - line) > longest) {
      if (too_long == nullptr) too_long = line;
      ++long_lines;
    }
    line = newline != nullptr ? newline + 1 : end;
  }
  if (count == 0 && text.find('\r') != std::string_view::npos)
    return reporter.repair("LINE_END_CR", "lines end in CR alone; read as line ends", text.data() + text.find('\r'));
  if (with_cr < count)
    reporter.note("LINE_END_LF", fmt::format("{} of {} lines end in LF alone, not in CR LF", count - with_cr, count), text.data());
  if (too_long != nullptr)
    reporter.note("LINE_TOO_LONG", fmt::format("{} lines are longer than the {} characters of this version", long_lines, longest),
                  too_long);
  return true;
}

}  // namespace etendue::photometric
