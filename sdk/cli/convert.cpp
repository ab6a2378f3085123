// etendue convert: any format in, any format out, with a report of what is lost.
#include <fmt/format.h>

#include <atomic>
#include <cctype>
#include <filesystem>
#include <mutex>
#include <thread>

#include "comparison_text.h"
#include "etendue/conversion_views.h"
#include "etendue/material_conversion.h"
#include "etendue/picture_write.h"
#include "etendue/texture_space.h"

#include "exporters/eulumdat/eulumdat.h"
#include "exporters/gltf/gltf.h"
#include "exporters/ies/ies.h"
#include "exporters/mitsuba/mitsuba.h"
#include "exporters/rig/rig.h"
#include "importers/gltf/gltf.h"
#include "importers/photometric_lights/photometric_lights.h"
#include "limits.h"
#include "verbs.h"

namespace etendue::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string in, out, to, loss, size = "512x512", camera, lights, mute, materials, readers = "all", views, texture_space, ocio;
  ImportOptions import;
  int depth = 2, bits = 8;
  unsigned samples = 1024, jobs = 1;
  bool force = false, emissive_shapes = false;
  std::optional<ColourStep> to_linear_rec709;  // of the space that --texture-space names
};

struct Converted {
  fs::path in, out;
  std::optional<Error> error;
  std::vector<fs::path> files;
  LossReport losses;
  Json materials = Json::array();  // that were converted
  Diagnostics diagnostics;
};

// Every format that can be written.
const Registry& exporters() {
  static const Registry* const built_in = [] {
    auto* const formats = new Registry;  // lives as long as the program
    formats->add(make_rig_exporter());
    formats->add(make_gltf_exporter());
    formats->add(make_mitsuba_exporter(MitsubaParts::built_in, MitsubaLobes::as_far_as_can_be));
    formats->add(make_ies_exporter());
    formats->add(make_eulumdat_exporter());
    return formats;
  }();
  return *built_in;
}

Json to_json(const LossReport& report) {
  Json json = Json::array();
  for (const Loss& loss : report.losses) json.push_back({{"what", loss.what}, {"effect", loss.effect}});
  return json;
}

Result<ExportOptions> export_options(Scene& scene, const Options& options, Size size) {
  ExportOptions result;
  result.max_depth = options.depth;
  result.width = size.width;
  result.height = size.height;
  result.samples = options.samples;
  const auto camera = choose_camera(scene, options.camera, static_cast<double>(size.width) / size.height);
  if (!camera && !(options.camera.empty() && camera.error().code == "CAMERA_MISSING")) return camera.error();
  result.camera = camera ? *camera : 0;
  if (!options.lights.empty() || !options.mute.empty()) {
    auto lit = lit_lights(scene, options.lights, options.mute);
    if (!lit) return lit.error();
    result.lit = *lit;
  }
  return result;
}

// New textures of one asset: in NAME_textures where the format refers to files where they lie, else only until it has taken them over.
class TextureFolder {
 public:
  TextureFolder(const fs::path& out, bool stays) : stays_(stays), path_(out) {
    const std::string name = out.filename().string();
    path_.replace_filename(stays ? name.substr(0, name.find('.')) + "_textures" : "." + name + ".textures");
  }
  TextureFolder(const TextureFolder&) = delete;
  TextureFolder& operator=(const TextureFolder&) = delete;
  ~TextureFolder() {
    std::error_code ignored;
    if (!stays_) fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  bool stays_;
  fs::path path_;
};

std::optional<MaterialModel> model_of(const std::string& name) {
  if (name.empty()) return std::nullopt;
  return name == "metal-rough" ? MaterialModel::metal_rough : MaterialModel::spec_gloss;
}

// The materials that were converted, as --json names them.
Json to_json(const MaterialChange& change, const Scene& scene) {
  const auto deviation = [](const Deviation& linear, const Deviation& steps) {
    return Json{{"rms", linear.rms}, {"max", linear.max}, {"rms_8_bit_steps", steps.rms}, {"max_8_bit_steps", steps.max}};
  };
  const auto reader = [&](const ReaderDeviation& d) {
    return Json{{"diffuse", deviation(d.diffuse, d.diffuse_steps)}, {"f0", deviation(d.f0, d.f0_steps)}};
  };
  return {{"name", scene.materials[change.material].name},
          {"texels", change.texels},
          {"core", reader(change.core)},
          {"full", reader(change.full)},
          {"metal_variation", change.metal_variation},
          {"metal_variation_of_best", change.metal_variation_of_best}};
}

// The picture of where a material has changed most, and its place beside the numbers of job.materials' last.
Status show_worst(Converted& job, const Options& options, const Scene& before, const Scene& after, std::uint32_t material) {
  const Material& is = after.materials[material];
  const auto view = conversion_view(before, before.materials[material], after, is, options.import.max_pixels);
  if (!view) return view.error();
  std::string safe;
  for (const char c : is.name) safe += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ? c : '_';
  const fs::path file = fs::path(options.views) /
                        fmt::format("{}_{:02}_{}.png", job.out.stem().string(), material, safe.empty() ? "material" : safe.substr(0, 60));
  std::error_code made;
  fs::create_directories(options.views, made);
  if (made) return Error{"FILE_UNWRITABLE", "cannot make the folder: " + made.message(), {options.views, 0, 0, {}}, {}, {}};
  if (Status written = write_png(view->picture, file); !written) return written;
  Json worst = Json::array();
  for (const WorstRegion& region : view->regions)
    worst.push_back({{"reader", region.reader},
                     {"x", region.x},
                     {"y", region.y},
                     {"width", region.width},
                     {"height", region.height},
                     {"rms", region.rms},
                     {"max", region.max}});
  job.materials.back()["view"] = file.string();
  job.materials.back()["worst_regions"] = std::move(worst);
  return Done{};
}

// Colour textures that are in the space that --texture-space names, as everything else takes them. A conversion of materials reads them
// again: 16 bits then, so that they are rounded to --bits once.
Status read_colours(Converted& job, const Options& options, Scene& scene, const fs::path& folder, Progress* progress) {
  const int bits = options.materials.empty() ? options.bits : 16;
  auto losses = convert_colour_textures(scene, *options.to_linear_rec709, {folder, bits, options.import.max_pixels, progress});
  if (!losses) return losses.error();
  job.losses = std::move(*losses);
  return Done{};
}

void convert_one(Converted& job, const Options& options, Size size, Progress* progress) {
  if (fs::exists(job.out) && !options.force) {
    job.error = Error{"USAGE", fmt::format("{} is there already", job.out.string()), {}, "--force replaces it", {}};
    return;
  }
  const auto chosen_exporter = exporters().exporter_for(job.out);
  if (!chosen_exporter) return void(job.error = chosen_exporter.error());
  const Exporter* exporter = *chosen_exporter;
  if (options.emissive_shapes) {
    static const std::unique_ptr<Exporter> with_shapes = make_gltf_exporter(gltf::LightShapes::emissive);
    if (exporter->describe().id != with_shapes->describe().id) {
      job.error = Error{"USAGE", "--emissive-shapes is for glTF: other formats say the shapes of lights themselves", {}, "", {}};
      return;
    }
    exporter = with_shapes.get();
  }
  const auto importer = importers().importer_for(job.in);
  if (!importer) return void(job.error = importer.error());
  const auto model = model_of(options.materials);
  static const std::unique_ptr<Importer> all_materials = make_gltf_importer(GltfMaterials::all);
  const bool is_gltf = (*importer)->describe().id == all_materials->describe().id;
  const bool all = is_gltf && (model || options.to_linear_rec709);
  Result<Imported> imported = (all ? all_materials.get() : *importer)->read(job.in, options.import);
  if (!imported) return void(job.error = imported.error());
  imported->diagnostics.append(read_photometric_lights(imported->scene));
  job.diagnostics.append(imported->diagnostics);
  if (imported->diagnostics.has_errors()) {
    job.error = Error{"INPUT_INVALID", fmt::format("{} has errors and is not converted", job.in.string()), {}, "", {}};
    return;
  }
  const TextureFolder textures(job.out, exporter->describe().id == "rig");
  if (options.to_linear_rec709) {
    if (Status read = read_colours(job, options, imported->scene, textures.path(), progress); !read) return void(job.error = read.error());
  }
  if (model) {
    const Scene before = options.views.empty() ? Scene{} : imported->scene;
    auto conversion = convert_materials(imported->scene, {*model, options.bits, textures.path(), options.jobs > 1 ? 1u : 0u, progress,
                                                          options.readers == "core" ? Readers::core : Readers::all});
    if (!conversion) return void(job.error = conversion.error());
    for (Loss& loss : conversion->losses.losses) job.losses.losses.push_back(std::move(loss));
    for (const MaterialChange& change : conversion->changes) {
      job.materials.push_back(to_json(change, imported->scene));
      if (options.views.empty()) continue;
      if (Status shown = show_worst(job, options, before, imported->scene, change.material); !shown) return void(job.error = shown.error());
    }
  }
  const auto chosen = export_options(imported->scene, options, size);
  if (!chosen) return void(job.error = chosen.error());
  Result<Exported> exported = exporter->write(imported->scene, job.out, *chosen);
  if (!exported) return void(job.error = exported.error());
  job.files = std::move(exported->files);
  for (Loss& loss : exported->losses.losses) job.losses.losses.push_back(std::move(loss));
  job.diagnostics.append(exported->diagnostics);
}

// A folder's assets, each with the same name in the output folder and the new extension.
Result<std::vector<Converted>> jobs_of(const Options& options) {
  if (!fs::is_directory(options.in)) return std::vector<Converted>{{options.in, options.out, {}, {}, {}, Json::array(), {}}};
  if (options.to.empty()) return Error{"USAGE", "a folder needs --to, as in --to .xml", {}, "", {}};
  std::vector<Converted> jobs;
  for (const auto& entry : fs::recursive_directory_iterator(options.in)) {
    if (!entry.is_regular_file()) continue;
    const std::string name = entry.path().filename().string();
    for (const auto& importer : importers().importers()) {
      for (const std::string& extension : importer->describe().extensions) {
        if (!name.ends_with(extension) || name.size() == extension.size()) continue;
        const fs::path folder = fs::path(options.out) / fs::relative(entry.path().parent_path(), options.in);
        jobs.push_back(
            {entry.path(), folder / (name.substr(0, name.size() - extension.size()) + options.to), {}, {}, {}, Json::array(), {}});
      }
    }
  }
  std::sort(jobs.begin(), jobs.end(), [](const Converted& a, const Converted& b) { return a.in < b.in; });
  for (const Converted& job : jobs) fs::create_directories(job.out.parent_path());
  return jobs;
}

void run_jobs(std::vector<Converted>& jobs, const Options& options, Size size, Bar& bar) {
  std::atomic<std::size_t> next = 0, done = 0;
  std::mutex reporting;
  const auto work = [&] {
    for (std::size_t i = next++; i < jobs.size() && !interrupted(); i = next++) {
      convert_one(jobs[i], options, size, jobs.size() == 1 ? &bar : nullptr);
      const std::scoped_lock lock(reporting);
      bar.report("convert", static_cast<double>(++done) / static_cast<double>(jobs.size()));
    }
  };
  std::vector<std::thread> threads;
  for (unsigned i = 1; i < std::min<std::size_t>(options.jobs, jobs.size()); ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
}

Result<ColourStep> to_linear_rec709(const Options& options) {
  const auto config = options.ocio.empty() ? ColourConfig::from_environment() : ColourConfig::from_file(options.ocio);
  if (!config) return config.error();
  return config->to_linear_rec709(options.texture_space);
}

int run_convert(const Common& common, Options options) {
  Session session("convert", common);
  const Result<Size> size = parse_size(options.size);
  if (!size) return session.fail(size.error());
  if (!options.texture_space.empty()) {
    auto step = to_linear_rec709(options);
    if (!step) return session.fail(step.error());
    options.to_linear_rec709 = *std::move(step);
  }
  Result<std::vector<Converted>> jobs = jobs_of(options);
  if (!jobs) return session.fail(jobs.error());
  {
    Bar bar(session);
    run_jobs(*jobs, options, *size, bar);
  }
  if (interrupted()) return session.fail({"CANCELLED", "cancelled", {}, "", {}});

  Json losses = Json::object();
  session.result = Json::array();
  int status = exit_done;
  for (const Converted& job : *jobs) {
    session.diagnostics.append(job.diagnostics);
    Json item = {{"in", job.in.string()}};
    if (job.error) {
      session.diagnostics.add(to_diagnostic(*job.error));
      item["error"] = job.error->text;
      status = std::max(status, exit_status_of(*job.error));
    } else {
      item["out"] = job.out.string();
      item["files"] = Json::array();
      for (const fs::path& file : job.files) item["files"].push_back(file.string());
      item["losses"] = to_json(job.losses);
      if (!job.materials.empty()) item["materials"] = job.materials;
      losses[job.out.string()] = to_json(job.losses);
      session.print(fmt::format("{}: {} file{}, {} loss{}", job.out.string(), job.files.size(), job.files.size() == 1 ? "" : "s",
                                job.losses.losses.size(), job.losses.losses.size() == 1 ? "" : "es"));
      for (const std::string& line : grouped(job.losses.losses)) session.print(fmt::format("  lost: {}", line));
      for (const Json& material : job.materials) {
        if (!material.contains("view")) continue;
        session.print(fmt::format("  {}", material["view"].get<std::string>()));
        for (const Json& region : material["worst_regions"])
          session.print(fmt::format("    {}-reader: {} x {} texels from ({}, {}): rms {:.2e}, at most {:.2e}, which is palest",
                                    region["reader"].get<std::string>(), region["width"].get<int>(), region["height"].get<int>(),
                                    region["x"].get<int>(), region["y"].get<int>(), region["rms"].get<double>(),
                                    region["max"].get<double>()));
      }
    }
    session.result.push_back(std::move(item));
  }
  if (!options.loss.empty()) {
    const std::string text = losses.dump(2) + "\n";
    const Status written = write_file(options.loss, std::as_bytes(std::span(text)));
    if (!written) return session.fail(written.error());
  }
  return session.finish(status);
}

}  // namespace

void add_convert(CLI::App& app, const Common& common, Run& run) {
  CLI::App* const verb = app.add_subcommand("convert", "Any format in, any format out, with a report of what is lost");
  auto options = std::make_shared<Options>();
  verb->add_option("IN", options->in, "A light rig or glTF file, or a folder of them")->required();
  verb->add_option("OUT", options->out, "A file (.xml, .rig.json, .glb, .gltf), or a folder")->required();
  verb->add_option("--to", options->to, "For a folder: the extension of what is written, as .xml");
  verb->add_option("--loss", options->loss, "Write the losses to this JSON file as well");
  verb->add_option("--depth", options->depth, "Mitsuba's max_depth: 2 is direct light, -1 has no end")->capture_default_str();
  verb->add_option("--size", options->size, "WIDTHxHEIGHT of the picture")->capture_default_str();
  verb->add_option("--spp", options->samples, "Samples per pixel that Mitsuba takes unless told otherwise")->capture_default_str();
  verb->add_option("--camera", options->camera, "A camera of the file, or auto");
  verb->add_option("--lights", options->lights, "Only these lights emit, by name: a,b");
  verb->add_option("--mute", options->mute, "All lights but these emit");
  verb->add_option("--jobs", options->jobs, "Files of a folder at a time")->capture_default_str()->check(CLI::Range(1, 256));
  verb->add_option("--materials", options->materials, "All materials in one of glTF's models: metal-rough or spec-gloss")
      ->check(CLI::IsMember({"metal-rough", "spec-gloss"}));
  verb->add_option(
          "--readers", options->readers,
          "Whom metal-rough serves: all (right where KHR_materials_specular is known, and as near as that allows in others), or core "
          "(nearest in a reader that knows the core alone)")
      ->capture_default_str()
      ->check(CLI::IsMember({"all", "core"}));
  verb->add_option("--bits", options->bits, "Of a channel of new textures: 8 or 16")->capture_default_str()->check(CLI::IsMember({8, 16}));
  verb->add_option(
          "--views", options->views,
          "With --materials: folder for a PNG a material, of where it has changed most for core-only readers (above) and for those of "
          "KHR_materials_specular (below): diffuse before and after, f0 before and after, the error in false colours")
      ->needs("--materials");
  verb->add_option(
      "--texture-space", options->texture_space,
      "The colour space that textures of colours are in, where it is not sRGB (or linear Rec.709 of floating-point files): a name of "
      "the configuration, as ACEScg, \"linear Rec.2020\", \"linear P3\", ACES2065-1 of the built-in one");
  verb->add_option("--ocio", options->ocio, "An OpenColorIO configuration, where it is not the one that $OCIO names or the built-in one")
      ->needs("--texture-space")
      ->check(CLI::ExistingFile);
  verb->add_flag(
      "--emissive-shapes", options->emissive_shapes,
      "Into glTF: a mesh that emits its luminance beside each light with a surface, where the format itself has points and spots");
  verb->add_flag("--force", options->force, "Replace what is there");
  add_limits(*verb, options->import);
  verb->footer(
      "\nExamples:\n  etendue convert kitchen.rig.json kitchen.xml\n  etendue convert glass.glb glass.xml --depth 8\n  "
      "etendue convert chair.glb chair_mr.glb --materials metal-rough\n  "
      "etendue convert film.gltf chair.glb --materials metal-rough --texture-space ACEScg\n  "
      "etendue convert chair.glb chair_core.glb --materials metal-rough --readers core --bits 16 --views worst\n  "
      "etendue convert kitchen.rig.json kitchen.glb --emissive-shapes\n  "
      "etendue convert assets/ scenes/ --to .xml --jobs 4 --loss "
      "losses.json");
  verb->callback([&common, &run, options] { run = [&common, options] { return run_convert(common, *options); }; });
}

}  // namespace etendue::cli
