#include "schema.h"

#include <algorithm>
#include <set>
#include <unordered_set>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "json_values.h"

namespace etendue::gltf {
namespace {

const char* kind_name(Kind kind) {
  switch (kind) {
    case Kind::any:
      return "a value";
    case Kind::boolean:
      return "a boolean";
    case Kind::integer:
      return "an integer";
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
    case Kind::named_indices_list:
      return "an array of objects of indices";
    case Kind::object:
      return "an object";
    case Kind::objects:
      break;
  }
  return "an array of objects";
}

class Checker {
 public:
  Checker(Json& root, std::size_t max_items, Findings& findings) : root_(root), max_items_(max_items), findings_(findings) {
    for (const Json& name : array_at(root, "extensionsUsed"))
      if (name.is_string()) declared_.insert(name.get<std::string>());
  }

  void object(Json& value, const std::string& type, const Path& path) {
    const std::vector<Property>* properties = properties_of(type);
    if (properties == nullptr) return;
    for (const Property& property : *properties) {
      const auto found = value.find(property.name);
      if (found != value.end()) {
        member(*found, property, path / property.name);
      } else if (property.required) {
        findings_.error("UNDEFINED_PROPERTY", fmt::format("expected the property \"{}\", which is missing", property.name), path);
      }
    }
    for (auto it = value.begin(); it != value.end(); ++it) {
      const std::string& key = it.key();
      if (key == "extensions") {
        extensions(*it, type, path / key);
      } else if (key == "extras") {
        if (!it->is_object()) findings_.note("NON_OBJECT_EXTRAS", "extras should be an object", path / key);
      } else if (std::none_of(properties->begin(), properties->end(), [&](const Property& p) { return key == p.name; })) {
        findings_.warning("UNEXPECTED_PROPERTY", fmt::format("glTF knows no property \"{}\" here; it is ignored", key), path / key);
      }
    }
  }

  SchemaFindings result;

 private:
  void wrong_type(const Json& value, Kind kind, const Path& path) {
    findings_.error("TYPE_MISMATCH", fmt::format("expected {}, found {}", kind_name(kind), shown(value)), path);
  }
  void wrong_element(const Json& value, const char* expected, const Path& path) {
    findings_.error("ARRAY_TYPE_MISMATCH", fmt::format("expected {}, found {}", expected, shown(value)), path);
  }

  void extensions(Json& value, const std::string& type, const Path& path) {
    if (!value.is_object()) return wrong_type(value, Kind::object, path);
    for (auto it = value.begin(); it != value.end(); ++it) {
      const std::string& name = it.key();
      const Path here = path / name;
      result.extensions.push_back({name, here.text()});
      if (!it->is_object()) {
        wrong_type(*it, Kind::object, here);
        continue;
      }
      if (!declared_.contains(name)) findings_.error("UNDECLARED_EXTENSION", fmt::format("expected \"{}\" in extensionsUsed", name), here);
      if (const std::string full = fmt::format("{}.{}", type, name); properties_of(full) != nullptr) {
        if (value.size() > 1 && (name == "KHR_materials_unlit" || name == "KHR_materials_pbrSpecularGlossiness"))
          findings_.warning("MULTIPLE_EXTENSIONS", fmt::format("{} may contradict the other extensions of this object", name), here);
        object(*it, full, here);
      } else if (is_known_extension(name)) {
        findings_.error("UNEXPECTED_EXTENSION_OBJECT", fmt::format("{} has no meaning here", name), here);
      }
    }
  }

  void member(Json& value, const Property& property, const Path& path) {
    switch (property.kind) {
      case Kind::any:
        return;
      case Kind::boolean:
        if (!value.is_boolean()) wrong_type(value, property.kind, path);
        return;
      case Kind::integer:
        if (!as_integer(value)) return wrong_type(value, property.kind, path);
        return range(value, property, path);
      case Kind::number:
        if (!value.is_number()) return wrong_type(value, property.kind, path);
        return range(value, property, path);
      case Kind::string:
        return text(value, property, path);
      case Kind::index:
        if (!as_integer(value)) return wrong_type(value, Kind::index, path);
        return index(value, property, path);
      case Kind::object:
        if (!value.is_object()) return wrong_type(value, property.kind, path);
        return object(value, property.of, path);
      case Kind::named_indices:
        if (!value.is_object()) return wrong_type(value, property.kind, path);
        return named_indices(value, property, path);
      case Kind::strings:
      case Kind::numbers:
      case Kind::indices:
      case Kind::objects:
      case Kind::named_indices_list:
        return array(value, property, path);
    }
  }

  void text(const Json& value, const Property& property, const Path& path) {
    if (!value.is_string()) return wrong_type(value, property.kind, path);
    const auto& content = value.get_ref<const std::string&>();
    if (const auto& all = property.strings; !all.empty() && std::find(all.begin(), all.end(), content) == all.end())
      findings_.warning("VALUE_NOT_IN_LIST", fmt::format("expected one of {}, found {}", fmt::join(all, ", "), shown(value)), path);
    if (property.matches != nullptr && !property.matches(content))
      findings_.error("PATTERN_MISMATCH", fmt::format("{} is not written as it should be: {}", property.name, shown(value)), path);
  }

  void named_indices(Json& value, const Property& property, const Path& path) {
    if (value.empty()) return findings_.error("EMPTY_ENTITY", "expected at least one member, found none", path);
    for (auto it = value.begin(); it != value.end(); ++it) {
      const Path here = path / it.key();
      if (!as_integer(*it)) {
        findings_.error("INVALID_INDEX", fmt::format("expected an index, found {}", shown(*it)), here);
      } else {
        index(*it, property, here);
      }
    }
  }

  void array(Json& value, const Property& property, const Path& path) {
    if (!value.is_array()) return wrong_type(value, property.kind, path);
    if (value.empty()) return findings_.error("EMPTY_ENTITY", "expected at least one element, found none", path);
    if (value.size() > max_items_)
      return findings_.error(limit_exceeded(fmt::format("an array of {} elements", value.size()), "max_items", max_items_), path);
    if (property.length != 0 && value.size() != property.length)
      return findings_.error("ARRAY_LENGTH_NOT_IN_LIST", fmt::format("expected {} numbers, found {}", property.length, value.size()), path);
    std::set<Json> seen;  // of strings and indices
    for (std::size_t i = 0; i < value.size(); ++i) {
      element(value[i], property, path / i);
      const bool distinct = property.kind == Kind::strings || property.kind == Kind::indices;
      if (distinct && !seen.insert(value[i]).second)
        findings_.error("DUPLICATE_ELEMENTS", fmt::format("{} stands here twice", shown(value[i])), path / i);
    }
  }

  void element(Json& value, const Property& property, const Path& path) {
    switch (property.kind) {
      case Kind::strings:
        if (!value.is_string()) wrong_element(value, "a string", path);
        return;
      case Kind::numbers:
        if (!value.is_number()) return wrong_element(value, "a number", path);
        return range(value, property, path);
      case Kind::indices:
        if (!as_integer(value)) return findings_.error("INVALID_INDEX", fmt::format("expected an index, found {}", shown(value)), path);
        return index(value, property, path);
      default:
        if (!value.is_object()) {
          const bool is_top = path.parent->parent->parent == nullptr;  // an element of "/meshes" and the like
          return is_top ? wrong_type(value, Kind::object, path) : wrong_element(value, "an object", path);
        }
        if (property.kind == Kind::objects) return object(value, property.of, path);
        return named_indices(value, property, path);
    }
  }

  void range(const Json& value, const Property& property, const Path& path) {
    const double x = value.get<double>();
    if (!property.values.empty()) {
      if (std::find(property.values.begin(), property.values.end(), x) == property.values.end())
        findings_.warning("VALUE_NOT_IN_LIST", fmt::format("expected one of {}, found {}", fmt::join(property.values, ", "), shown(value)),
                          path);
      return;
    }
    // Beyond 2^53 - 1 a double no longer tells integers apart (glTF 2.0, 2.7 forbids them).
    const double max = property.kind == Kind::integer ? std::min(property.max, largest_integer) : property.max;
    if ((x >= property.min && x <= max) || x == property.also) return;
    const bool positive = property.min > 0 && property.min < 1e-300;
    const std::string expected = positive && std::isinf(max) ? "a number above 0"
                                 : positive                  ? fmt::format("a number above 0 and up to {}", max)
                                                             : fmt::format("a number from {} to {}", property.min, max);
    findings_.error("VALUE_NOT_IN_RANGE", fmt::format("expected {}, found {}", expected, shown(value)), path);
  }

  void index(const Json& value, const Property& property, const Path& path) {
    const double x = value.get<double>();
    if (x < 0) return findings_.error("INVALID_INDEX", fmt::format("expected an index, found {}", shown(value)), path);
    const Json::json_pointer target(property.of);
    const Json* array = root_.contains(target) ? &root_.at(target) : nullptr;
    if (array == nullptr && std::string_view(property.of).starts_with("/extensions/") && !root_.contains(target.parent_pointer()))
      return findings_.error("UNSATISFIED_DEPENDENCY", fmt::format("expected {}, which is missing", property.of), path);
    const std::size_t size = array != nullptr && array->is_array() ? array->size() : 0;
    if (!(x < static_cast<double>(size)))
      return findings_.error("UNRESOLVED_REFERENCE",
                             fmt::format("expected an index into {}, which has {} elements, found {}", property.of, size, shown(value)),
                             path);
    std::vector<bool>& used = result.used[property.of];
    used.resize(size);
    used[static_cast<std::size_t>(x)] = true;
  }

  Json& root_;
  std::size_t max_items_;
  Findings& findings_;
  std::unordered_set<std::string> declared_;
};

}  // namespace

SchemaFindings check_schema(Json& root, std::size_t max_items, Findings& findings) {
  Checker checker(root, max_items, findings);
  checker.object(root, "glTF", {});
  return std::move(checker.result);
}

const std::vector<Property>* properties_of(const std::string& type) {
  static const SchemaTable table = [] {
    SchemaTable all = core_schema();
    all.merge(extension_schema());
    return all;
  }();
  const auto found = table.find(type);
  return found == table.end() ? nullptr : &found->second;
}

}  // namespace etendue::gltf
