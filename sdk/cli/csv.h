// Fields of CSV rows.
#pragma once

#include <string>
#include <string_view>

namespace etendue::cli {

// RFC 4180: in quotes where needed, a quote doubled.
inline void append_field(std::string& out, std::string_view text) {
  if (text.find_first_of(",\"\n\r") == std::string_view::npos) {
    out += text;
    return;
  }
  out += '"';
  for (const char c : text) {
    out += c;
    if (c == '"') out += '"';
  }
  out += '"';
}

}  // namespace etendue::cli
