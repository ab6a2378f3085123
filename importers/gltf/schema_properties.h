// How the tables of the schema are written down.
#pragma once

#include "schema.h"

#include <utility>

namespace etendue::gltf {

constexpr double infinite = std::numeric_limits<double>::infinity();
// "greater than 0" of the schemas.
constexpr double above_zero = std::numeric_limits<double>::denorm_min();

inline Property any(const char* name) { return {name, Kind::any}; }
inline Property boolean(const char* name) { return {name, Kind::boolean}; }
inline Property string(const char* name) { return {name, Kind::string}; }
inline Property matching(const char* name, bool (*matches)(std::string_view)) {
  Property property{name, Kind::string};
  property.matches = matches;
  return property;
}
inline Property strings(const char* name) { return {name, Kind::strings}; }
inline Property one_of(const char* name, std::vector<std::string> known) {
  return {name, Kind::string, "", false, 0, 0, 0, {}, std::move(known)};
}
inline Property integer(const char* name, double min = 0, double max = infinite) { return {name, Kind::integer, "", false, min, max}; }
inline Property code(const char* name, std::vector<double> known) {
  return {name, Kind::integer, "", false, -infinite, infinite, 0, std::move(known)};
}
inline Property number(const char* name, double min = -infinite, double max = infinite) {
  return {name, Kind::number, "", false, min, max};
}
inline Property numbers(const char* name, std::size_t length = 0, double min = -infinite, double max = infinite) {
  return {name, Kind::numbers, "", false, min, max, length};
}
inline Property index(const char* name, const char* array) { return {name, Kind::index, array}; }
inline Property indices(const char* name, const char* array) { return {name, Kind::indices, array}; }
inline Property named_indices(const char* name, const char* array) { return {name, Kind::named_indices, array}; }
inline Property object(const char* name, const char* type) { return {name, Kind::object, type}; }
inline Property objects(const char* name, const char* type) { return {name, Kind::objects, type}; }
inline Property required(Property property) {
  property.required = true;
  return property;
}

}  // namespace etendue::gltf
