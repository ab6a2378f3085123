// K independent runs as one picture: their mean and the variance of that mean.
#include "etendue/compare.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace etendue {
namespace {

constexpr std::size_t least_seeds = 5;

std::string variance_name(const std::string& layer) { return layer.empty() ? "variance" : "light_variance." + layer.substr(6); }

Error refuse(const char* code, std::string text, std::string hint = {}) {
  Error error;
  error.code = code;
  error.text = std::move(text);
  error.hint = std::move(hint);
  return error;
}

bool is_pooled(const std::string& layer) { return layer.empty() || layer.rfind("light.", 0) == 0; }

bool all_have(const std::vector<Picture>& runs, const std::string& layer, int channels) {
  return std::all_of(runs.begin(), runs.end(), [&](const Picture& run) {
    const Layer* found = run.find(layer);
    return found && found->channels == channels &&
           found->pixels.size() == std::size_t{run.width} * run.height * static_cast<std::size_t>(channels);
  });
}

// mean = sum x / K; variance of the mean = sum (x - mean)^2 / (K (K - 1)), in double, in two passes.
void pool_layer(const std::vector<Picture>& runs, const std::string& name, int channels, Picture& result) {
  std::vector<const float*> values;
  values.reserve(runs.size());
  for (const Picture& run : runs) values.push_back(run.find(name)->pixels.data());
  const double count = static_cast<double>(values.size());
  std::vector<float>& mean = result.add(name, channels).pixels;
  std::vector<float> variance(mean.size());
  for (std::size_t i = 0; i < mean.size(); ++i) {
    double sum = 0, squares = 0;
    for (const float* value : values) sum += value[i];
    for (const float* value : values) squares += (value[i] - sum / count) * (value[i] - sum / count);
    mean[i] = static_cast<float>(sum / count);
    variance[i] = static_cast<float>(squares / (count * (count - 1)));
  }
  result.add(variance_name(name), channels).pixels = std::move(variance);
}

}  // namespace

Result<Picture> pool(const std::vector<Picture>& runs) {
  if (runs.size() < least_seeds) {
    return refuse("REFERENCE_TOO_FEW_SEEDS",
                  fmt::format("the reference has {} independent run{}; its noise can be judged from {} on", runs.size(),
                              runs.size() == 1 ? "" : "s", least_seeds),
                  "render the reference several times with different seeds, and give all the pictures");
  }
  for (const Picture& run : runs) {
    if (run.width != runs[0].width || run.height != runs[0].height) {
      return refuse("PICTURE_SIZE_MISMATCH", fmt::format("the reference's runs differ in size: {} x {} and {} x {}", runs[0].width,
                                                         runs[0].height, run.width, run.height));
    }
  }
  if (!all_have(runs, "", 3)) return refuse("PICTURE_UNSUITABLE", "a run of the reference has no R, G, B picture");

  Picture result;
  result.width = runs[0].width;
  result.height = runs[0].height;
  result.numbers = runs[0].numbers;
  result.texts = runs[0].texts;
  for (const Layer& layer : runs[0].layers) {
    if (is_pooled(layer.name) && all_have(runs, layer.name, layer.channels)) pool_layer(runs, layer.name, layer.channels, result);
  }
  result.numbers["etendue:seeds"] = static_cast<double>(runs.size());
  return result;
}

}  // namespace etendue
