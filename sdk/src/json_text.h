// JSON that remembers where it stood: every value knows its line, its column and its JSON pointer.
// Values keep the order of the file. A document is one flat array in document order; JsonValue is a handle into it.
#pragma once

#include "etendue/result.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

enum class JsonKind : std::uint8_t { missing, null, boolean, number, string, array, object };
const char* name_of(JsonKind kind);  // "a number", for messages

struct JsonLimits {
  int max_depth = 256;
  std::size_t max_values = 100'000'000;
};

class JsonDocument;

// A value of a document, or `missing`. Cheap to copy; valid as long as its document stays where it is.
class JsonValue {
 public:
  JsonValue() = default;

  JsonKind kind() const;
  explicit operator bool() const { return document_ != nullptr; }
  bool is(JsonKind kind) const { return this->kind() == kind; }

  double number() const;            // 0 unless a number; never infinite
  bool is_integer() const;          // a number that was written without fraction and exponent
  bool boolean() const;             // false unless true
  std::string_view string() const;  // "" unless a string

  std::string_view key() const;                   // of a member of an object, else ""
  std::size_t size() const;                       // of an array or object, else 0
  JsonValue find(std::string_view key) const;     // the first member of that name, or missing
  JsonValue element(std::size_t position) const;  // of an array, or missing; takes time proportional to `position`

  std::size_t offset() const;   // of the value's first byte
  std::string pointer() const;  // RFC 6901
  Where where() const;          // of the value
  Where where_key() const;      // of the member's name; of the value if it is no member

  // Elements or members in the order of the file: for (JsonValue v : array) ...
  class Iterator {
   public:
    JsonValue operator*() const { return {document_, index_}; }
    Iterator& operator++();
    friend bool operator==(const Iterator&, const Iterator&) = default;

   private:
    friend class JsonValue;
    Iterator(const JsonDocument* document, std::uint32_t index) : document_(document), index_(index) {}
    const JsonDocument* document_;
    std::uint32_t index_;
  };
  Iterator begin() const;
  Iterator end() const;

 private:
  friend class JsonDocument;
  JsonValue(const JsonDocument* document, std::uint32_t index) : document_(document), index_(index) {}
  const JsonDocument* document_ = nullptr;
  std::uint32_t index_ = 0;
};

class JsonDocument {
 public:
  // RFC 8259, UTF-8; a byte order mark is skipped. `file` only names the input in messages. Errors, each with line and column:
  // JSON_INVALID (also for invalid UTF-8, numbers beyond double, anything after the value), JSON_TOO_DEEP, JSON_TOO_LARGE.
  static Result<JsonDocument> parse(std::string_view text, std::string file, const JsonLimits& limits = {});

  JsonValue root() const { return {this, 0}; }
  // The second and later members of the same name in one object, in the order of the file. Whether that is an error is the caller's choice.
  std::vector<JsonValue> duplicate_keys() const;
  // Line and column of a byte of the text.
  Where where(std::size_t offset) const;

 private:
  friend class JsonValue;
  friend class JsonBuilder;
  struct Slice {
    std::uint32_t begin = 0, size = 0;  // in strings_
  };
  struct Node {
    JsonKind kind = JsonKind::null;
    bool flag = false;         // the boolean; for numbers: written as an integer
    std::uint32_t offset = 0;  // in the text, of the value
    std::uint32_t key_offset = 0;
    std::uint32_t parent = 0;    // the root is its own
    std::uint32_t position = 0;  // among its siblings
    std::uint32_t end = 0;       // one behind its last descendant: the next sibling, if there is one
    std::uint32_t count = 0;     // children
    Slice key;
    Slice string;
    double number = 0;
  };
  std::string_view view(const Slice& slice) const { return std::string_view(strings_).substr(slice.begin, slice.size); }

  std::string file_;
  std::vector<Node> nodes_;  // document order: a container, then its descendants
  std::string strings_;      // all keys and strings, one behind the other
  std::vector<std::uint32_t> duplicates_;
  std::vector<std::uint32_t> line_starts_;
};

}  // namespace etendue
