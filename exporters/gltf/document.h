// The document that a scene was read from, on its way into another file.
#pragma once

#include "etendue/io.h"
#include "json_edit.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace etendue::gltf {

// Bytes of a buffer that nothing refers to any more.
struct Gap {
  std::size_t buffer, begin, size;
};

struct Document {
  const Scene& scene;
  std::string_view text;                              // without a byte order mark
  Json before, now;                                   // as read, and as it will be written
  std::map<std::size_t, const ImageRef*> new_images;  // by their place in now["images"]
  std::vector<Gap> gaps;
  LossReport losses;
};

// Every object but those in `extras`.
void for_each_object(Json& value, const std::function<void(Json& object)>& visit);

// An unsigned integer member, if there is one.
const Json* index_in(const Json& object, const char* key);

// Whether all extensions are ones whose references to textures, images and bufferViews are known here: only then can elements go, and
// the others be numbered anew.
bool references_are_known(const Json& document);

// Of `candidates`, textures, their images and those images' bufferViews go where nothing refers to them any more.
void remove_unused(Document& document, const std::set<std::size_t>& textures);

// Adds a name to "extensionsUsed"; takes it from there and from "extensionsRequired".
void use_extension(Json& document, const std::string& name);
void drop_extension(Json& document, const std::string& name);

}  // namespace etendue::gltf
