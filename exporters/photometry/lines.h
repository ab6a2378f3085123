// Text of photometric files.
#pragma once

#include <fmt/format.h>

#include <span>
#include <string>

namespace etendue::photometric {

inline constexpr const char* eol = "\r\n";

// Shortest decimal text that reads back as the same double.
inline std::string number(double x) { return fmt::format("{}", x); }

// One line whatever the text holds.
inline std::string one_line(std::string text) {
  for (char& c : text)
    if (c == '\r' || c == '\n' || c == '\0' || c == '\x1a') c = ' ';
  return text;
}

// Numbers with blanks between, wrapped below 80 characters.
inline std::string wrapped(std::span<const double> numbers) {
  std::string text, line;
  constexpr std::size_t longest = 78;
  for (const double x : numbers) {
    const std::string one = number(x);
    if (!line.empty() && line.size() + 1 + one.size() > longest) {
      text += line + eol;
      line.clear();
    }
    line += (line.empty() ? "" : " ") + one;
  }
  return text + line + eol;
}

}  // namespace etendue::photometric
