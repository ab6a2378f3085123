#include "fields.h"

#include "edit_distance.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace etendue::rig {
namespace {

constexpr double unlimited = std::numeric_limits<double>::max();

std::string quoted(const std::vector<std::string_view>& words) {
  std::string text;
  for (const std::string_view word : words) text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", word);
  return text;
}

// What was found, short enough for a message.
std::string found(JsonValue value) {
  if (value.is(JsonKind::number)) return fmt::format("the number {}", value.number());
  if (value.is(JsonKind::string)) {
    const std::string_view text = value.string();
    return text.size() <= 60 ? fmt::format("\"{}\"", text) : fmt::format("a string of {} bytes", text.size());
  }
  if (value.is(JsonKind::boolean)) return value.boolean() ? "true" : "false";
  return name_of(value.kind());
}

void fail_type(JsonValue value, std::string_view expected, Diagnostics& diagnostics) {
  fail(diagnostics, value, "TYPE_MISMATCH", fmt::format("expected {}, found {}", expected, found(value)));
}

bool within(double x, Bound bound) { return bound == Bound::any || (bound == Bound::positive ? x > 0 : x >= 0); }

std::optional<double> bounded(JsonValue value, double x, Bound bound, Diagnostics& diagnostics) {
  if (within(x, bound)) return x;
  const char* expected = bound == Bound::positive ? "above zero" : "of zero or more";
  fail(diagnostics, value, "VALUE_OUT_OF_RANGE", fmt::format("expected a value {}, found {}", expected, found(value)));
  return {};
}

}  // namespace

void fail(Diagnostics& diagnostics, JsonValue at, std::string code, std::string text, std::string hint) {
  diagnostics.add({Severity::error, std::move(code), std::move(text), at.where(), std::move(hint)});
}
void warn(Diagnostics& diagnostics, JsonValue at, std::string code, std::string text) {
  diagnostics.warning(std::move(code), std::move(text), at.where());
}

std::string nearest_hint(std::string_view word, const std::vector<std::string_view>& known) {
  std::string_view best;
  std::size_t fewest = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string_view candidate : known) {
    if (word.size() > 2 * candidate.size() + 2) continue;  // also bounds the work
    const std::size_t edits = edit_distance(word, candidate);
    if (edits < fewest) {
      fewest = edits;
      best = candidate;
    }
  }
  return best.empty() ? std::string() : fmt::format("did you mean \"{}\"?", best);
}

Fields::Fields(JsonValue object, Diagnostics& diagnostics) : object_(object), diagnostics_(diagnostics) {
  if (object_ && !object_.is(JsonKind::object)) fail_type(object_, "an object", diagnostics_);
}

JsonValue Fields::find(std::string_view key) {
  known_.push_back(key);
  return object_.find(key);
}

JsonValue Fields::require(std::string_view key) {
  const JsonValue value = find(key);
  if (valid() && !value) fail(diagnostics_, object_, "KEY_MISSING", fmt::format("expected the key \"{}\"", key));
  return value;
}

JsonValue Fields::one_of(const std::vector<std::string_view>& keys) {
  JsonValue first;
  for (const std::string_view key : keys) {
    const JsonValue value = find(key);
    if (value && first) {
      diagnostics_.error("KEYS_EXCLUSIVE",
                         fmt::format("only one of {} may be given, found \"{}\" and \"{}\"", quoted(keys), first.key(), key),
                         value.where_key());
    }
    if (!first) first = value;
  }
  return first;
}

void Fields::finish() {
  if (!valid()) return;
  for (const JsonValue member : object_) {
    if (std::find(known_.begin(), known_.end(), member.key()) != known_.end()) continue;
    std::string hint = nearest_hint(member.key(), known_);
    if (hint.empty()) hint = fmt::format("known here: {}", quoted(known_));
    diagnostics_.add(
        {Severity::error, "KEY_UNKNOWN", fmt::format("unknown key \"{}\"", member.key().substr(0, 60)), member.where_key(), hint});
  }
}

std::optional<double> read_quantity(JsonValue value, Dimension dimension, Bound bound, Diagnostics& diagnostics) {
  if (!value) return {};
  const std::string expected = fmt::format("a {} with its unit, such as \"1 {}\"", name_of(dimension), si_unit_of(dimension));
  if (value.is(JsonKind::number)) {
    fail(diagnostics, value, "UNIT_MISSING", fmt::format("expected {}, found {}", expected, found(value)));
    return {};
  }
  if (!value.is(JsonKind::string)) {
    fail_type(value, expected, diagnostics);
    return {};
  }
  const Result<double> si = parse_si(value.string(), dimension);
  if (!si) {
    fail(diagnostics, value, si.error().code, si.error().text, si.error().hint);
    return {};
  }
  return bounded(value, *si, bound, diagnostics);
}

std::optional<double> read_length(JsonValue value, Bound bound, Diagnostics& diagnostics) {
  if (value.is(JsonKind::number)) return bounded(value, value.number(), bound, diagnostics);
  return read_quantity(value, Dimension::length, bound, diagnostics);
}

std::optional<double> read_number(JsonValue value, double min, double max, Diagnostics& diagnostics) {
  if (!value) return {};
  if (!value.is(JsonKind::number)) {
    fail_type(value, "a number", diagnostics);
    return {};
  }
  const double x = value.number();
  if (x >= min && x <= max) return x;
  const std::string range = max >= unlimited ? fmt::format("of {} or more", min) : fmt::format("from {} to {}", min, max);
  fail(diagnostics, value, "VALUE_OUT_OF_RANGE", fmt::format("expected a number {}, found {}", range, x));
  return {};
}

std::optional<bool> read_boolean(JsonValue value, Diagnostics& diagnostics) {
  if (!value) return {};
  if (value.is(JsonKind::boolean)) return value.boolean();
  fail_type(value, "true or false", diagnostics);
  return {};
}

std::optional<std::string> read_string(JsonValue value, Diagnostics& diagnostics) {
  if (!value) return {};
  if (value.is(JsonKind::string)) return std::string(value.string());
  fail_type(value, "a string", diagnostics);
  return {};
}

bool is_array(JsonValue value, std::size_t max_items, Diagnostics& diagnostics) {
  if (!value) return false;
  if (!value.is(JsonKind::array)) {
    fail_type(value, "an array", diagnostics);
    return false;
  }
  if (value.size() <= max_items) return true;
  fail(diagnostics, value, "TOO_MANY_ITEMS", fmt::format("expected at most {} elements, found {}", max_items, value.size()));
  return false;
}

std::optional<std::vector<double>> read_numbers(JsonValue value, std::size_t count, double min, double max, Diagnostics& diagnostics) {
  if (!value) return {};
  if (!value.is(JsonKind::array) || value.size() != count) {
    const std::string what = value.is(JsonKind::array) ? fmt::format("{} elements", value.size()) : found(value);
    fail(diagnostics, value, "TYPE_MISMATCH", fmt::format("expected an array of {} numbers, found {}", count, what));
    return {};
  }
  std::vector<double> numbers;
  for (const JsonValue element : value) {
    const std::optional<double> x = read_number(element, min, max, diagnostics);
    if (x) numbers.push_back(*x);
  }
  if (numbers.size() != count) return {};
  return numbers;
}

std::optional<Vec3d> read_vec3(JsonValue value, double min, double max, Diagnostics& diagnostics) {
  const std::optional<std::vector<double>> n = read_numbers(value, 3, min, max, diagnostics);
  if (!n) return {};
  return Vec3d{(*n)[0], (*n)[1], (*n)[2]};
}

std::optional<Vec3d> read_position(JsonValue value, Diagnostics& diagnostics) {
  if (!value) return {};
  if (!value.is(JsonKind::array) || value.size() != 3) {
    fail_type(value, "an array of 3 lengths", diagnostics);
    return {};
  }
  Vec3d position;
  bool complete = true;
  int axis = 0;
  for (const JsonValue element : value) {
    const std::optional<double> x = read_length(element, Bound::any, diagnostics);
    complete = complete && x.has_value();
    position[axis++] = x.value_or(0);
  }
  if (!complete) return {};
  return position;
}

void fail_choice(JsonValue value, const std::vector<std::string_view>& words, Diagnostics& diagnostics) {
  const std::string hint = value.is(JsonKind::string) ? nearest_hint(value.string(), words) : std::string();
  fail(diagnostics, value, "VALUE_UNKNOWN", fmt::format("expected one of {}, found {}", quoted(words), found(value)), hint);
}

}  // namespace etendue::rig
