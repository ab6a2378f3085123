// What parse() reads with: a text of which more and more is taken, and errors that say where.
#pragma once

#include "etendue/unit_names.h"
#include "number_text.h"

#include <fmt/format.h>

#include <cmath>

namespace etendue {

// The text that is not read yet, and where it stands in the whole.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : whole_(text), rest_(text) { skip_blanks(); }

  bool at_end() const { return rest_.empty(); }
  char next() const { return rest_.empty() ? '\0' : rest_.front(); }
  std::string_view rest() const { return rest_; }

  // Takes `literal` and blanks behind it.
  bool take(std::string_view literal) {
    if (!rest_.starts_with(literal)) return false;
    rest_.remove_prefix(literal.size());
    skip_blanks();
    return true;
  }
  // Takes a name in front of a number: "ISO 400", "T2.8".
  bool take_name(std::string_view name) {
    const std::string_view before = rest_;
    if (take(name) && (is_number_start() || at_end())) return true;
    rest_ = before;
    return false;
  }
  bool is_number_start() const {
    const char c = next();
    return (c >= '0' && c <= '9') || c == '.' || c == '+' || c == '-';
  }
  Result<double> number() {
    double value = 0;
    if (const char* const why = take_number(rest_, value))
      return error("NUMBER_INVALID", fmt::format("expected a decimal number such as 1.5, found \"{}\": {}", word(), why));
    return value;
  }
  // Up to a blank, an @ or the end.
  std::string_view word() const {
    std::size_t end = 0;
    while (end < rest_.size() && rest_[end] != ' ' && rest_[end] != '\t' && rest_[end] != '@') ++end;
    return rest_.substr(0, end);
  }
  void skip(std::size_t count) {
    rest_.remove_prefix(count);
    skip_blanks();
  }
  void skip_blanks() {
    while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\t')) rest_.remove_prefix(1);
  }

  Error error(const char* code, std::string text, std::string hint = {}) const {
    return located({code, std::move(text), {}, std::move(hint), {}});
  }
  Error located(Error found) const {
    found.where.column = static_cast<int>(whole_.size() - rest_.size()) + 1;
    return found;
  }
  Error unexpected(const char* expected) const {
    return error("TEXT_UNEXPECTED", fmt::format("expected {}, found \"{}\"", expected, rest_));
  }

 private:
  std::string_view whole_, rest_;
};

// A number, a blank if any, and a unit: finite in SI, but for a temperature of no mired.
struct Counted {
  double number;
  const NamedUnit* unit;
  double si() const { return unit->to_si(number); }
};
inline Result<Counted> take_unit(double number, Cursor& cursor) {
  cursor.skip_blanks();
  if (cursor.is_number_start() && cursor.next() != '+' && cursor.next() != '-')
    return cursor.error("NUMBER_INVALID", "digits are not grouped, and the decimal mark is a point");
  const std::string_view word = cursor.word();
  if (word.empty() || word.front() == '+' || word.front() == '-')
    return cursor.error("UNIT_MISSING", "expected a unit behind the number, found none", "write for example \"1500 lm\"");
  const NamedUnit* const unit = find_unit(word);
  if (unit == nullptr) return cursor.located(unit_named(word).error());
  const Counted counted{number, unit};
  if (!std::isfinite(counted.si()) && !unit->reciprocal)
    return cursor.error("NUMBER_INVALID", fmt::format("{} {} is beyond the range of a double", number, word));
  cursor.skip(word.size());
  return counted;
}
inline Result<Counted> take_quantity(Cursor& cursor) {
  const Result<double> number = cursor.number();
  return number ? take_unit(*number, cursor) : number.error();
}

}  // namespace etendue
