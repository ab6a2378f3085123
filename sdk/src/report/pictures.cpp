// The difference is stored, not the reference: a half float has 11 bits, and two rounded pictures would differ by .05 % everywhere.
#include "pictures.h"

#include "encode.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace etendue::report_detail {
namespace {

using Json = nlohmann::json;

constexpr std::array<double, 3> luminance_weights{.2126, .7152, .0722};  // ITU-R BT.709-6, item 3.2
constexpr double bytes_a_pixel = 14 * 4 / 3.;                            // 7 halves in base64
constexpr double most_bytes = 24e6;

const Layer* colour_layer(const Picture& picture, const std::string& name) {
  const Layer* layer = picture.find(name);
  return layer && layer->channels == 3 && layer->pixels.size() == 3 * std::size_t{picture.width} * picture.height ? layer : nullptr;
}

// Means of bin x bin pixels; the last ones of a row or column average what is there.
std::vector<float> binned(const std::vector<float>& values, std::uint32_t width, std::uint32_t height, std::uint32_t bin,
                          std::size_t channels) {
  if (bin == 1) return values;
  const std::uint32_t out_width = (width + bin - 1) / bin, out_height = (height + bin - 1) / bin;
  std::vector<float> result(out_width * std::size_t{out_height} * channels);
  for (std::uint32_t y = 0; y < out_height; ++y) {
    for (std::uint32_t x = 0; x < out_width; ++x) {
      for (std::size_t c = 0; c < channels; ++c) {
        double sum = 0, count = 0;
        for (std::uint32_t j = y * bin; j < std::min(height, (y + 1) * bin); ++j) {
          for (std::uint32_t i = x * bin; i < std::min(width, (x + 1) * bin); ++i) {
            sum += values[(std::size_t{j} * width + i) * channels + c];
            count += 1;
          }
        }
        result[(std::size_t{y} * out_width + x) * channels + c] = static_cast<float>(sum / count);
      }
    }
  }
  return result;
}

Json encoded(const std::vector<float>& values) {
  Encoded e = encode(values);
  return {{"factor", e.factor}, {"data", std::move(e.base64)}};
}

struct Names {
  std::string values, variance;
};

// Of the luminance of a bin's mean; the channels of a pixel share their noise, so their standard deviations add.
std::vector<float> luminance_sigma(const Picture& ours, const Picture& reference, const Names& names, std::uint32_t bin) {
  const std::size_t pixels = std::size_t{ours.width} * ours.height;
  std::vector<float> variance(pixels);
  const Layer* a = colour_layer(ours, names.variance);
  const Layer* b = colour_layer(reference, names.variance);
  for (std::size_t p = 0; p < pixels; ++p) {
    double sigma = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double v = (a ? a->pixels[3 * p + c] : 0.0) + (b ? b->pixels[3 * p + c] : 0.0);
      sigma += luminance_weights[c] * std::sqrt(std::max(0.0, v));
    }
    variance[p] = static_cast<float>(sigma * sigma);
  }
  variance = binned(variance, ours.width, ours.height, bin, 1);
  for (float& v : variance) v = std::sqrt(v) / static_cast<float>(bin);
  return variance;
}

Json tab(const Picture& ours, const Picture& reference, const Names& names, std::uint32_t bin) {
  const Layer* a = colour_layer(ours, names.values);
  const Layer* b = colour_layer(reference, names.values);
  std::vector<float> black;
  if (!a || !b) black.assign(3 * std::size_t{ours.width} * ours.height, 0.F);
  const std::vector<float>& our_values = a ? a->pixels : black;
  std::vector<float> difference = our_values;
  for (std::size_t i = 0; b && i < difference.size(); ++i) difference[i] -= b->pixels[i];
  return {{"width", (ours.width + bin - 1) / bin},
          {"height", (ours.height + bin - 1) / bin},
          {"bin", bin},
          {"ours", encoded(binned(our_values, ours.width, ours.height, bin, 3))},
          {"difference", encoded(binned(difference, ours.width, ours.height, bin, 3))},
          {"sigma", encoded(luminance_sigma(ours, reference, names, bin))}};
}

// The least bins that keep the file within bounds; the whole picture first, the lights share what is left.
std::uint32_t bin_for(double pixels, double budget) {
  std::uint32_t bin = 1;
  while (pixels * bytes_a_pixel / (double{1} * bin * bin) > budget) ++bin;
  return bin;
}

// EV100 that puts the log-average luminance at middle grey: L = 2^EV K/100 with K = 12.5 (ISO 2720).
double automatic_ev100(const Picture& ours) {
  const Layer* layer = colour_layer(ours, "");
  double sum = 0, count = 0;
  for (std::size_t i = 0; layer && i + 2 < layer->pixels.size(); i += 3) {
    double luminance = 0;
    for (std::size_t c = 0; c < 3; ++c) luminance += luminance_weights[c] * layer->pixels[i + c];
    if (!(luminance > 0) || !std::isfinite(luminance)) continue;
    sum += std::log2(luminance);
    count += 1;
  }
  return count > 0 ? sum / count + 3 : 0;  // log2(100 / 12.5) = 3
}

}  // namespace

std::string picture_data(const Report& report, const Picture& ours, const Picture& reference) {
  Json data;
  data["ev100"] = report.ev100 ? *report.ev100 : automatic_ev100(ours);
  data["tabs"] = Json::array();
  if (ours.width != reference.width || ours.height != reference.height || !colour_layer(ours, "") || !colour_layer(reference, ""))
    return data.dump();
  const double pixels = double{1} * ours.width * ours.height;

  const std::uint32_t bin = bin_for(pixels, most_bytes / 2);
  Json all = tab(ours, reference, {"", "variance"}, bin);
  all["name"] = "All lights";
  all["verdict"] = name_of(report.comparison.verdict);
  if (report.authored && report.authored->width == ours.width && report.authored->height == ours.height &&
      colour_layer(*report.authored, "")) {
    all["authored"] = encoded(binned(colour_layer(*report.authored, "")->pixels, ours.width, ours.height, bin, 3));
  }
  data["tabs"].push_back(std::move(all));

  const std::uint32_t light_bin = report.lights.empty() ? 1 : bin_for(pixels, most_bytes / 2 / static_cast<double>(report.lights.size()));
  for (const LightSection& light : report.lights) {
    const Names names{"light." + layer_safe(light.name), "light_variance." + layer_safe(light.name)};
    if (!colour_layer(ours, names.values) && !colour_layer(reference, names.values)) continue;
    Json one = tab(ours, reference, names, std::max(bin, light_bin));
    one["name"] = light.name;
    one["description"] = light.description;
    one["verdict"] = name_of(light.comparison.verdict);
    data["tabs"].push_back(std::move(one));
  }
  std::string text = data.dump(-1, ' ', false, Json::error_handler_t::replace);
  // "</script" or "<!--" inside a name would end the script element.
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at)) text.replace(at, 1, "\\u003c");
  return text;
}

}  // namespace etendue::report_detail
