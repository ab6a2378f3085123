#include "numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace etendue::photometric {
namespace {

enum : unsigned char { other = 0, blank = 1, comma = 2 };
constexpr std::array<unsigned char, 256> kinds = [] {
  std::array<unsigned char, 256> table{};
  for (const char c : {' ', '\t', '\r', '\n'}) table[static_cast<unsigned char>(c)] = blank;
  table[','] = comma;
  return table;
}();

unsigned char kind_of(char c) { return kinds[static_cast<unsigned char>(c)]; }

}  // namespace

bool NumberReader::separates(char c) const { return kind_of(c) == blank || (kind_of(c) == comma && comma_ == Comma::separates); }

void NumberReader::skip_separators() {
  while (p_ != end_ && separates(*p_)) ++p_;
}

bool NumberReader::read(std::span<double> out) {
  const unsigned char separators = comma_ == Comma::separates ? blank | comma : blank;
  const char* p = p_;
  for (std::size_t i = 0; i < out.size(); ++i) {
    while (p != end_ && (kind_of(*p) & separators) != 0) ++p;
    const char* const token = p;
    const char* const stop = parse_number(p, end_, out[i]);
    if (stop != nullptr && (stop == end_ || (kind_of(*stop) & separators) != 0)) {
      p = stop;
      token_ = token;
      continue;
    }
    p_ = token_ = token;
    if (comma_ == Comma::separates || !read_with_comma(out[i])) {
      failed_at_ = i;
      return false;
    }
    p = p_;
  }
  p_ = p;
  return true;
}

// "12,5": the comma stands where the point should.
bool NumberReader::read_with_comma(double& value) {
  const char* const stop = std::find_if(p_, end_, [&](char c) { return separates(c); });
  std::array<char, 64> copy{};
  if (stop - p_ > static_cast<std::ptrdiff_t>(copy.size())) return false;
  char* const copied = std::copy(p_, stop, copy.begin());
  char* const found = std::find(copy.begin(), copied, ',');
  if (found == copied) return false;
  *found = '.';
  if (parse_number(copy.data(), copied, value) != copied) return false;
  p_ = stop;
  comma_was_decimal_ = true;
  return true;
}

bool NumberReader::line_ends_here() const {
  for (const char* p = p_; p != end_ && separates(*p); ++p)
    if (is_eol(*p)) return true;
  return p_ == end_;
}

Error NumberReader::failure(const Reporter& reporter, const std::string& expected) const {
  if (token_ == end_ || *token_ == '\x1a')
    return reporter.error("FILE_TRUNCATED", fmt::format("expected {}, found the end of the file", expected), token_,
                          "the file is incomplete: fetch it again");
  const char* const stop = std::find_if(token_, end_, [&](char c) { return separates(c); });
  const std::string found = to_utf8({token_, static_cast<std::size_t>(std::min<std::ptrdiff_t>(stop - token_, 40))});
  const bool numeric =
      found.find_first_not_of("0123456789.+-eEdD") == std::string::npos && found.find_first_of("0123456789") != std::string::npos;
  return reporter.error(
      numeric ? "NUMBER_RANGE" : "NUMBER_EXPECTED", fmt::format("expected {}, found \"{}\"", expected, found), token_,
      numeric ? "the number is malformed or beyond what a double holds" : "text inside the numbers shifts all that follow");
}

}  // namespace etendue::photometric
