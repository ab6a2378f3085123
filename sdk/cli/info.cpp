// etendue info: what is in an asset, as authored, and what is wrong with it.
#include <fmt/format.h>

#include "limits.h"
#include "overview.h"
#include "pictures.h"
#include "verbs.h"

namespace etendue::cli {
namespace {

struct InfoOptions {
  std::vector<std::string> files;
  std::vector<std::string> need;
  ImportOptions import;
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

std::string heading(const std::string& file, const Imported& imported) {
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(file, unknown);
  return fmt::format("{}: {}{}", file, imported.scene.format, unknown ? "" : ", " + bytes_text(size));
}

// False if the file is bad.
bool report(Session& session, const std::string& file, const ImportOptions& options) {
  const Result<Imported> imported = read_asset(session, file, options);
  if (!imported) {
    session.diagnostics.add(to_diagnostic(imported.error()));
    for (const Diagnostic& note : imported.error().notes) session.diagnostics.add(note);
    session.result.push_back({{"file", file}, {"error", imported.error().text}});
    return false;
  }
  const Scene& scene = imported->scene;
  session.print(heading(file, *imported));
  print_overview(session, scene, options.need);
  Json json = {{"file", file}, {"format", scene.format}};
  json.update(overview_json(scene, options.need));
  session.result.push_back(std::move(json));
  if (imported->diagnostics.has_errors()) return false;
  if (options.need != Need::everything) return true;
  const Diagnostics faults = validate(scene);
  session.diagnostics.append(faults);
  return !faults.has_errors();
}

int run_info(const Common& common, const InfoOptions& options) {
  Session session("info", common);
  session.result = Json::array();
  ImportOptions import_options = options.import;
  import_options.need = need_of(options.need);
  bool good = true;
  for (const std::string& file : options.files) good = report(session, file, import_options) && good;
  return session.finish(good ? exit_done : exit_bad_input);
}

}  // namespace

void add_info(CLI::App& app, const Common& common, Run& run) {
  CLI::App* const verb = app.add_subcommand("info", "What is in an asset, as authored, and what is wrong with it");
  auto options = std::make_shared<InfoOptions>();
  verb->add_option("FILE", options->files, "Assets: .rig.json, .gltf, .glb, .ies, .ldt")->required();
  verb->add_option("--need", options->need, "Only these: lights, materials, cameras, meshes, images; the rest of the file is not touched")
      ->delimiter(',')
      ->expected(1)
      ->take_all()
      ->check(CLI::IsMember({"lights", "materials", "cameras", "meshes", "images"}));
  verb->add_flag("--tolerant", options->import.tolerant, "Repair what can be repaired without harm, and say so");
  add_limits(*verb, options->import);
  verb->footer(
      "\nExamples:\n  etendue info kitchen.rig.json\n  etendue info room.glb --need lights --json\n  etendue info *.glb -q    # errors "
      "alone"
      "\n  etendue info large.glb --need lights --stats    # reads the JSON chunk and nothing else"
      "\n  etendue info forest.glb --limit max_items=50M --limit max_memory=32G");
  verb->callback([&common, &run, options] { run = [&common, options] { return run_info(common, *options); }; });
}

}  // namespace etendue::cli
