// etendue validate: an asset through our evaluation and through the real Mitsuba, compared, with a report.
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "comparison_text.h"
#include "describe.h"
#include "etendue/render.h"
#include "etendue/report.h"
#include "exporters/mitsuba/mitsuba.h"
#include "limits.h"
#include "mitsuba_pictures.h"
#include "shadows.h"
#include "verbs.h"

namespace etendue::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string asset, out = "etendue-report", size = "512x512", max_difference = "1%", camera, lights, mute, mitsuba, cache;
  unsigned samples = 1024, seeds = 16, threads = 0;
  ImportOptions import;
  ShadowOptions shadows;
  double seconds = 0, tolerance = 0;
  bool no_cache = false, plugins = false;
};

// A folder beside `target` that is gone when this is, whatever happened.
class WorkFolder {
 public:
  explicit WorkFolder(const fs::path& target) : path_(fs::absolute(target).lexically_normal()) {
    if (path_.filename().empty()) path_ = path_.parent_path();
    path_ = path_.parent_path() / fmt::format(".{}.{}", path_.filename().string(), getpid());
    std::error_code error;
    fs::create_directories(path_, error);
    ok_ = !error;
  }
  ~WorkFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  bool ok() const { return ok_; }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
  bool ok_ = false;
};

std::optional<fs::path> cache_folder(const Options& options) {
  if (options.no_cache) return std::nullopt;
  if (!options.cache.empty()) return options.cache;
  if (const char* const cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache != '\0') return fs::path(cache) / "etendue";
  if (const char* const home = std::getenv("HOME"); home != nullptr && *home != '\0') return fs::path(home) / ".cache" / "etendue";
  return std::nullopt;
}

// Whether Mitsuba's scene has other materials or distances than the asset: then our picture of the asset itself is made as well.
bool differs_as_authored(const Scene& scene, MitsubaParts parts) {
  if (parts == MitsubaParts::with_plugins) return false;
  for (const Material& material : scene.materials) {
    if (std::holds_alternative<MetalRough>(material.model) || std::holds_alternative<Standard>(material.model) ||
        std::holds_alternative<SpecularGlossiness>(material.model))
      return true;
  }
  return std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& light) {
    return eval::is_window({light.falloff, light.range_m.value_or(0)});
  });
}

// Reports under a name of its own what would be called "rendering" twice.
class Stage : public Progress {
 public:
  Stage(std::string name, Progress& progress) : name_(std::move(name)), progress_(progress) {}
  bool report(std::string_view, double fraction) override { return progress_.report(name_, fraction); }

 private:
  std::string name_;
  Progress& progress_;
};

// Our picture with the asset's own models, to look at: rendered at half the size and with loose shadows, since nothing is judged by it.
Result<Picture> authored_picture(const Scene& scene, RenderOptions options, Progress& progress) {
  options.mitsuba_model = false;
  options.expected_noise = std::max(options.expected_noise, 0.25);
  const std::uint32_t width = options.width, height = options.height;
  options.width = (width + 1) / 2;
  options.height = (height + 1) / 2;
  Stage stage("our picture, as authored", progress);
  Result<Rendered> rendered = render(scene, options, &stage);
  if (!rendered) return rendered.error();
  Picture full;
  full.width = width;
  full.height = height;
  for (const Layer& half : rendered->picture.layers) {
    if (half.channels != 3) continue;
    Layer& layer = full.add(half.name, 3);
    for (std::size_t i = 0; i < layer.pixels.size(); ++i) {
      const std::size_t pixel = i / 3, x = pixel % width / 2, y = pixel / width / 2;
      layer.pixels[i] = half.pixels[(y * options.width + x) * 3 + i % 3];
    }
  }
  return full;
}

// Relative standard deviation of a pixel after n samples of one light: area lights over a floor have about 1.4 after one (measured 4 to
// 5 % at 1024).
double expected_noise(std::uint32_t samples) { return 1.4 / std::sqrt(static_cast<double>(samples)); }

double mean_luminance_of(const Picture& picture) {
  const Layer* const layer = picture.find("");
  double sum = 0;
  for (std::size_t i = 0; i + 2 < layer->pixels.size(); i += 3) {
    sum += luminance_of({layer->pixels[i], layer->pixels[i + 1], layer->pixels[i + 2]});
  }
  const std::size_t pixels = layer->pixels.size() / 3;
  return sum / static_cast<double>(pixels);
}

// Everything that the report and compare.json say.
struct Validation {
  Picture ours, mitsuba;
  Report report;
  LossReport losses;
};

Result<Validation> validate_scene(Session& session, const Options& options, Scene& scene, const fs::path& folder) {
  const Result<Size> size = parse_size(options.size);
  if (!size) return size.error();
  const Result<double> max_difference = parse_fraction(options.max_difference);
  if (!max_difference) return max_difference.error();
  const auto camera = choose_camera(scene, options.camera, static_cast<double>(size->width) / size->height);
  if (!camera) return camera.error();
  const auto lit = lit_lights(scene, options.lights, options.mute);
  if (!lit) return lit.error();
  const Result<Mitsuba> mitsuba = locate_mitsuba(options.mitsuba);
  if (!mitsuba) return mitsuba.error();

  ExportOptions export_options;
  export_options.width = size->width;
  export_options.height = size->height;
  export_options.camera = *camera;
  export_options.lit = *lit;
  export_options.samples = options.samples;
  if (options.plugins && mitsuba->variant.starts_with("scalar"))
    return Error{"MITSUBA_VARIANT",
                 fmt::format("expected a vectorised variant for --plugins, found {}", mitsuba->variant),
                 {},
                 "install an LLVM library from 16 on, or leave --plugins out",
                 {}};
  Validation validation;
  const MitsubaParts parts = options.plugins ? MitsubaParts::with_plugins : MitsubaParts::built_in;
  const auto exported = write_mitsuba_light_by_light(scene, folder / "scene.xml", export_options, parts);
  if (!exported) return exported.error();
  session.diagnostics.append(exported->all.diagnostics);
  validation.losses = exported->all.losses;

  PictureRequest request{size->width, size->height, {}, {}, cache_folder(options)};
  for (std::size_t i = 0; i < lit->size(); ++i) request.lights.push_back({scene.lights[(*lit)[i]].name, exported->single[i]});
  std::uint32_t samples = options.samples;
  if (options.seconds > 0) {
    const auto affordable = samples_in(*mitsuba, request, options.seconds);
    if (!affordable) return affordable.error();
    samples = *affordable;
  }
  request.split = split_samples(samples, options.seeds, lit->size());

  Bar bar(session);
  RenderOptions render_options;
  render_options.width = size->width;
  render_options.height = size->height;
  render_options.camera = *camera;
  render_options.lit = *lit;
  render_options.mitsuba_model = true;
  render_options.mitsuba_parts = parts;
  render_options.expected_noise = expected_noise(request.split.per_light());
  render_options.shading_tolerance = options.tolerance;
  render_options.threads = options.threads;
  options.shadows.apply(render_options);
  Stage our_picture("our picture", bar);
  Result<Rendered> rendered = render(scene, render_options, &our_picture);
  if (!rendered) return rendered.error();
  session.diagnostics.append(rendered->diagnostics);
  session.stats["evaluations"] = rendered->stats.evaluations;
  session.stats["shadow_rays"] = rendered->stats.shadow_rays;
  session.stats["images_decoded"] = rendered->stats.images_decoded;
  session.stats["seconds_ours"] = rendered->stats.seconds;
  validation.ours = std::move(rendered->picture);

  Result<Picture> reference = mitsuba_picture(*mitsuba, request, &bar);
  if (!reference) return reference.error();
  validation.mitsuba = std::move(*reference);

  if (differs_as_authored(scene, parts)) {
    Result<Picture> authored = authored_picture(scene, render_options, bar);
    if (!authored) return authored.error();
    validation.report.authored = std::move(*authored);
  }

  CompareOptions compare_options;
  compare_options.max_difference = *max_difference;
  compare_options.samples = request.split.per_light() * static_cast<std::uint32_t>(lit->size());
  std::vector<std::string> object_names;
  for (const Object& object : scene.objects) object_names.push_back(object.name);
  const auto comparison = compare(validation.ours, validation.mitsuba, compare_options, object_names);
  if (!comparison) return comparison.error();
  Report& report = validation.report;
  report.comparison = *comparison;
  for (const std::uint32_t light : *lit) {
    const std::string layer = layer_safe(scene.lights[light].name);
    auto part = compare(validation.ours, validation.mitsuba, compare_options, object_names, layer);
    if (!part) return part.error();
    report.lights.push_back({layer, describe(scene.lights[light]), std::move(*part)});
  }
  report.title = fs::path(options.asset).filename().string();
  report.losses = validation.losses.losses;
  report.ev100 = scene.cameras[*camera].ev100;
  report.facts = {{"Etendue", ETENDUE_VERSION},
                  {"Mitsuba", fmt::format("{}, {}", mitsuba->version, mitsuba->variant)},
                  {"Picture", fmt::format("{} x {}, {} light{}", size->width, size->height, lit->size(), lit->size() == 1 ? "" : "s")},
                  {"Samples per pixel", fmt::format("{} = {} lights x {} seeds x {}", compare_options.samples, lit->size(),
                                                    request.split.seeds, request.split.samples_per_seed)},
                  {"Our picture", fmt::format("{:.1f} s", rendered->stats.seconds)}};
  return validation;
}

Status move_into_place(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_directories(to, error);
  for (const char* const name : {"report.html", "ours.exr", "mitsuba.exr", "compare.json", "scene.xml", "scene_files"}) {
    if (error) break;
    if (!fs::exists(from / name)) continue;
    fs::remove_all(to / name, error);
    fs::rename(from / name, to / name, error);
  }
  if (error) return Error{"FILE_UNWRITABLE", fmt::format("cannot write into {}: {}", to.string(), error.message()), {}, "", {}};
  return Done{};
}

Json result_json(const Validation& validation, const std::string& out) {
  Json json = to_json(validation.report.comparison);
  json["lights"] = Json::object();
  for (const LightSection& light : validation.report.lights) json["lights"][light.name] = to_json(light.comparison);
  json["losses"] = Json::array();
  for (const Loss& loss : validation.losses.losses) json["losses"].push_back({{"what", loss.what}, {"effect", loss.effect}});
  if (validation.report.authored) {
    const double ours = mean_luminance_of(validation.ours);
    if (ours > 0) json["authored_over_mitsuba_model"] = mean_luminance_of(*validation.report.authored) / ours;
  }
  json["report"] = out + "/report.html";
  return json;
}

int run_validate(const Common& common, const Options& options) {
  Session session("validate", common);
  Result<Imported> imported = read_asset(session, options.asset, options.import);
  if (!imported) return session.fail(imported.error());
  if (imported->diagnostics.has_errors()) return session.finish(exit_bad_input);
  const WorkFolder work(options.out);
  if (!work.ok()) return session.fail({"FILE_UNWRITABLE", fmt::format("cannot make a folder beside {}", options.out), {}, "", {}});

  Result<Validation> validation = validate_scene(session, options, imported->scene, work.path());
  if (!validation) return session.fail(validation.error());
  validation->report.diagnostics = session.diagnostics;
  session.result = result_json(*validation, options.out);

  const std::string html = to_html(validation->report, validation->ours, validation->mitsuba);
  const std::string json = session.result.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  const Status steps[] = {
      write_exr(validation->ours, work.path() / "ours.exr"), write_exr(validation->mitsuba, work.path() / "mitsuba.exr"),
      write_file(work.path() / "report.html", std::as_bytes(std::span(html))),
      write_file(work.path() / "compare.json", std::as_bytes(std::span(json))), move_into_place(work.path(), options.out)};
  for (const Status& step : steps) {
    if (!step) return session.fail(step.error());
  }
  session.print(table_of(validation->report.comparison));
  for (const LightSection& light : validation->report.lights) {
    session.print(fmt::format("  light {:<20} {:<10} mean {:+.3f} %  chi2 {:.3f}", light.name, name_of(light.comparison.verdict),
                              100 * light.comparison.mean_rel, light.comparison.chi2_per_pixel));
  }
  for (const std::string& line : grouped(validation->losses.losses)) session.print(fmt::format("  not in Mitsuba's scene: {}", line));
  session.print(fmt::format("report: {}", fs::absolute(fs::path(options.out) / "report.html").lexically_normal().string()));
  return session.finish(exit_status_of(validation->report.comparison.verdict));
}

}  // namespace

void add_validate(CLI::App& app, const Common& common, Run& run) {
  CLI::App* const verb =
      app.add_subcommand("validate", "An asset through our evaluation and through the real Mitsuba 3, compared pixel by pixel");
  auto options = std::make_shared<Options>();
  verb->add_option("ASSET", options->asset, "A light rig or glTF file")->required();
  verb->add_option("--out", options->out, "Folder for report.html, ours.exr, mitsuba.exr, compare.json, scene.xml (replaced)")
      ->capture_default_str();
  verb->add_option("--size", options->size, "WIDTHxHEIGHT")->capture_default_str();
  verb->add_option("--spp", options->samples, "Mitsuba's samples per pixel over all lights and seeds")
      ->capture_default_str()
      ->check(CLI::Range(5, 1 << 24));
  verb->add_option("--seeds", options->seeds, "Independent runs, 5 or more")->capture_default_str()->check(CLI::Range(5, 1024));
  verb->add_option("--time", options->seconds, "Choose --spp so that Mitsuba takes about this many seconds")->check(CLI::Range(1.0, 1e6));
  verb->add_option("--max-diff", options->max_difference, "The difference asked about, as 1% or 0.01")->capture_default_str();
  verb->add_option("--tolerance", options->tolerance,
                   "Of our shading: error of each light at most this part of its value, diffuse and specular together (default: a fiftieth "
                   "of Mitsuba's noise in a pixel)")
      ->check(CLI::Range(1e-9, 0.1));
  verb->add_option("--camera", options->camera, "A camera of the file, or auto");
  verb->add_option("--lights", options->lights, "Only these lights, by name: a,b; the others stay as black shapes");
  verb->add_option("--mute", options->mute, "All but these lights");
  verb->add_option("--mitsuba", options->mitsuba, "The mitsuba command, its Python, or its virtual environment");
  verb->add_option("--cache", options->cache, "Folder for Mitsuba's pictures (default: the user's cache)");
  verb->add_flag("--plugins", options->plugins,
                 "Materials, windows of ranges, spots and photometric webs in Mitsuba as they are, by plugins of our own");
  verb->add_flag("--no-cache", options->no_cache, "Render all of Mitsuba's pictures anew");
  add_shadows(*verb, options->shadows);
  verb->add_option("--threads", options->threads, "Of our renderer; 0: every core")->capture_default_str();
  add_limits(*verb, options->import);
  verb->footer(
      "\nExit status: 0 same, 1 differs, 4 undecided.\n\nExamples:\n  etendue validate kitchen.rig.json --out report\n"
      "  etendue validate room.glb --max-diff 0.2% --spp 4096 --lights key,fill\n"
      "  etendue validate room.glb --tolerance 1e-3\n"
      "  etendue validate lamps.rig.json --plugins");
  verb->callback([&common, &run, options] { run = [&common, options] { return run_validate(common, *options); }; });
}

}  // namespace etendue::cli
