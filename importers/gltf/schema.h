// What may stand in a glTF document: a table of objects, and the check of a document against it. It comes before tinygltf, which takes
// wrong types for absent properties, leaves out primitives that it dislikes, and follows any index.
#pragma once

#include "findings.h"

#include <nlohmann/json_fwd.hpp>

#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace etendue::gltf {

enum class Kind {
  any,
  boolean,
  integer,
  number,
  string,
  strings,  // distinct ones
  numbers,
  index,               // into the array at `of`
  indices,             // distinct ones
  named_indices,       // an object whose values are indices
  named_indices_list,  // an array of those
  object,              // of the type `of`
  objects
};

struct Property {
  const char* name;
  Kind kind;
  const char* of = "";  // a JSON pointer for indices, a type of object for objects
  bool required = false;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::size_t length = 0;                                  // of `numbers`; 0: any
  std::vector<double> values = {};                         // if not empty: the only ones known
  std::vector<std::string> strings = {};                   // likewise
  double also = std::numeric_limits<double>::quiet_NaN();  // allowed though outside of min to max
  bool (*matches)(std::string_view) = nullptr;             // of strings
};

// The properties of a type of object, `extensions` and `extras` aside; nullptr if the table has no such type. The object of an extension
// is the type "node.KHR_lights_punctual" for one that stands in a "node".
const std::vector<Property>* properties_of(const std::string& type);
using SchemaTable = std::map<std::string, std::vector<Property>>;
SchemaTable core_schema();
SchemaTable extension_schema();

// Whether the table says where objects of the extension may stand.
bool is_known_extension(std::string_view name);

struct ExtensionUse {
  std::string name, pointer;
};
struct SchemaFindings {
  std::vector<ExtensionUse> extensions;           // every member of every "extensions" object
  std::map<std::string, std::vector<bool>> used;  // by the pointer of an array: what an index points to
};

// Types, required properties, ranges, enumerations, places of extensions, and that every index points to something. Codes and severities
// are the validator's. An integer that is written as 3.0 (which JSON Schema allows) becomes 3.
SchemaFindings check_schema(nlohmann::json& root, std::size_t max_items, Findings& findings);

}  // namespace etendue::gltf
