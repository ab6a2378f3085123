#include "check_document.h"

#include <charconv>
#include <utility>

#include <fmt/format.h>

#include "checks.h"

namespace etendue::gltf {
namespace {

// Of a text that the schema's pattern has let through.
std::pair<int, int> version_of(const std::string& text) {
  int major = 0, minor = 0;
  const char* end = text.data() + text.size();
  const auto point = std::from_chars(text.data(), end, major).ptr;
  if (point < end) std::from_chars(point + 1, end, minor);
  return {major, minor};
}

}  // namespace

bool check_version(const Json& root, Findings& findings) {
  const Path path, asset = path / "asset", version = asset / "version", minimum = asset / "minVersion";
  if (!root.contains("asset")) {
    findings.error("UNDEFINED_PROPERTY", "expected the property \"asset\", which is missing", path);
    return false;
  }
  const auto found = root["asset"].find("version");
  if (!root["asset"].is_object()) {
    findings.error("TYPE_MISMATCH", fmt::format("expected an object, found {}", shown(root["asset"])), asset);
    return false;
  }
  if (found == root["asset"].end()) {
    findings.error("UNDEFINED_PROPERTY", "expected the property \"version\", which is missing", asset);
    return false;
  }
  const auto matches = [&](const Json& value, const Path& place) {
    if (!value.is_string()) {
      findings.error("TYPE_MISMATCH", fmt::format("expected a string, found {}", shown(value)), place);
      return false;
    }
    const auto* property = properties_of("asset");
    for (const Property& p : *property)
      if (std::string_view(p.name) == "version" && !p.matches(value.get_ref<const std::string&>())) {
        findings.error("PATTERN_MISMATCH", fmt::format("expected a version as 2.0 is one, found {}", shown(value)), place);
        return false;
      }
    return true;
  };
  if (!matches(*found, version)) return false;
  const auto [major, minor] = version_of(found->get_ref<const std::string&>());
  const auto least = root["asset"].find("minVersion");
  if (least != root["asset"].end() && matches(*least, minimum)) {
    const auto needed = version_of(least->get_ref<const std::string&>());
    if (needed > std::pair(major, minor)) {
      findings.error("ASSET_MIN_VERSION_GREATER_THAN_VERSION",
                     fmt::format("minVersion {} is greater than version {}", shown(*least), shown(*found)), minimum);
      return false;
    }
    if (major == 2 && needed > std::pair(2, 0)) {
      findings.error("UNKNOWN_ASSET_MINOR_VERSION", fmt::format("expected a minVersion up to 2.0, found {}", shown(*least)), minimum);
      return false;
    }
  }
  if (major != 2) {
    findings.error("UNKNOWN_ASSET_MAJOR_VERSION", fmt::format("expected version 2.x, found {}", shown(*found)), version);
    return false;
  }
  if (minor > 0)
    findings.warning("UNKNOWN_ASSET_MINOR_VERSION", fmt::format("{} is read as 2.0: what is newer is not known", shown(*found)), version);
  return true;
}

SchemaFindings check_document(Json& root, bool is_glb, const ImportOptions& options, Findings& findings) {
  SchemaFindings schema = check_schema(root, options.max_items, findings);
  Checks checks{root, findings, schema, Records(root), is_glb, options.max_depth, {}, {}, true, {}};
  for (const Json& name : array_at(root, "extensionsUsed"))
    if (name.is_string()) checks.declared.insert(name.get<std::string>());
  check_extensions(checks);
  check_buffers(checks);
  check_accessors(checks);
  check_images(checks);
  check_materials(checks);
  check_meshes(checks);
  check_nodes(checks);
  check_skins(checks);
  check_animations(checks);
  check_cameras(checks);
  check_lights(checks);
  check_declarations(checks);
  check_unused(checks);
  return schema;
}

}  // namespace etendue::gltf
