// Reading the values of a rig file: each function says what is wrong, where, and what was expected, and then gives nothing back, so that
// the reader goes on and finds every mistake of a file.
#pragma once

#include "etendue/units.h"
#include "etendue/vec.h"
#include "json_text.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace etendue::rig {

// An error at a value (at the object that lacks it, if it is missing).
void fail(Diagnostics& diagnostics, JsonValue at, std::string code, std::string text, std::string hint = {});
void warn(Diagnostics& diagnostics, JsonValue at, std::string code, std::string text);

// "did you mean 'rect'?" for the nearest of `known`, or "" if none is near.
std::string nearest_hint(std::string_view word, const std::vector<std::string_view>& known);

// One JSON object. Every key that is asked for is a known one; finish() reports the others.
class Fields {
 public:
  // Reports a value that is no object; then every key is missing.
  Fields(JsonValue object, Diagnostics& diagnostics);

  JsonValue object() const { return object_; }
  bool valid() const { return object_.is(JsonKind::object); }
  JsonValue find(std::string_view key);
  // The same; reports its absence.
  JsonValue require(std::string_view key);
  // Which of the keys is there; reports more than one. Missing if none is.
  JsonValue one_of(const std::vector<std::string_view>& keys);
  void finish();

 private:
  JsonValue object_;
  Diagnostics& diagnostics_;
  std::vector<std::string_view> known_;
};

enum class Bound { any, not_negative, positive };

// A missing value gives nothing without a word: what is required was reported by Fields.
std::optional<double> read_quantity(JsonValue value, Dimension dimension, Bound bound, Diagnostics& diagnostics);
// Text with a unit, or a plain number of metres.
std::optional<double> read_length(JsonValue value, Bound bound, Diagnostics& diagnostics);
std::optional<double> read_number(JsonValue value, double min, double max, Diagnostics& diagnostics);
std::optional<bool> read_boolean(JsonValue value, Diagnostics& diagnostics);
std::optional<std::string> read_string(JsonValue value, Diagnostics& diagnostics);
// An array of exactly `count` numbers, each within [min, max].
std::optional<std::vector<double>> read_numbers(JsonValue value, std::size_t count, double min, double max, Diagnostics& diagnostics);
std::optional<Vec3d> read_vec3(JsonValue value, double min, double max, Diagnostics& diagnostics);
std::optional<Vec3d> read_position(JsonValue value, Diagnostics& diagnostics);  // three lengths
// Reports a value that is no array, or has more than `max_items` elements.
bool is_array(JsonValue value, std::size_t max_items, Diagnostics& diagnostics);

template <class T>
using Choices = std::vector<std::pair<std::string_view, T>>;

void fail_choice(JsonValue value, const std::vector<std::string_view>& words, Diagnostics& diagnostics);

template <class T>
std::optional<T> read_choice(JsonValue value, const Choices<T>& choices, Diagnostics& diagnostics) {
  if (!value) return {};
  std::vector<std::string_view> words;
  for (const auto& [word, meaning] : choices) {
    if (value.is(JsonKind::string) && value.string() == word) return meaning;
    words.push_back(word);
  }
  fail_choice(value, words, diagnostics);
  return {};
}

// "translation", "rotation" (unit quaternion x y z w, within 1e-3), and, if asked for, "scale" (number or [x, y, z]) or the whole as
// "matrix" (16 numbers column by column, as in glTF).
Transform read_transform(Fields& fields, bool with_scale, Diagnostics& diagnostics);
std::optional<Vec3d> read_scale(JsonValue value, Diagnostics& diagnostics);
std::optional<Quat> read_rotation(JsonValue value, Diagnostics& diagnostics);

}  // namespace etendue::rig
