#include "schema.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace etendue::gltf {
namespace {

using Json = nlohmann::json;

const char* kind_name(Kind kind) {
  switch (kind) {
    case Kind::any:
      return "a value";
    case Kind::boolean:
      return "a boolean";
    case Kind::integer:
      return "an integer (without a decimal point)";
    case Kind::number:
      return "a number";
    case Kind::string:
      return "a string";
    case Kind::strings:
      return "an array of strings";
    case Kind::numbers:
      return "an array of numbers";
    case Kind::index:
      return "an index";
    case Kind::indices:
      return "an array of indices";
    case Kind::named_indices:
      return "an object of indices";
    case Kind::object:
      return "an object";
    case Kind::objects:
      break;
  }
  return "an array of objects";
}

// JSON Schema counts 3.0 as an integer; tinygltf would take it for an absent property.
bool is_integer(const Json& value) { return value.is_number_integer(); }

std::string shown(const Json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return fmt::format("an array of {}", value.size());
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

class Checker {
 public:
  Checker(const Json& root, std::size_t max_items) : root_(root), max_items_(max_items) {}

  void object(const Json& value, const std::string& type, const std::string& pointer) {
    const std::vector<Property>* properties = properties_of(type);
    if (properties == nullptr) return;
    for (const Property& property : *properties) {
      const auto found = value.find(property.name);
      if (found != value.end()) {
        member(*found, property, pointer_to(pointer, property.name));
      } else if (property.required) {
        add(Severity::error, "UNDEFINED_PROPERTY", fmt::format("expected the property \"{}\", which is missing", property.name), pointer);
      }
    }
    for (const auto& [key, member_value] : value.items()) {
      if (key == "extensions") {
        extensions(member_value, type, pointer_to(pointer, key));
      } else if (key != "extras" &&
                 std::none_of(properties->begin(), properties->end(), [&k = key](const Property& p) { return k == p.name; })) {
        add(Severity::warning, "UNEXPECTED_PROPERTY", fmt::format("glTF knows no property \"{}\" here; it is ignored", key),
            pointer_to(pointer, key));
      }
    }
  }

  SchemaFindings findings;

 private:
  void add(Severity severity, const char* code, std::string text, const std::string& pointer) {
    std::size_t& count = severity == Severity::error ? errors_ : warnings_;
    if (++count > max_findings) return;
    findings.diagnostics.push_back({severity, code, std::move(text), {"", 0, 0, pointer}, {}});
  }
  void error(const char* code, std::string text, const std::string& pointer) { add(Severity::error, code, std::move(text), pointer); }
  void wrong_type(const Json& value, Kind kind, const std::string& pointer) {
    error("TYPE_MISMATCH", fmt::format("expected {}, found {}", kind_name(kind), shown(value)), pointer);
  }

  void extensions(const Json& value, const std::string& type, const std::string& pointer) {
    if (!value.is_object()) return wrong_type(value, Kind::object, pointer);
    for (const auto& [name, content] : value.items()) {
      const std::string here = pointer_to(pointer, name);
      findings.extensions.push_back({name, here});
      if (!content.is_object()) {
        wrong_type(content, Kind::object, here);
      } else {
        object(content, fmt::format("{}.{}", type, name), here);
      }
    }
  }

  void member(const Json& value, const Property& property, const std::string& pointer) {
    switch (property.kind) {
      case Kind::any:
        return;
      case Kind::boolean:
        if (!value.is_boolean()) wrong_type(value, property.kind, pointer);
        return;
      case Kind::integer:
        if (!is_integer(value)) return wrong_type(value, property.kind, pointer);
        return range(value, property, pointer);
      case Kind::number:
        if (!value.is_number()) return wrong_type(value, property.kind, pointer);
        return range(value, property, pointer);
      case Kind::string:
        if (!value.is_string()) return wrong_type(value, property.kind, pointer);
        if (const auto& all = property.strings; !all.empty() && std::find(all.begin(), all.end(), value.get<std::string>()) == all.end())
          error("VALUE_NOT_IN_LIST", fmt::format("expected one of {}, found {}", fmt::join(all, ", "), shown(value)), pointer);
        return;
      case Kind::index:
        return index(value, property, pointer);
      case Kind::object:
        if (!value.is_object()) return wrong_type(value, property.kind, pointer);
        return object(value, property.of, pointer);
      case Kind::named_indices:
        if (!value.is_object()) return wrong_type(value, property.kind, pointer);
        if (value.empty()) return error("EMPTY_ENTITY", "expected at least one member, found none", pointer);
        for (const auto& [key, one] : value.items()) index(one, property, pointer_to(pointer, key));
        return;
      case Kind::strings:
      case Kind::numbers:
      case Kind::indices:
      case Kind::objects:
        return array(value, property, pointer);
    }
  }

  void array(const Json& value, const Property& property, const std::string& pointer) {
    if (!value.is_array()) return wrong_type(value, property.kind, pointer);
    if (value.empty()) return error("EMPTY_ENTITY", "expected at least one element, found none", pointer);
    if (value.size() > max_items_)
      return error("LIMIT_EXCEEDED", fmt::format("{} elements are over the limit of {}", value.size(), max_items_), pointer);
    if (property.length != 0 && value.size() != property.length)
      return error("ARRAY_LENGTH_NOT_IN_LIST", fmt::format("expected {} numbers, found {}", property.length, value.size()), pointer);
    std::set<double> seen;
    for (std::size_t i = 0; i < value.size(); ++i) {
      const Json& one = value[i];
      const std::string here = pointer + "/" + std::to_string(i);
      if (property.kind == Kind::strings) {
        if (!one.is_string()) wrong_type(one, Kind::string, here);
      } else if (property.kind == Kind::numbers) {
        if (!one.is_number()) {
          wrong_type(one, Kind::number, here);
        } else {
          range(one, property, here);
        }
      } else if (property.kind == Kind::objects) {
        if (!one.is_object()) {
          wrong_type(one, Kind::object, here);
        } else {
          object(one, property.of, here);
        }
      } else {
        index(one, property, here);
        if (is_integer(one) && !seen.insert(one.get<double>()).second)
          error("ARRAY_DUPLICATE_ELEMENTS", fmt::format("the index {} stands here twice", shown(one)), here);
      }
    }
  }

  void range(const Json& value, const Property& property, const std::string& pointer) {
    const double x = value.get<double>();
    if (!property.values.empty()) {
      if (std::find(property.values.begin(), property.values.end(), x) == property.values.end())
        error("VALUE_NOT_IN_LIST", fmt::format("expected one of {}, found {}", fmt::join(property.values, ", "), shown(value)), pointer);
      return;
    }
    // Sizes and indices pass through 32-bit and 53-bit numbers on their way.
    const double max = property.kind == Kind::integer ? std::min(property.max, 9007199254740991.0) : property.max;
    if (x >= property.min && x <= max) return;
    const bool positive = property.min > 0 && property.min < 1e-300;
    const std::string expected = positive ? "a number above 0" : fmt::format("a number from {} to {}", property.min, max);
    error("VALUE_NOT_IN_RANGE", fmt::format("expected {}, found {}", expected, shown(value)), pointer);
  }

  void index(const Json& value, const Property& property, const std::string& pointer) {
    if (!is_integer(value)) return wrong_type(value, Kind::index, pointer);
    const Json::json_pointer target(property.of);
    const Json* array = root_.contains(target) ? &root_.at(target) : nullptr;
    const std::size_t size = array != nullptr && array->is_array() ? array->size() : 0;
    const double x = value.get<double>();
    if (!(x >= 0 && x < static_cast<double>(size)))
      error("UNRESOLVED_REFERENCE",
            fmt::format("expected an index into {}, which has {} elements, found {}", property.of, size, shown(value)), pointer);
  }

  const Json& root_;
  std::size_t max_items_, errors_ = 0, warnings_ = 0;
};

}  // namespace

SchemaFindings check_schema(const Json& root, std::size_t max_items) {
  Checker checker(root, max_items);
  checker.object(root, "glTF", "");
  return std::move(checker.findings);
}

std::string pointer_to(const std::string& parent, const std::string& key) {
  std::string pointer = parent + "/";
  for (const char c : key) {
    if (c == '~') {
      pointer += "~0";
    } else if (c == '/') {
      pointer += "~1";
    } else {
      pointer += c;
    }
  }
  return pointer;
}

}  // namespace etendue::gltf
