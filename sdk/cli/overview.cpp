#include "overview.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "describe.h"
#include "pictures.h"

namespace etendue::cli {
namespace {

using Rows = std::vector<std::pair<std::string, std::string>>;

// Longer tables say how many rows are left.
constexpr std::size_t most_rows = 40;

void print_table(const Session& session, const char* title, const Rows& rows) {
  if (rows.empty()) return;
  const std::size_t shown = session.common().verbose ? rows.size() : std::min(rows.size(), most_rows);
  std::size_t width = 0;
  for (std::size_t i = 0; i < shown; ++i) width = std::max(width, rows[i].first.size());
  session.print(fmt::format("{} ({})", title, rows.size()));
  for (std::size_t i = 0; i < shown; ++i) session.print(fmt::format("  {:<{}}  {}", rows[i].first, width, rows[i].second));
  if (shown < rows.size()) session.print(fmt::format("  and {} more: -v prints them, --json has them", rows.size() - shown));
}

std::string mesh_text(const Mesh& mesh) {
  if (mesh.positions.empty()) return "not read";
  std::string text = fmt::format("{} triangles, {} vertices", mesh.indices.size() / 3, mesh.positions.size());
  for (const auto& [there, what] : {std::pair{!mesh.normals.empty(), "normals"},
                                    {!mesh.uvs.empty(), "uvs"},
                                    {!mesh.tangents.empty(), "tangents"},
                                    {!mesh.colours.empty(), "colours"}})
    if (there) text += fmt::format(", {}", what);
  return text;
}

Json mesh_json(const Mesh& mesh) {
  Json json = {{"name", mesh.name}, {"triangles", mesh.indices.size() / 3}, {"vertices", mesh.positions.size()}};
  json["attributes"] = Json::array();
  if (!mesh.normals.empty()) json["attributes"].push_back("normals");
  if (!mesh.uvs.empty()) json["attributes"].push_back("uvs");
  if (!mesh.tangents.empty()) json["attributes"].push_back("tangents");
  if (!mesh.colours.empty()) json["attributes"].push_back("colours");
  if (!mesh.source.empty()) json["pointer"] = mesh.source;
  return json;
}

// Carried parts by what they are: the name of the extension, or of the property, or of the array that they stand in.
std::map<std::string, std::size_t> carried_kinds(const Carried& carried) {
  std::map<std::string, std::size_t> kinds;
  for (const std::string& pointer : carried.parts) {
    std::string kind = pointer;
    const auto last = [&] { return kind.substr(kind.rfind('/') + 1); };
    while (!kind.empty() && last().find_first_not_of("0123456789") == std::string::npos) kind.resize(kind.rfind('/'));
    ++kinds[last()];
  }
  return kinds;
}

}  // namespace

void print_overview(const Session& session, const Scene& scene, Need need) {
  Rows rows;
  const auto print = [&](const char* title) {
    print_table(session, title, rows);
    rows.clear();
  };
  if (has(need, Need::lights)) {
    for (const Light& light : scene.lights) rows.emplace_back(light.name, describe(light) + resolved_text(scene, light));
    print("lights");
  }
  if (has(need, Need::cameras)) {
    for (const Camera& camera : scene.cameras) rows.emplace_back(camera.name.empty() ? "unnamed" : camera.name, describe(camera));
    print("cameras");
  }
  if (has(need, Need::materials)) {
    for (const Material& material : scene.materials) rows.emplace_back(material.name, describe(scene, material));
    print("materials");
  }
  if (has(need, Need::images)) {
    for (const Picture& picture : pictures_of(scene)) rows.emplace_back(picture.name, describe(picture));
    print("images");
  }
  if (has(need, Need::meshes)) {
    std::size_t triangles = 0;
    for (const Mesh& mesh : scene.meshes) {
      rows.emplace_back(mesh.name, mesh_text(mesh));
      triangles += mesh.indices.size() / 3;
    }
    print("meshes");
    if (scene.meshes.size() > 1) session.print(fmt::format("  together {} triangles, in {} objects", triangles, scene.objects.size()));
  }
  if (has(need, Need::carried)) {
    for (const auto& [kind, count] : carried_kinds(scene.carried)) rows.emplace_back(kind, fmt::format("{}", count));
    print("carried, as the scene has no place for it");
  }
}

Json overview_json(const Scene& scene, Need need) {
  Json json = Json::object();
  if (has(need, Need::lights)) {
    json["lights"] = Json::array();
    for (const Light& light : scene.lights) json["lights"].push_back(to_json(scene, light));
  }
  if (has(need, Need::cameras)) {
    json["cameras"] = Json::array();
    for (const Camera& camera : scene.cameras) json["cameras"].push_back(to_json(camera));
  }
  if (has(need, Need::materials)) {
    json["materials"] = Json::array();
    for (const Material& material : scene.materials) json["materials"].push_back(to_json(scene, material));
  }
  if (has(need, Need::meshes)) {
    json["meshes"] = Json::array();
    for (const Mesh& mesh : scene.meshes) json["meshes"].push_back(mesh_json(mesh));
    json["objects"] = scene.objects.size();
  }
  if (has(need, Need::images)) {
    json["images"] = Json::array();
    const std::vector<Picture> pictures = pictures_of(scene);
    for (std::size_t i = 0; i < pictures.size(); ++i) json["images"].push_back(to_json(scene.images[i], pictures[i]));
  }
  if (has(need, Need::carried) && !scene.carried.parts.empty()) json["carried"] = scene.carried.parts;
  return json;
}

}  // namespace etendue::cli
