// Messages name quantities and shapes: "an illuminance", "a luminance".
#pragma once

#include <string>
#include <string_view>

namespace etendue {

inline std::string with_article(std::string_view noun) {
  const bool vowel = !noun.empty() && std::string_view("aeio").find(noun.front()) != std::string_view::npos;
  return (vowel ? "an " : "a ") + std::string(noun);
}

}  // namespace etendue
