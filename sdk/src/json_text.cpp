#include "json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

namespace etendue {
namespace {

constexpr std::size_t largest_text = std::numeric_limits<std::uint32_t>::max() - 1;

bool is_number_byte(char c) { return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.' || c == 'e' || c == 'E'; }

// nlohmann's "[json.exception.parse_error.101] parse error at line 1, column 3: syntax error ..." without what we say better ourselves.
std::string cause_of(std::string message) {
  const std::size_t bracket = message.find("] ");
  if (bracket != std::string::npos) message.erase(0, bracket + 2);
  const std::size_t place = message.find("parse error at ");
  if (place == 0) {
    const std::size_t colon = message.find(": ");
    if (colon != std::string::npos) message.erase(0, colon + 2);
  }
  return message;
}

}  // namespace

// Receives nlohmann's events. The parser does not say where a token stands, but the events come in the order of the text and only for
// valid tokens: what lies between two of them is white space, ',' and ':' alone, so a cursor that walks along finds every first byte.
class JsonBuilder {
 public:
  JsonBuilder(JsonDocument& document, std::string_view text, const JsonLimits& limits) : document_(document), text_(text), limits_(limits) {
    if (text_.substr(0, 3) == "\xEF\xBB\xBF") cursor_ = 3;
  }

  bool null() { return leaf(JsonKind::null, 4); }
  bool boolean(bool value) {
    if (!leaf(JsonKind::boolean, value ? 4 : 5)) return false;
    nodes().back().flag = value;
    return true;
  }
  bool number_integer(std::int64_t value) { return number(static_cast<double>(value)); }
  bool number_unsigned(std::uint64_t value) { return number(static_cast<double>(value)); }
  bool number_float(double value, const std::string&) { return number(value); }
  bool string(const std::string& value) {
    if (!add(JsonKind::string)) return false;
    skip_string();
    nodes().back().string = store(value);
    return true;
  }
  bool binary(std::vector<std::uint8_t>&) { return false; }  // not in JSON text

  bool start_object(std::size_t) { return open(JsonKind::object); }
  bool start_array(std::size_t) { return open(JsonKind::array); }
  bool key(const std::string& name) {
    skip_between();
    key_offset_ = cursor_;
    skip_string();
    key_ = store(name);
    return true;
  }
  bool end_object() {
    find_duplicates(open_.back());
    return close();
  }
  bool end_array() { return close(); }

  // `position` counts the bytes read, the end of the text included. A token that is well-formed but stands in the wrong place is reported
  // at its first byte, a malformed one at the byte that breaks it. `token` is that of the last string, number or literal: '[', '}', ','
  // and the like, one byte each, do not renew it.
  bool parse_error(std::size_t position, const std::string& token, const nlohmann::json::exception& exception) {
    const std::string cause = cause_of(exception.what());
    if (position == 0 || position > text_.size()) return fail("JSON_INVALID", cause, text_.size());
    const std::size_t last = position - 1;
    const bool malformed = cause.find("; last read: ") != std::string::npos;
    const bool one_byte = std::string_view("[]{},:").find(text_[last]) != std::string_view::npos;
    return fail("JSON_INVALID", cause,
                malformed || one_byte ? last : position - std::min(position, std::max<std::size_t>(token.size(), 1)));
  }

  Error error;

 private:
  std::vector<JsonDocument::Node>& nodes() { return document_.nodes_; }

  bool fail(std::string code, std::string what, std::size_t offset) {
    error = {std::move(code), std::move(what), document_.where(offset), {}, {}};
    return false;
  }

  void skip_between() {
    constexpr std::string_view between = " \t\r\n,:";
    while (cursor_ < text_.size() && between.find(text_[cursor_]) != std::string_view::npos) ++cursor_;
  }
  void skip_string() {
    ++cursor_;  // the opening quote
    while (cursor_ < text_.size() && text_[cursor_] != '"') cursor_ += text_[cursor_] == '\\' ? 2 : 1;
    ++cursor_;
  }
  JsonDocument::Slice store(const std::string& value) {
    const JsonDocument::Slice slice{static_cast<std::uint32_t>(document_.strings_.size()), static_cast<std::uint32_t>(value.size())};
    document_.strings_ += value;
    return slice;
  }

  // A new node at the cursor, which stays on the token's first byte.
  bool add(JsonKind kind) {
    skip_between();
    if (nodes().size() >= limits_.max_values) {
      return fail("JSON_TOO_LARGE", fmt::format("more than {} values", limits_.max_values), cursor_);
    }
    const auto index = static_cast<std::uint32_t>(nodes().size());
    JsonDocument::Node node;
    node.kind = kind;
    node.offset = static_cast<std::uint32_t>(cursor_);
    node.key_offset = node.offset;
    node.end = index + 1;
    if (!open_.empty()) {
      JsonDocument::Node& parent = nodes()[open_.back()];
      node.parent = open_.back();
      node.position = parent.count++;
      if (parent.kind == JsonKind::object) {
        node.key = key_;
        node.key_offset = static_cast<std::uint32_t>(key_offset_);
      }
    }
    nodes().push_back(node);
    return true;
  }
  bool leaf(JsonKind kind, std::size_t length) {
    if (!add(kind)) return false;
    cursor_ += length;
    return true;
  }
  bool number(double value) {
    if (!add(JsonKind::number)) return false;
    const std::size_t begin = cursor_;
    while (cursor_ < text_.size() && is_number_byte(text_[cursor_])) ++cursor_;
    const std::string_view token = text_.substr(begin, cursor_ - begin);
    nodes().back().flag = token.find_first_of(".eE") == std::string_view::npos;
    nodes().back().number = value == 0 && token.front() == '-' ? -0.0 : value;  // the parser reads -0 as the integer 0
    return true;
  }
  bool open(JsonKind kind) {
    if (open_.size() >= static_cast<std::size_t>(std::max(limits_.max_depth, 0))) {
      skip_between();
      return fail("JSON_TOO_DEEP", fmt::format("nested deeper than {} levels", limits_.max_depth), cursor_);
    }
    if (!leaf(kind, 1)) return false;
    open_.push_back(static_cast<std::uint32_t>(nodes().size() - 1));
    return true;
  }
  bool close() {
    skip_between();
    ++cursor_;
    nodes()[open_.back()].end = static_cast<std::uint32_t>(nodes().size());
    open_.pop_back();
    return true;
  }
  void find_duplicates(std::uint32_t object) {
    std::vector<std::pair<std::string_view, std::uint32_t>> keys;
    for (std::uint32_t i = object + 1; i < nodes().size(); i = nodes()[i].end) keys.emplace_back(document_.view(nodes()[i].key), i);
    std::sort(keys.begin(), keys.end());
    for (std::size_t i = 1; i < keys.size(); ++i)
      if (keys[i].first == keys[i - 1].first) document_.duplicates_.push_back(keys[i].second);
  }

  JsonDocument& document_;
  std::string_view text_;
  JsonLimits limits_;
  std::size_t cursor_ = 0;
  std::vector<std::uint32_t> open_;
  JsonDocument::Slice key_;
  std::size_t key_offset_ = 0;
};

Result<JsonDocument> JsonDocument::parse(std::string_view text, std::string file, const JsonLimits& limits) {
  JsonDocument document;
  document.file_ = std::move(file);
  if (text.size() > largest_text) return Error{"JSON_TOO_LARGE", "more than 4 GiB of JSON", {document.file_, 0, 0, {}}, {}, {}};
  document.line_starts_.push_back(0);
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '\n') document.line_starts_.push_back(static_cast<std::uint32_t>(i + 1));

  // No valid JSON text contains the byte 0, which the parser would take for the end of its input.
  const std::size_t zero = text.find('\0');
  if (zero != std::string_view::npos) return Error{"JSON_INVALID", "a byte of value 0", document.where(zero), {}, {}};

  JsonLimits bounded = limits;
  bounded.max_values = std::min(limits.max_values, largest_text);
  JsonBuilder builder(document, text, bounded);
  if (!nlohmann::json::sax_parse(text.begin(), text.end(), &builder)) return builder.error;
  std::sort(document.duplicates_.begin(), document.duplicates_.end());
  return document;
}

std::vector<JsonValue> JsonDocument::duplicate_keys() const {
  std::vector<JsonValue> values;
  values.reserve(duplicates_.size());
  for (const std::uint32_t index : duplicates_) values.push_back({this, index});
  return values;
}

Where JsonDocument::where(std::size_t offset) const {
  const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
  const auto line = static_cast<int>(after - line_starts_.begin());
  return {file_, line, static_cast<int>(offset - *(after - 1)) + 1, {}};
}

const char* name_of(JsonKind kind) {
  switch (kind) {
    case JsonKind::missing:
      return "nothing";
    case JsonKind::null:
      return "null";
    case JsonKind::boolean:
      return "true or false";
    case JsonKind::number:
      return "a number";
    case JsonKind::string:
      return "a string";
    case JsonKind::array:
      return "an array";
    case JsonKind::object:
      break;
  }
  return "an object";
}

JsonKind JsonValue::kind() const { return document_ ? document_->nodes_[index_].kind : JsonKind::missing; }
double JsonValue::number() const { return document_ ? document_->nodes_[index_].number : 0; }
bool JsonValue::is_integer() const { return is(JsonKind::number) && document_->nodes_[index_].flag; }
bool JsonValue::boolean() const { return is(JsonKind::boolean) && document_->nodes_[index_].flag; }
std::string_view JsonValue::string() const { return document_ ? document_->view(document_->nodes_[index_].string) : std::string_view(); }
std::string_view JsonValue::key() const { return document_ ? document_->view(document_->nodes_[index_].key) : std::string_view(); }
std::size_t JsonValue::size() const { return document_ ? document_->nodes_[index_].count : 0; }
std::size_t JsonValue::offset() const { return document_ ? document_->nodes_[index_].offset : 0; }

JsonValue JsonValue::find(std::string_view key) const {
  if (is(JsonKind::object))
    for (const JsonValue member : *this)
      if (member.key() == key) return member;
  return {};
}

JsonValue JsonValue::element(std::size_t position) const {
  if (!is(JsonKind::array) || position >= size()) return {};
  Iterator it = begin();
  for (std::size_t i = 0; i < position; ++i) ++it;
  return *it;
}

std::string JsonValue::pointer() const {
  if (!document_) return {};
  std::string text;  // from the last step to the first
  for (std::uint32_t i = index_; i != 0; i = document_->nodes_[i].parent) {
    const JsonDocument::Node& node = document_->nodes_[i];
    std::string step = "/";
    if (document_->nodes_[node.parent].kind == JsonKind::array) {
      step += std::to_string(node.position);
    } else {
      for (const char c : document_->view(node.key)) {  // RFC 6901, section 3: ~ and / are written ~0 and ~1
        if (c == '~' || c == '/') {
          step += c == '~' ? "~0" : "~1";
        } else {
          step += c;
        }
      }
    }
    text.insert(0, step);
  }
  return text;
}

Where JsonValue::where() const {
  if (!document_) return {};
  Where where = document_->where(document_->nodes_[index_].offset);
  where.pointer = pointer();
  return where;
}

Where JsonValue::where_key() const {
  if (!document_) return {};
  Where where = document_->where(document_->nodes_[index_].key_offset);
  where.pointer = pointer();
  return where;
}

JsonValue::Iterator& JsonValue::Iterator::operator++() {
  index_ = document_->nodes_[index_].end;
  return *this;
}
JsonValue::Iterator JsonValue::begin() const { return {document_, document_ ? index_ + 1 : 0}; }
JsonValue::Iterator JsonValue::end() const { return {document_, document_ ? document_->nodes_[index_].end : 0}; }

}  // namespace etendue
