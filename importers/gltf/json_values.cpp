#include "json_values.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace etendue::gltf {
namespace {

const Json* member_of(const Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

}  // namespace

bool as_integer(Json& value) {
  if (value.is_number_integer()) return true;
  if (!value.is_number_float()) return false;
  const auto x = value.get<double>();
  if (std::floor(x) != x) return false;
  if (std::abs(x) <= largest_integer) value = static_cast<std::int64_t>(x);
  return true;
}

std::string shown(const Json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return fmt::format("an array of {}", value.size());
  std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

std::optional<std::uint64_t> uint_of(const Json& object, const char* key) {
  const Json* found = member_of(object, key);
  if (found == nullptr || !found->is_number_integer()) return std::nullopt;
  const auto x = found->get<double>();
  if (!(x >= 0 && x <= largest_integer)) return std::nullopt;
  return found->get<std::uint64_t>();
}

std::int64_t index_of(const Json& object, const char* key) {
  const auto found = uint_of(object, key);
  return found ? static_cast<std::int64_t>(*found) : -1;
}

int int_index_of(const Json& object, const char* key, int otherwise) {
  const auto found = uint_of(object, key);
  return found && *found <= std::numeric_limits<int>::max() ? static_cast<int>(*found) : otherwise;
}

const std::string* text_of(const Json& object, const char* key) {
  const Json* found = member_of(object, key);
  return found != nullptr && found->is_string() ? &found->get_ref<const std::string&>() : nullptr;
}

const Json& array_at(const Json& object, const char* key) {
  static const Json none = Json::array();
  const Json* found = member_of(object, key);
  return found != nullptr && found->is_array() ? *found : none;
}

const Json& object_at(const Json& object, const char* key) {
  static const Json none = Json::object();
  const Json* found = member_of(object, key);
  return found != nullptr && found->is_object() ? *found : none;
}

bool is_true(const Json& object, const char* key) {
  const Json* found = member_of(object, key);
  return found != nullptr && found->is_boolean() && found->get<bool>();
}

}  // namespace etendue::gltf
