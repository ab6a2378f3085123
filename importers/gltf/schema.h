// What may stand in a glTF document: a table of objects, and the check of a document against it. It comes before tinygltf, which takes
// wrong types for absent properties, leaves out primitives that it dislikes, and follows any index.
#pragma once

#include "etendue/result.h"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace etendue::gltf {

enum class Kind {
  any,
  boolean,
  integer,
  number,
  string,
  strings,
  numbers,
  index,          // into the array at `of`
  indices,        // distinct ones
  named_indices,  // an object whose values are indices
  object,         // of the type `of`
  objects
};

struct Property {
  const char* name;
  Kind kind;
  const char* of = "";  // a JSON pointer for indices, a type of object for objects
  bool required = false;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::size_t length = 0;                 // of `numbers`; 0: any
  std::vector<double> values = {};        // if not empty: the only ones allowed
  std::vector<std::string> strings = {};  // likewise
};

// The properties of a type of object, `extensions` and `extras` aside; nullptr if the table has no such type. The object of an extension
// is the type "node.KHR_lights_punctual" for one that stands in a "node".
const std::vector<Property>* properties_of(const std::string& type);

struct ExtensionUse {
  std::string name, pointer;
};
struct SchemaFindings {
  std::vector<Diagnostic> diagnostics;   // where.pointer is set
  std::vector<ExtensionUse> extensions;  // every member of every "extensions" object
};

// Types, required properties, ranges, enumerations, and that every index points to something. Codes are the validator's. Beyond
// max_findings of a severity the rest is not listed.
constexpr std::size_t max_findings = 1000;
SchemaFindings check_schema(const nlohmann::json& root, std::size_t max_items);

// Appends a token to a JSON pointer, escaped as RFC 6901 wants it.
std::string pointer_to(const std::string& parent, const std::string& key);

}  // namespace etendue::gltf
