// A JSON text with other values in it: whatever did not change keeps its bytes, numbers, blanks and order included.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace etendue::gltf {

using Json = nlohmann::ordered_json;

// `text` is valid JSON and `before` what it says; the result says `now`. New members come behind the others, in the indentation of their
// neighbours.
std::string edited(std::string_view text, const Json& before, const Json& now);

}  // namespace etendue::gltf
