// Small questions to JSON values, which never throw.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace etendue::gltf {

using Json = nlohmann::json;

constexpr double largest_integer = 9007199254740991.0;  // 2^53 - 1

// Whether the value is an integer; one that is written as 3.0 or 3e0 becomes 3.
bool as_integer(Json& value);

// For messages: short, whatever the value.
std::string shown(const Json& value);

// A member that is an integer from 0 to 2^53 - 1.
std::optional<std::uint64_t> uint_of(const Json& object, const char* key);
// A member that may be an index; -1 if it is none.
std::int64_t index_of(const Json& object, const char* key);
// The same as an int, which tinygltf's indices are: one that is none, or beyond, is `otherwise`.
int int_index_of(const Json& object, const char* key, int otherwise = -1);
// A member that is a string; nullptr if there is none.
const std::string* text_of(const Json& object, const char* key);

// A member that is an array (with at least one element) or an object; an empty one if there is none.
const Json& array_at(const Json& object, const char* key);
const Json& object_at(const Json& object, const char* key);
bool is_true(const Json& object, const char* key);

}  // namespace etendue::gltf
