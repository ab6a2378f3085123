// etendue info: what is in an asset, as authored, and what is wrong with it.
#include <fmt/format.h>

#include "describe.h"
#include "etendue/intensity_web.h"
#include "verbs.h"

namespace etendue::cli {
namespace {

struct InfoOptions {
  std::vector<std::string> files;
  std::vector<std::string> need;
};

Need need_of(const std::vector<std::string>& names) {
  static const std::pair<const char*, Need> known[] = {{"lights", Need::lights},
                                                       {"materials", Need::materials},
                                                       {"cameras", Need::cameras},
                                                       {"meshes", Need::meshes},
                                                       {"images", Need::images}};
  if (names.empty()) return Need::everything;
  Need need{};
  for (const auto& [name, bit] : known) {
    if (std::find(names.begin(), names.end(), name) != names.end()) need = need | bit;
  }
  return need;
}

void print_table(const Session& session, const char* title, const std::vector<std::pair<std::string, std::string>>& rows) {
  if (rows.empty()) return;
  std::size_t width = 0;
  for (const auto& row : rows) width = std::max(width, row.first.size());
  session.print(fmt::format("{} ({})", title, rows.size()));
  for (const auto& [name, text] : rows) session.print(fmt::format("  {:<{}}  {}", name, width, text));
}

// What a photometric file emits as it is, before colour, filter and a stated flux.
std::string web_text(const PhotometricShape& shape) {
  const Result<IntensityWeb> web = shape.distribution ? IntensityWeb::of(*shape.distribution) : Result<IntensityWeb>(Error{});
  return web ? fmt::format("  up to {:.6g} cd, {:.6g} lm", web->max_cd(), web->flux_lm()) : "";
}

std::string resolved_text(const Scene& scene, const Light& light) {
  if (const auto* photometric = std::get_if<PhotometricShape>(&light.shape)) return web_text(*photometric);
  const Result<Resolved> resolved = resolve(light, mesh_area_of(scene, light));
  if (!resolved) return "";
  static constexpr const char* units[] = {"cd", "cd/m2", "lx", "cd"};
  std::string text = fmt::format("  = {:.6g} {}", luminance_of(resolved->rgb), units[static_cast<int>(resolved->kind)]);
  if (resolved->flux_lm > 0) text += fmt::format(", {:.6g} lm", resolved->flux_lm);
  return text;
}

void print_scene(const Session& session, const Scene& scene, Need need) {
  std::vector<std::pair<std::string, std::string>> rows;
  if (has(need, Need::lights)) {
    for (const Light& light : scene.lights) rows.emplace_back(light.name, describe(light) + resolved_text(scene, light));
    print_table(session, "lights", rows);
  }
  rows.clear();
  if (has(need, Need::cameras)) {
    for (const Camera& camera : scene.cameras)
      rows.emplace_back(camera.name.empty() ? "unnamed" : camera.name, fmt::format("{:.4g} deg high", degrees.of({camera.vfov_rad})));
    print_table(session, "cameras", rows);
  }
  rows.clear();
  if (has(need, Need::materials)) {
    for (const Material& material : scene.materials) rows.emplace_back(material.name, describe(scene, material));
    print_table(session, "materials", rows);
  }
  rows.clear();
  if (has(need, Need::meshes)) {
    for (const Mesh& mesh : scene.meshes) rows.emplace_back(mesh.name, fmt::format("{} triangles", mesh.indices.size() / 3));
    print_table(session, "meshes", rows);
  }
  rows.clear();
  if (has(need, Need::images)) {
    for (const ImageRef& image : scene.images) rows.emplace_back(image.name, image.embedded ? image.mime_type + " embedded" : image.file);
    print_table(session, "images", rows);
  }
}

Json scene_json(const Imported& imported, const std::string& file, Need need) {
  const Scene& scene = imported.scene;
  Json json = {{"file", file}, {"format", scene.format}};
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
    for (const Mesh& mesh : scene.meshes) json["meshes"].push_back({{"name", mesh.name}, {"triangles", mesh.indices.size() / 3}});
    json["objects"] = scene.objects.size();
  }
  if (has(need, Need::images)) {
    json["images"] = Json::array();
    for (const ImageRef& image : scene.images)
      json["images"].push_back({{"name", image.name}, {"file", image.file}, {"mime_type", image.mime_type}});
  }
  return json;
}

int run_info(const Common& common, const InfoOptions& options) {
  Session session("info", common);
  session.result = Json::array();
  const Need need = need_of(options.need);
  ImportOptions import_options;
  import_options.need = need;
  bool bad = false;
  for (const std::string& file : options.files) {
    const Result<Imported> imported = read_asset(session, file, import_options);
    if (!imported) {
      session.diagnostics.add(to_diagnostic(imported.error()));
      session.result.push_back({{"file", file}, {"error", imported.error().text}});
      bad = true;
      continue;
    }
    session.print(fmt::format("{}: {}", file, imported->scene.format));
    print_scene(session, imported->scene, need);
    session.result.push_back(scene_json(*imported, file, need));
    if (need == Need::everything && !imported->diagnostics.has_errors()) session.diagnostics.append(validate(imported->scene));
  }
  return session.finish(bad || session.diagnostics.has_errors() ? exit_bad_input : exit_done);
}

}  // namespace

void add_info(CLI::App& app, const Common& common, Run& run) {
  CLI::App* const verb = app.add_subcommand("info", "What is in an asset, as authored, and what is wrong with it");
  auto options = std::make_shared<InfoOptions>();
  verb->add_option("FILE", options->files, "Assets: .rig.json, .gltf, .glb")->required();
  verb->add_option("--need", options->need, "Only these: lights, materials, cameras, meshes, images")
      ->delimiter(',')
      ->check(CLI::IsMember({"lights", "materials", "cameras", "meshes", "images"}));
  verb->footer("\nExamples:\n  etendue info kitchen.rig.json\n  etendue info room.glb --need lights --json");
  verb->callback([&common, &run, options] { run = [&common, options] { return run_info(common, *options); }; });
}

}  // namespace etendue::cli
