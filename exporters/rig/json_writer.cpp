#include "json_writer.h"

#include <fmt/format.h>

namespace etendue::rig {

void JsonWriter::new_line() { text_ += '\n' + std::string(2 * levels_.size(), ' '); }

void JsonWriter::before_item() {
  if (after_key_) {
    after_key_ = false;
    return;
  }
  if (levels_.empty()) return;
  Level& level = levels_.back();
  if (!level.empty) text_ += ',';
  if (level.style == Style::one_item_a_line) {
    new_line();
  } else if (!level.empty) {
    text_ += ' ';
  }
  level.empty = false;
}

void JsonWriter::open(char bracket, Style style) {
  before_item();
  text_ += bracket;
  levels_.push_back({style});
}

void JsonWriter::close(char bracket) {
  const Level level = levels_.back();
  levels_.pop_back();
  if (level.style == Style::one_item_a_line && !level.empty) new_line();
  text_ += bracket;
}

void JsonWriter::key(std::string_view name) {
  before_item();
  quote(name);
  text_ += ": ";
  after_key_ = true;
}

void JsonWriter::quote(std::string_view text) {
  text_ += '"';
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      text_ += '\\';
      text_ += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      text_ += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      text_ += c;
    }
  }
  text_ += '"';
}

void JsonWriter::value(std::string_view text) {
  before_item();
  quote(text);
}
void JsonWriter::value(bool truth) {
  before_item();
  text_ += truth ? "true" : "false";
}
void JsonWriter::value(double number) {
  before_item();
  text_ += fmt::format("{}", number);
}
void JsonWriter::value(float number) {
  before_item();
  text_ += fmt::format("{}", number);
}
void JsonWriter::value(std::uint32_t number) {
  before_item();
  text_ += fmt::format("{}", number);
}

}  // namespace etendue::rig
