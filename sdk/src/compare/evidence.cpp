#include "evidence.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace etendue::compare_detail {
namespace {

// Floor of the weights' sigma, as a part of the picture's mean: what is too dark to be seen must not outweigh what is seen.
constexpr double least_weight_sigma = 1e-3;

// Noise of a pixel, relative to its value, from which on it counts as the doing of few samples: n of equal light that n are expected of
// have 1 / sqrt(n).
constexpr double few_samples = 0.5;

Error unsuitable(std::string text) { return Error{"PICTURE_UNSUITABLE", std::move(text), {}, {}, {}}; }

const Layer* layer_of_size(const Picture& picture, const std::string& name, int channels) {
  const Layer* layer = picture.find(name);
  const std::size_t size = std::size_t{picture.width} * picture.height * static_cast<std::size_t>(channels);
  return layer && layer->channels == channels && layer->pixels.size() == size ? layer : nullptr;
}

Status find_bad_pixel(const Layer& layer, const Picture& picture, const char* whose) {
  const auto bad = std::find_if_not(layer.pixels.begin(), layer.pixels.end(), [](float value) { return std::isfinite(value); });
  if (bad == layer.pixels.end()) return Done{};
  const std::size_t pixel = static_cast<std::size_t>(bad - layer.pixels.begin()) / static_cast<std::size_t>(layer.channels);
  return unsuitable(fmt::format("{}: pixel {},{} of layer '{}' is {}, expected a finite number", whose, pixel % picture.width,
                                pixel / picture.width, layer.name, *bad));
}

// Row sums, then column sums of them, over a window of 5, both of the values and of how many were admitted.
void box_sum(std::vector<double>& values, std::uint32_t width, std::uint32_t height, int channels) {
  constexpr int reach = 2;
  const auto pass = [&](std::uint32_t length, std::uint32_t lines, std::size_t step, std::size_t line_step) {
    std::vector<double> copy(length);
    for (std::uint32_t line = 0; line < lines; ++line) {
      for (int c = 0; c < channels; ++c) {
        double* const start = values.data() + line * line_step + static_cast<std::size_t>(c);
        for (std::uint32_t i = 0; i < length; ++i) copy[i] = start[i * step];
        for (int i = 0; i < static_cast<int>(length); ++i) {
          double sum = 0;
          for (int j = std::max(0, i - reach); j <= std::min(static_cast<int>(length) - 1, i + reach); ++j)
            sum += copy[static_cast<std::size_t>(j)];
          start[static_cast<std::size_t>(i) * step] = sum;
        }
      }
    }
  };
  const auto channel_count = static_cast<std::size_t>(channels);
  pass(width, height, channel_count, width * channel_count);
  pass(height, width, width * channel_count, channel_count);
}

}  // namespace

std::vector<double> mean_around(const std::vector<double>& values, std::uint32_t width, std::uint32_t height,
                                const std::vector<bool>& emitter) {
  const std::size_t pixels = std::size_t{width} * height;
  std::vector<double> sums(values.size()), counts(pixels);
  for (std::size_t p = 0; p < pixels; ++p) {
    if (emitter[p]) continue;
    counts[p] = 1;
    for (std::size_t c = 0; c < 3; ++c) sums[3 * p + c] = values[3 * p + c];
  }
  box_sum(sums, width, height, 3);
  box_sum(counts, width, height, 1);
  for (std::size_t p = 0; p < pixels; ++p) {
    const double own = emitter[p] ? 0 : 1;
    const double others = counts[p] - own;
    for (std::size_t c = 0; c < 3; ++c) {
      double& sum = sums[3 * p + c];
      sum = emitter[p] || others < 1 ? values[3 * p + c] : std::max(0.0, sum - values[3 * p + c]) / others;
    }
  }
  return sums;
}

Result<Evidence> gather(const Picture& ours, const Picture& reference, const std::string& light) {
  if (ours.width != reference.width || ours.height != reference.height) {
    return Error{"PICTURE_SIZE_MISMATCH",
                 fmt::format("ours is {} x {}, the reference {} x {}", ours.width, ours.height, reference.width, reference.height),
                 {},
                 {},
                 {}};
  }
  if (ours.width == 0 || ours.height == 0) return unsuitable("the pictures have no pixels");
  const auto seeds = reference.numbers.find("etendue:seeds");
  if (seeds == reference.numbers.end() || !(seeds->second >= 5)) {
    return Error{"REFERENCE_TOO_FEW_SEEDS",
                 "the reference does not say that it is the mean of 5 or more independent runs",
                 {},
                 "pool() makes such a reference from single runs",
                 {}};
  }

  const std::string layer_name = light.empty() ? "" : "light." + layer_safe(light);
  const std::string variance_name = light.empty() ? "variance" : "light_variance." + layer_safe(light);
  const Layer* our_values = layer_of_size(ours, layer_name, 3);
  const Layer* their_values = layer_of_size(reference, layer_name, 3);
  const Layer* their_variance = layer_of_size(reference, variance_name, 3);
  const Layer* our_variance = layer_of_size(ours, variance_name, 3);
  const Layer* our_bound = layer_of_size(ours, light.empty() ? "variance_bound" : "light_variance_bound." + layer_safe(light), 3);
  if (!their_values || !their_variance || (!our_values && light.empty())) {
    const bool in_ours = their_values && their_variance;
    return Error{"LAYER_MISSING",
                 fmt::format("{} has no three-channel layer '{}'", in_ours ? "our picture" : "the reference",
                             their_values ? variance_name : layer_name),
                 {},
                 {},
                 {}};
  }
  for (const Layer* layer : {our_values, our_variance, our_bound}) {
    if (!layer) continue;
    if (Status status = find_bad_pixel(*layer, ours, "our picture"); !status) return status.error();
  }
  for (const Layer* layer : {their_values, their_variance}) {
    if (Status status = find_bad_pixel(*layer, reference, "the reference"); !status) return status.error();
  }

  Evidence e;
  e.width = ours.width;
  e.height = ours.height;
  e.seeds = static_cast<int>(std::min(seeds->second, 1e6));
  const std::size_t count = e.pixels();
  e.ours.assign(3 * count, 0.0);
  if (our_values) e.ours.assign(our_values->pixels.begin(), our_values->pixels.end());
  e.reference.assign(their_values->pixels.begin(), their_values->pixels.end());

  double total = 0;
  for (double value : e.reference) total += std::abs(value);
  const double mean = total / static_cast<double>(3 * count);
  e.variance.resize(3 * count);
  e.scatter.resize(3 * count);
  e.bound.resize(3 * count);
  double counted = 0;
  for (std::size_t i = 0; i < 3 * count; ++i) {
    const double rounding = float_accumulation * e.reference[i];
    const double theirs = std::max(0.0F, their_variance->pixels[i]), own = our_variance ? std::max(0.0F, our_variance->pixels[i]) : 0;
    // Where few samples of the reference saw light its variance is unknown, whatever those say: the light that most of them saw may be that
    // of the others. Were light of the picture's mean seen with the probability that gives ours, K trials would have the variance
    // |ours| mean / K; a seed is at least one trial.
    const bool seldom_seen = theirs >= few_samples * few_samples * e.reference[i] * e.reference[i];
    const double unknown = seldom_seen ? std::abs(e.ours[i]) * mean / e.seeds : 0;
    const double supposed = our_bound ? std::clamp(static_cast<double>(our_bound->pixels[i]), 0.0, own) : 0;
    e.variance[i] = theirs + own + rounding * rounding + unknown;
    e.scatter[i] = theirs;
    e.bound[i] = rounding * rounding + unknown + supposed;
    if (!(e.variance[i] > 0)) continue;
    e.own_noise += own / e.variance[i];
    counted += 1;
  }
  e.own_noise /= std::max(counted, 1.0);

  e.emitter.assign(count, false);
  e.object.assign(count, 0);
  const Layer* emitter = layer_of_size(ours, "emitter", 1);
  const Layer* object = layer_of_size(ours, "object", 1);
  for (std::size_t p = 0; p < count; ++p) {
    e.emitter[p] = emitter && emitter->pixels[p] > 0;
    if (object && object->pixels[p] > 0 && object->pixels[p] < 1e7F) e.object[p] = static_cast<int>(object->pixels[p]);
  }
  e.around = mean_around(e.variance, e.width, e.height, e.emitter);
  for (double& value : e.around) value += least_weight_sigma * least_weight_sigma * mean * mean;
  return e;
}

std::vector<std::string> lights_of(const Picture& picture) {
  std::vector<std::string> names;
  for (const Layer& layer : picture.layers) {
    if (layer.name.rfind("light.", 0) == 0 && layer.channels == 3) names.push_back(layer.name.substr(6));
  }
  return names;
}

}  // namespace etendue::compare_detail
