// Lines, in per cent of the light in all penumbrae: samples; by how much the unbiased form is off and the standard error of that; by how
// much the ratio is above it, from the same samples, and the standard error; the root mean square of that difference over the pixels; noise
// of a pixel in both forms, and the mean square of each over the variance that it states; pixels. Arguments: rig file, side of the picture
// in pixels (64), seeds (16), samples (several). The picture that the bias is counted from is the unbiased form's at 1024 samples, meaned
// over as many seeds of its own. A pixel counts where the floor, the first object, is in the penumbra of a light that has an extent; which
// these are is asked of a further seed, since a picture is off where it is asked.
#include <fmt/core.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "etendue/render.h"
#include "importers/rig/rig.h"

namespace {

using namespace etendue;

struct Run {
  std::vector<std::vector<double>> values, variances;  // of each seed
};

// Mean over a sequence, and the variance of one.
struct Spread {
  double mean = 0, variance = 0;
};
template <class F>
Spread spread(std::size_t count, const F& value) {
  Spread out;
  const auto n = static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) out.mean += value(i) / n;
  for (std::size_t i = 0; i < count; ++i) out.variance += (value(i) - out.mean) * (value(i) - out.mean) / (n - 1);
  return out;
}

class Trial {
 public:
  Trial(Scene scene, std::uint32_t side, std::uint32_t seeds) : scene_(std::move(scene)), seeds_(seeds) {
    options_.width = options_.height = side;
    for (std::uint32_t i = 0; i < scene_.lights.size(); ++i)
      if (!std::holds_alternative<PointShape>(scene_.lights[i].shape)) options_.lit.push_back(i);
    find_penumbrae();
    reference_ = run(Shadows::unbiased, most_samples, 1000);
  }

  void print(std::uint32_t samples) const {
    const Run unbiased = run(Shadows::unbiased, samples, 1), ratio = run(Shadows::ratio, samples, 1);
    const auto n = static_cast<double>(seeds_);
    const Spread light = total(reference_);
    const Spread off = spread(seeds_, [&](std::size_t s) { return sum(unbiased.values[s]); });
    const Spread bias = spread(seeds_, [&](std::size_t s) { return sum(ratio.values[s]) - sum(unbiased.values[s]); });
    const double pixels = static_cast<double>(penumbra_.size()), percent = 100 / light.mean;
    double bias_squares = 0;
    for (const std::size_t i : penumbra_) {
      const Spread here = spread(seeds_, [&](std::size_t s) { return ratio.values[s][i] - unbiased.values[s][i]; });
      bias_squares += here.mean * here.mean - here.variance / n;  // the square of a mean has its own variance in it
    }
    const auto [noise, honest] = noise_of(unbiased);
    const auto [ratio_noise, ratio_honest] = noise_of(ratio);
    fmt::print("{} {:.4f} {:.4f} {:.4f} {:.4f} {:.3f} {:.3f} {:.3f} {:.3f} {:.3f} {}\n", samples, percent * (off.mean - light.mean),
               percent * std::sqrt((off.variance + light.variance) / n), percent * bias.mean, percent * std::sqrt(bias.variance / n),
               percent * std::sqrt(std::max(0.0, bias_squares) * pixels), percent * noise, percent * ratio_noise, honest, ratio_honest,
               penumbra_.size());
  }

 private:
  static constexpr std::uint32_t most_samples = 1024;

  // Lights and pixels in whose penumbra the floor is.
  void find_penumbrae() {
    Scene open = scene_;
    open.objects.resize(1);
    options_.shadow_samples = most_samples;
    options_.seed = 1000000;
    const Picture picture = made(options_, open), shown = made(options_, scene_);
    const std::vector<double> unblocked = layers(picture, "light."), shadowed = layers(shown, "light.");
    const Layer &object = *shown.find("object"), &emitter = *picture.find("emitter");
    for (std::size_t i = 0; i < unblocked.size(); ++i) {
      const std::size_t pixel = i % object.pixels.size();
      const double share = shadowed[i] / unblocked[i];
      if (object.pixels[pixel] == 1 && emitter.pixels[pixel] == 0 && share > 0.01 && share < 0.99) penumbra_.push_back(i);
    }
  }

  Run run(Shadows shadows, std::uint32_t samples, std::uint64_t first_seed) const {
    RenderOptions options = options_;
    options.shadows = shadows;
    options.shadow_samples = samples;
    Run out;
    for (options.seed = first_seed; options.seed < first_seed + seeds_; ++options.seed) {
      const Picture picture = made(options, scene_);
      out.values.push_back(layers(picture, "light."));
      out.variances.push_back(layers(picture, "light_variance."));
    }
    return out;
  }

  double sum(const std::vector<double>& values) const {
    double out = 0;
    for (const std::size_t i : penumbra_) out += values[i];
    return out;
  }
  Spread total(const Run& run) const {
    return spread(seeds_, [&](std::size_t s) { return sum(run.values[s]); });
  }
  // Root mean square of a pixel's noise times the number of pixels, and the mean square of it over the variance stated.
  std::pair<double, double> noise_of(const Run& run) const {
    double noise = 0, stated = 0;
    for (const std::size_t i : penumbra_) noise += spread(seeds_, [&](std::size_t s) { return run.values[s][i]; }).variance;
    for (const std::vector<double>& variances : run.variances) stated += sum(variances) / static_cast<double>(seeds_);
    return {std::sqrt(noise * static_cast<double>(penumbra_.size())), noise / stated};
  }

  static Picture made(const RenderOptions& options, const Scene& scene) {
    Result<Rendered> rendered = render(scene, options);
    if (!rendered) {
      fmt::print(stderr, "{}\n", rendered.error().text);
      std::exit(1);
    }
    return std::move(rendered->picture);
  }
  // Green of every layer whose name begins so.
  static std::vector<double> layers(const Picture& picture, const std::string& prefix) {
    std::vector<double> out;
    for (const Layer& layer : picture.layers) {
      if (!layer.name.starts_with(prefix)) continue;
      for (std::size_t i = 1; i < layer.pixels.size(); i += 3) out.push_back(static_cast<double>(layer.pixels[i]));
    }
    return out;
  }

  Scene scene_;
  std::uint32_t seeds_;
  RenderOptions options_;
  std::vector<std::size_t> penumbra_;
  Run reference_;
};

}  // namespace

int main(int argc, char** argv) {
  const auto number = [&](int i, int otherwise) { return static_cast<std::uint32_t>(argc > i ? std::atoi(argv[i]) : otherwise); };
  if (argc < 2) return 2;
  const Registry no_others;
  const auto imported = make_rig_importer(no_others)->read(argv[1], {});
  if (!imported) {
    fmt::print(stderr, "{}\n", imported.error().text);
    return 1;
  }
  const Trial trial(imported->scene, number(2, 64), number(3, 16));
  std::vector<std::uint32_t> counts{2, 4, 8, 16, 32, 128, 1024};
  if (argc > 4) counts.clear();
  for (int i = 4; i < argc; ++i) counts.push_back(number(i, 0));
  for (const std::uint32_t samples : counts) trial.print(samples);
}
