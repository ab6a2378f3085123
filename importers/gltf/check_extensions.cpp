// extensionsUsed, extensionsRequired, and the objects that nothing refers to.
#include <fmt/format.h>

#include <cctype>

#include "checks.h"

namespace etendue::gltf {
namespace {

// PREFIX_name, the prefix in capitals and digits.
bool is_extension_name(std::string_view name) {
  const std::size_t end = name.find('_');
  if (end == name.npos || end == 0 || end + 1 == name.size()) return false;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    const bool good = i < end ? std::isupper(c) != 0 || std::isdigit(c) != 0 : std::isalnum(c) != 0 || c == '_';
    if (!good) return false;
  }
  return true;
}

bool contains(const Json& names, const Json& name) {
  for (const Json& one : names)
    if (one == name) return true;
  return false;
}

}  // namespace

void check_extensions(Checks& checks) {
  const Path root, used_path = root / "extensionsUsed", required_path = root / "extensionsRequired";
  const Json &used = array_at(checks.root, "extensionsUsed"), &required = array_at(checks.root, "extensionsRequired");
  if (checks.root.contains("extensionsRequired") && !checks.root.contains("extensionsUsed"))
    checks.findings.error("UNSATISFIED_DEPENDENCY", "expected extensionsUsed beside it, which is missing", required_path);
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i].is_string()) continue;
    if (!is_extension_name(used[i].get_ref<const std::string&>()))
      checks.findings.warning("INVALID_EXTENSION_NAME_FORMAT", fmt::format("expected PREFIX_name, found {}", shown(used[i])),
                              used_path / i);
    // Positions of other types than the core's: a reader without the extension would read something else.
    if (used[i] == "KHR_mesh_quantization" && !contains(required, used[i]))
      checks.findings.error("NON_REQUIRED_EXTENSION", "KHR_mesh_quantization has to stand in extensionsRequired as well", used_path / i);
  }
  for (std::size_t i = 0; i < required.size(); ++i)
    if (required[i].is_string() && !contains(used, required[i]))
      checks.findings.error("UNUSED_EXTENSION_REQUIRED", fmt::format("{} does not stand in extensionsUsed", shown(required[i])),
                            required_path / i);
}

void check_declarations(Checks& checks) {
  // A declaration without an object is legal for extensions that have none; for others it says that something got lost.
  const Path root, used_path = root / "extensionsUsed";
  const Json& used = array_at(checks.root, "extensionsUsed");
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i].is_string()) continue;
    const auto& name = used[i].get_ref<const std::string&>();
    if (name == "KHR_mesh_quantization" || !is_known_extension(name)) continue;
    bool found = false;
    for (const ExtensionUse& use : checks.schema.extensions) found = found || use.name == name;
    if (!found) checks.findings.note("UNUSED_EXTENSION", fmt::format("{} is declared, and nothing uses it", name), used_path / i);
  }
}

void check_unused(Checks& checks) {
  constexpr const char* arrays[] = {"/accessors",
                                    "/buffers",
                                    "/bufferViews",
                                    "/cameras",
                                    "/images",
                                    "/materials",
                                    "/meshes",
                                    "/nodes",
                                    "/samplers",
                                    "/skins",
                                    "/textures",
                                    "/extensions/KHR_lights_punctual/lights",
                                    "/extensions/KHR_materials_variants/variants"};
  for (const char* array : arrays) {
    const Json::json_pointer place{std::string(array)};
    if (!checks.root.contains(place) || !checks.root.at(place).is_array()) continue;
    const std::vector<bool>& used = checks.schema.used[array];
    for (std::size_t i = 0; i < checks.root.at(place).size(); ++i)
      if (i >= used.size() || !used[i])
        checks.findings.note_at("UNUSED_OBJECT", "nothing refers to this object", fmt::format("{}/{}", array, i));
  }
}

}  // namespace etendue::gltf
