// etendue render: our picture alone, direct light.
#include "etendue/render.h"

#include <fmt/format.h>

#include <filesystem>

#include "limits.h"
#include "shadows.h"
#include "verbs.h"

namespace etendue::cli {
namespace {

struct Options {
  std::string asset, out, size = "512x512", camera, lights, mute;
  ImportOptions import;
  ShadowOptions shadows;
  double tolerance = 0.001;
  unsigned threads = 0;
  std::uint64_t seed = 1;
  bool force = false, mitsuba_model = false;
};

int run_render(const Common& common, const Options& options) {
  Session session("render", common);
  if (std::filesystem::exists(options.out) && !options.force) {
    return session.fail({"USAGE", fmt::format("{} is there already", options.out), {}, "--force replaces it", {}});
  }
  const Result<Size> size = parse_size(options.size);
  if (!size) return session.fail(size.error());
  Result<Imported> imported = read_asset(session, options.asset, options.import);
  if (!imported) return session.fail(imported.error());
  if (imported->diagnostics.has_errors()) return session.finish(exit_bad_input);
  Scene& scene = imported->scene;
  const auto camera = choose_camera(scene, options.camera, static_cast<double>(size->width) / size->height);
  if (!camera) return session.fail(camera.error());
  const auto lit = lit_lights(scene, options.lights, options.mute);
  if (!lit) return session.fail(lit.error());

  RenderOptions render_options;
  render_options.width = size->width;
  render_options.height = size->height;
  render_options.camera = *camera;
  render_options.lit = *lit;
  render_options.mitsuba_model = options.mitsuba_model;
  // Shadows are computed to a fifth of the noise that is given, shading to a fiftieth; --tolerance, a tenth, lies between.
  render_options.expected_noise = 10 * options.tolerance;
  render_options.threads = options.threads;
  render_options.seed = options.seed;
  options.shadows.apply(render_options);
  Result<Rendered> rendered = [&] {
    Bar bar(session);
    return render(scene, render_options, &bar);
  }();
  if (!rendered) return session.fail(rendered.error());
  session.diagnostics.append(rendered->diagnostics);
  const RenderStats& stats = rendered->stats;
  session.stats.update(Json{{"primary_rays", stats.primary_rays},
                            {"shadow_rays", stats.shadow_rays},
                            {"evaluations", stats.evaluations},
                            {"smooth_pixels", stats.smooth_pixels},
                            {"split_pixels", stats.split_pixels},
                            {"images_decoded", stats.images_decoded},
                            {"seconds", stats.seconds}});
  const Status written = write_exr(rendered->picture, options.out);
  if (!written) return session.fail(written.error());
  session.result = {{"file", options.out}, {"width", size->width}, {"height", size->height}, {"layers", Json::array()}};
  for (const Layer& layer : rendered->picture.layers) session.result["layers"].push_back(layer.name);
  session.print(fmt::format("{}: {} x {}, {} layers, {:.1f} s", options.out, size->width, size->height, rendered->picture.layers.size(),
                            stats.seconds));
  return session.finish(exit_done);
}

}  // namespace

void add_render(CLI::App& app, const Common& common, Run& run) {
  CLI::App* const verb = app.add_subcommand("render", "Our picture alone, direct light, as a layered OpenEXR file");
  auto options = std::make_shared<Options>();
  verb->add_option("ASSET", options->asset, "A light rig or glTF file")->required();
  verb->add_option("OUT", options->out, "OpenEXR file")->required();
  verb->add_option("--size", options->size, "WIDTHxHEIGHT")->capture_default_str();
  verb->add_option("--camera", options->camera, "A camera of the file, or auto");
  verb->add_option("--lights", options->lights, "Only these lights, by name: a,b; the others stay as black shapes");
  verb->add_option("--mute", options->mute, "All but these lights");
  verb->add_option(
          "--tolerance", options->tolerance,
          "Relative error of a pixel that is aimed at; each light on a surface, diffuse and specular together, is asked for a fifth of "
          "it, by the cheapest way that keeps that")
      ->capture_default_str()
      ->check(CLI::Range(1e-6, 0.1));
  add_shadows(*verb, options->shadows);
  verb->add_option("--seed", options->seed, "Of the shadows' samples")->capture_default_str();
  verb->add_option("--threads", options->threads, "0: every core")->capture_default_str();
  verb->add_flag("--mitsuba-model", options->mitsuba_model, "Materials and ranges as Mitsuba's scene has them");
  verb->add_flag("--force", options->force, "Replace OUT");
  add_limits(*verb, options->import);
  verb->footer(
      "\nExamples:\n  etendue render kitchen.rig.json kitchen.exr\n  etendue render kitchen.rig.json close.exr --tolerance 1e-4\n"
      "  etendue render room.glb key.exr --lights key --size 1280x720\n"
      "  etendue render room.glb draft.exr --shadows ratio --shadow-samples 8");
  verb->callback([&common, &run, options] { run = [&common, options] { return run_render(common, *options); }; });
}

}  // namespace etendue::cli
