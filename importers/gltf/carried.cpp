#include "carried.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "mapping.h"
#include "uri.h"

namespace etendue::gltf {
namespace {

using Json = nlohmann::json;

void name_extensions(Asset& asset) {
  std::map<std::string, std::vector<std::string>> places;
  for (const ExtensionUse& use : asset.extensions()) places[use.name].push_back(use.pointer);
  for (const auto& [name, pointers] : places) {
    const MappingRow* row = row_of_extension(name);
    if (row != nullptr && row->actual_fate() == Fate::represented) continue;
    std::string text = name + ": carried";
    if (row == nullptr) text += ", but not read: no picture shows what it says";
    if (row != nullptr && row->becomes[0] != '\0') text += fmt::format("; {}", row->becomes);
    if (pointers.size() > 1) text += fmt::format(" ({} places, the first is shown)", pointers.size());
    const bool missed = row == nullptr || row->actual_fate() == Fate::unshown;
    asset.add({missed ? Severity::warning : Severity::note, "NOT_REPRESENTED", std::move(text), asset.at(pointers.front()), {}});
  }
}

void check_required(Asset& asset) {
  const auto required = asset.json().find("extensionsRequired");
  if (required == asset.json().end() || !required->is_array()) return;
  for (std::size_t i = 0; i < required->size(); ++i) {
    if (!(*required)[i].is_string()) continue;
    const auto name = (*required)[i].get<std::string>();
    const MappingRow* row = row_of_extension(name);
    if (row == nullptr || row->actual_fate() == Fate::unshown)
      asset.error("UNSUPPORTED_REQUIRED_EXTENSION",
                  fmt::format("the file cannot be read as it is meant without {}, which is not supported", name),
                  fmt::format("/extensionsRequired/{}", i));
  }
}

void name_all(Asset& asset, const char* array, const char* text) {
  const auto found = asset.json().find(array);
  if (found == asset.json().end() || !found->is_array() || found->empty()) return;
  asset.note("NOT_REPRESENTED", fmt::format("{} {}", found->size(), text), fmt::format("/{}/0", array));
}

// Walks down what the table says is represented, and lists the rest.
class Parts {
 public:
  explicit Parts(const Asset& asset) : asset_(asset) { object(asset.json(), "glTF", ""); }
  std::vector<std::string> pointers;

 private:
  void object(const Json& value, const std::string& type, const std::string& pointer) {
    for (const auto& [name, member] : value.items()) {
      const std::string here = pointer_to(pointer, name);
      if (name == "extensions" && member.is_object()) {
        for (const auto& [extension, content] : member.items()) what_is(mapped(type, extension), content, pointer_to(here, extension));
      } else if (type == "attributes") {
        const bool applied = name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_");
        if (applied || !asset_.is_taken(here)) pointers.push_back(here);
      } else {
        what_is(mapped(type, name), member, here);
      }
    }
  }

  void what_is(const Mapped& known, const Json& value, const std::string& pointer) {
    if (known.row == nullptr || known.row->actual_fate() != Fate::represented) {
      // Of the document's own arrays each element is a part; anything deeper is one as it stands.
      const bool top = known.row != nullptr && value.is_array() && std::count(pointer.begin(), pointer.end(), '/') == 1;
      for (std::size_t i = 0; top && i < value.size(); ++i) pointers.push_back(fmt::format("{}/{}", pointer, i));
      if (!top) pointers.push_back(pointer);
    } else if (!known.type.empty() && value.is_array()) {
      for (std::size_t i = 0; i < value.size(); ++i) element(known, value[i], fmt::format("{}/{}", pointer, i));
    } else if (!known.type.empty()) {
      element(known, value, pointer);
    }
  }

  void element(const Mapped& known, const Json& value, const std::string& pointer) {
    if (known.taken_up && !asset_.is_taken(pointer)) {
      pointers.push_back(pointer);
    } else if (value.is_object()) {
      object(value, known.type, pointer);
    }
  }

  const Asset& asset_;
};

}  // namespace

void name_unshown(Asset& asset) {
  check_required(asset);
  name_extensions(asset);
  name_all(asset, "animations", "animation(s): carried; everything stands as the file gives it");
}

void carry(Asset& asset, Scene& scene) {
  if (!has(asset.options().need, Need::carried)) return;
  scene.carried.document = asset.document();
  const auto buffers = asset.json().find("buffers");
  if (buffers != asset.json().end() && buffers->is_array()) {
    for (std::size_t i = 0; i < buffers->size(); ++i) {
      const bool in_text = (*buffers)[i].is_object() && is_data_uri(text_or((*buffers)[i], "uri", ""));
      auto bytes = in_text ? Result<SharedBytes>(SharedBytes()) : asset.buffer(static_cast<int>(i));
      scene.carried.buffers.push_back(bytes ? std::move(*bytes)
                                            : SharedBytes());  // one that is missing has been reported if it was asked for
    }
  }
  scene.carried.parts = std::move(Parts(asset).pointers);
}

}  // namespace etendue::gltf
