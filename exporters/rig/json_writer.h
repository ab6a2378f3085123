// JSON text for people: members in the order of the calls, small things on one line, shortest numbers that read back as the same ones.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace etendue::rig {

class JsonWriter {
 public:
  enum class Style { one_line, one_item_a_line };

  void begin_object(Style style = Style::one_line) { open('{', style); }
  void end_object() { close('}'); }
  void begin_array(Style style = Style::one_line) { open('[', style); }
  void end_array() { close(']'); }
  void key(std::string_view name);

  void value(std::string_view text);
  void value(const char* text) { value(std::string_view(text)); }
  void value(bool truth);
  void value(double number);  // finite
  void value(float number);   // shortest among floats
  void value(std::uint32_t number);

  template <class T>
  void member(std::string_view name, const T& content) {
    key(name);
    value(content);
  }

  const std::string& text() const { return text_; }

 private:
  struct Level {
    Style style;
    bool empty = true;
  };
  void open(char bracket, Style style);
  void close(char bracket);
  void before_item();
  void new_line();
  void quote(std::string_view text);

  std::string text_;
  std::vector<Level> levels_;
  bool after_key_ = false;
};

}  // namespace etendue::rig
