#include "etendue/render.h"

#include "painter.h"

#include <chrono>

namespace etendue {
namespace {

using namespace rendering;

Error problem(const char* code, std::string text, const Scene& scene) { return {code, std::move(text), {scene.file, 0, 0, {}}, {}, {}}; }

Status check(const Scene& scene, const RenderOptions& options) {
  Diagnostics found = validate(scene);
  if (found.has_errors()) {
    Error error = problem("SCENE_INVALID", "the scene has errors and is not rendered", scene);
    error.notes = found.all();
    return error;
  }
  constexpr std::uint32_t largest_side = 16384;
  if (options.width < 1 || options.height < 1 || options.width > largest_side || options.height > largest_side) {
    return problem("EVALUATION_UNSUPPORTED", "expected a picture of 1 to 16384 pixels a side", scene);
  }
  if (options.shadow_samples == 1 || options.shadow_samples > 4096) {
    return problem("EVALUATION_UNSUPPORTED", "expected 2 to 4096 samples of a shadow", scene);
  }
  if (options.camera >= scene.cameras.size()) {
    return problem("CAMERA_MISSING",
                   "camera " + std::to_string(options.camera) + " was asked for, the scene has " + std::to_string(scene.cameras.size()),
                   scene);
  }
  return Done{};
}

// What is at the pixels' centres.
void add_surface_layers(const Stage& stage, const PinholeCamera& camera, const Survey& survey, Picture& picture) {
  Layer object = picture.add("object", 1), emitter = picture.add("emitter", 1), depth = picture.add("depth", 1);
  Layer normal = picture.add("normal", 3), albedo = picture.add("albedo", 3);
  for (std::size_t pixel = 0; pixel < object.pixels.size(); ++pixel) {
    const std::size_t column = pixel % picture.width, row = pixel / picture.width;
    const auto x = static_cast<double>(column), y = static_cast<double>(row);
    emitter.pixels[pixel] = survey.touches_emitter(pixel) ? 1.0f : 0.0f;
    const Ray ray = camera.through(x + 0.5, y + 0.5);
    const auto point = stage.first(ray);
    if (!point) continue;
    const Thing& thing = stage.thing(point->thing);
    object.pixels[pixel] = thing.object ? 1.0f + static_cast<float>(*thing.object) : -1.0f - static_cast<float>(*thing.light);
    depth.pixels[pixel] = static_cast<float>(point->distance);
    const auto shading = shading_point(thing.paint, *point, -ray.direction);
    const Vec3d n = shading ? shading->normal : point->normal;
    const Rgb base = thing.paint != nullptr ? base_colour_at(*thing.paint, point->uv) : Rgb{};
    for (int c = 0; c < 3; ++c) {
      normal.pixels[3 * pixel + static_cast<std::size_t>(c)] = static_cast<float>(n[c]);
      albedo.pixels[3 * pixel + static_cast<std::size_t>(c)] = static_cast<float>(base[c]);
    }
  }
  for (Layer* layer : {&object, &emitter, &depth, &normal, &albedo}) *picture.find(layer->name) = std::move(*layer);
}

// Of all lights.
struct Sums {
  explicit Sums(std::size_t pixels) : value(pixels), variance(pixels), bound(pixels) {}
  std::vector<Rgb> value, variance, bound;
};

void add_light_layers(const LightPainter& painter, const std::string& name, Sums& sums, Picture& picture) {
  const auto store = [&](const std::string& layer_name, const std::vector<Rgb>& values, std::vector<Rgb>& total) {
    Layer& layer = picture.add(layer_name, 3);
    for (std::size_t i = 0; i < values.size(); ++i) {
      for (int c = 0; c < 3; ++c) layer.pixels[3 * i + static_cast<std::size_t>(c)] = static_cast<float>(values[i][c]);
      total[i] += values[i];
    }
  };
  const std::string suffix = name.substr(name.find('.'));
  store(name, painter.value(), sums.value);
  store("light_variance" + suffix, painter.variance(), sums.variance);
  store("light_variance_bound" + suffix, painter.bound(), sums.bound);
}

void copy(const std::vector<Rgb>& values, Layer& layer) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (int c = 0; c < 3; ++c) layer.pixels[3 * i + static_cast<std::size_t>(c)] = static_cast<float>(values[i][c]);
  }
}

}  // namespace

Result<Rendered> render(const Scene& scene, const RenderOptions& options, Progress* progress) {
  const auto start = std::chrono::steady_clock::now();
  if (Status checked = check(scene, options); !checked) return checked.error();
  Rendered out;
  Result<std::unique_ptr<Stage>> built = Stage::build(scene, options, out.diagnostics);
  if (!built) return built.error();
  const Stage& stage = **built;
  const Camera& eye = scene.cameras[options.camera];
  const PinholeCamera camera(eye, options.width, options.height);
  const Error cancelled = problem("CANCELLED", "the picture was not finished", scene);

  RowRunner rows(options.height, options.threads, Survey::passes + LightPainter::passes * stage.lights().size(), progress);
  Survey survey(stage, camera, {options.width, options.height, 0.02 * std::clamp(options.expected_noise, 1e-3, 0.1), options.seed});
  if (!survey.run(rows)) return cancelled;

  Picture& picture = out.picture;
  picture.width = options.width;
  picture.height = options.height;
  picture.numbers["whiteLuminance"] = 1;
  if (eye.ev100) picture.numbers["etendue:ev100"] = *eye.ev100;
  picture.add("", 3);
  picture.add("variance", 3);
  picture.add("variance_bound", 3);
  const std::size_t pixels = std::size_t{options.width} * options.height;
  Sums sums(pixels);
  for (const StageLight& light : stage.lights()) {
    LightPainter painter(stage, camera, survey, light,
                         {options.width, options.height, options.expected_noise, options.seed, options.shadows, options.shadow_samples,
                          options.shading_tolerance});
    if (!painter.run(rows)) return cancelled;
    add_light_layers(painter, light.layer, sums, picture);
  }
  copy(sums.value, *picture.find(""));
  copy(sums.variance, *picture.find("variance"));
  copy(sums.bound, *picture.find("variance_bound"));
  add_surface_layers(stage, camera, survey, picture);

  out.stats.primary_rays = rows.counts().primary;
  out.stats.shadow_rays = rows.counts().shadow;
  out.stats.evaluations = rows.counts().evaluations;
  for (std::size_t i = 0; i < pixels; ++i) ++(survey.regions(i) != nullptr ? out.stats.split_pixels : out.stats.smooth_pixels);
  out.stats.images_decoded = stage.images_decoded();
  out.stats.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

}  // namespace etendue
