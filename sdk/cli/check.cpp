// etendue check: whether the materials of an asset can be those of real surfaces.
#include <fmt/format.h>

#include <filesystem>
#include <vector>

#include "all_materials.h"
#include "etendue/material_check.h"
#include "etendue/picture_write.h"
#include "limits.h"
#include "verbs.h"

namespace etendue::cli {
namespace {

struct Options {
  std::string asset, views;
  ImportOptions import;
  PlausibleRanges ranges;
  double allow = 0.01, allow_half_metal = 0.25;
  bool force = false;
};

// Edges and cavities have the last two by nature.
double allowed(Doubt doubt, const Options& options) {
  return doubt == Doubt::half_metal || doubt == Doubt::low_f0 ? options.allow_half_metal : options.allow;
}

std::string file_name(std::size_t index, const std::string& name) {
  std::string safe;
  for (const char c : name) safe += (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-' ? c : '_';
  return fmt::format("{:02}_{}.png", index, safe.empty() ? "material" : safe.substr(0, 60));
}

Json range_json(const Rgb& least, const Rgb& greatest) {
  return {{"least", {least.x, least.y, least.z}}, {"greatest", {greatest.x, greatest.y, greatest.z}}};
}

std::string shown(const Rgb& c) { return fmt::format("{:.3f} {:.3f} {:.3f}", c.x, c.y, c.z); }

int run_check(const Common& common, const Options& options) {
  Session session("check", common);
  const std::filesystem::path folder = options.views;
  if (!options.views.empty() && !options.force && std::filesystem::exists(folder))
    return session.fail({"USAGE", fmt::format("{} is there already", options.views), {}, "--force writes into it", {}});
  const Result<Imported> imported = read_all_materials(options.asset, options.import);
  if (!imported) return session.fail(imported.error());
  session.diagnostics.append(imported->diagnostics);
  const auto& read = imported->stats;
  session.stats = {{"bytes_read", read.bytes_read},
                   {"skipped_bytes", read.skipped_bytes},
                   {"images_decoded", read.images_decoded},
                   {"skipped_meshes", read.skipped_meshes},
                   {"skipped_images", read.skipped_images}};
  if (imported->diagnostics.has_errors()) return session.finish(exit_bad_input);
  const Scene& scene = imported->scene;
  if (!options.views.empty()) {
    std::error_code made;
    std::filesystem::create_directories(folder, made);
    if (made)
      return session.fail(
          {"FILE_UNWRITABLE", fmt::format("cannot make the folder: {}", made.message()), {options.views, 0, 0, {}}, {}, {}});
  }
  session.result = {{"materials", Json::array()}};
  bool failed = false;
  std::uint64_t texels = 0, decoded = 0;
  Bar bar(session);
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& material = scene.materials[i];
    if (!bar.report("materials", static_cast<double>(i) / static_cast<double>(scene.materials.size())))
      return session.finish(exit_cancelled);
    const Result<MaterialCheck> check = check_material(scene, material, options.ranges, options.import.max_pixels);
    if (!check) return session.fail(check.error());
    texels += std::uint64_t{check->width} * check->height;
    decoded += check->images_decoded;
    const std::string name = material.name.empty() ? fmt::format("material {}", i) : material.name;
    if (!check->same_places)
      session.diagnostics.note("TEXTURE_TRANSFORMS",
                               fmt::format("{}: its textures have transforms of their own, which are left out here", name));
    session.print(fmt::format("{}: {} x {} texels\n  albedo {} to {}\n  f0     {} to {}", name, check->width, check->height,
                              shown(check->albedo_least), shown(check->albedo_greatest), shown(check->f0_least),
                              shown(check->f0_greatest)));
    Json row{{"name", name},
             {"width", check->width},
             {"height", check->height},
             {"albedo", range_json(check->albedo_least, check->albedo_greatest)},
             {"f0", range_json(check->f0_least, check->f0_greatest)},
             {"doubtful_share", check->doubtful_share()},
             {"doubts", Json::object()}};
    for (const Doubt doubt : all_doubts) {
      const double share = check->share(doubt);
      if (share == 0) continue;
      const DoubtInfo& info = info_of(doubt);
      row["doubts"][std::string(info.name)] = share;
      const bool too_many = share > allowed(doubt, options);
      failed = failed || too_many;
      session.print(fmt::format("  {:>8.3f} %  {}: {}{}", 100 * share, info.name, info.meaning, too_many ? "" : " (few enough)"));
    }
    if (check->doubtful == 0) session.print("  nothing in doubt");
    if (!options.views.empty()) {
      const std::filesystem::path file = folder / file_name(i, material.name);
      if (const Status written = write_png(check->view, file); !written) return session.fail(written.error());
      row["view"] = file.string();
    }
    session.result["materials"].push_back(std::move(row));
  }
  bar.report("materials", 1);
  if (scene.materials.empty()) session.print("no materials");
  session.stats.update(Json{{"materials", scene.materials.size()}, {"texels", texels}, {"images_decoded", decoded}});
  return session.finish(failed ? exit_bad_input : exit_done);
}

}  // namespace

void add_check(CLI::App& app, const Common& common, Run& run) {
  CLI::App* const verb = app.add_subcommand("check", "Whether an asset's materials can be those of real surfaces");
  auto options = std::make_shared<Options>();
  verb->add_option("ASSET", options->asset, "A glTF file or light rig")->required();
  verb->add_option("--views", options->views, "Folder for a PNG a material: doubtful texels in false colours, the others dim and grey");
  verb->add_option("--allow", options->allow, "Share of a material's texels that may be in doubt")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
  verb->add_option("--allow-half-metal", options->allow_half_metal,
                   "The same for what real surfaces have at edges and in cavities: half_metal, low_f0")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
  const auto range = [verb](const char* name, double& value, const char* what) {
    verb->add_option(name, value, what)->capture_default_str()->check(CLI::Range(0.0, 1.0));
  };
  range("--albedo-least", options->ranges.albedo_least, "Of dielectrics, linear; 0.013 is sRGB 30");
  range("--albedo-greatest", options->ranges.albedo_greatest, "0.871 is sRGB 240");
  range("--f0-least", options->ranges.f0_least, "Of dielectrics: water");
  range("--f0-greatest", options->ranges.f0_greatest, "Diamond");
  range("--metal-f0-least", options->ranges.metal_f0_least, "0.456 is sRGB 180");
  verb->add_flag("--force", options->force, "Write into a folder that is there");
  add_limits(*verb, options->import);
  std::string legend = "\nDoubts, in the order in which the views show them:\n";
  for (const Doubt doubt : all_doubts) legend += fmt::format("  {:<14} {}\n", info_of(doubt).name, info_of(doubt).meaning);
  verb->footer(
      "\nExamples:\n  etendue check room.glb\n  etendue check room.glb --views doubts\n  etendue check room.glb --allow 0.05 --json\n" +
      legend + "\nExit status 1: a material has more doubtful texels than is allowed.");
  verb->callback([&common, &run, options] { run = [&common, options] { return run_check(common, *options); }; });
}

}  // namespace etendue::cli
