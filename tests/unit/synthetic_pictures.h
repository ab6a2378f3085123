// A floor with painted rectangles under small lamps, in closed form, and noise of known kinds: pictures whose every difference is known.
#pragma once

#include "etendue/compare.h"
#include "etendue/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace etendue::synthetic {

// A lamp above the floor (x to the right, y down, in units of the picture's width), shining along its axis.
struct Lamp {
  std::string name;
  double x = .5, y = .5, height = .5;
  double flux = 1;
  double tilt_deg = 0;  // of the axis from straight down, towards +x
  double cone_deg = 0;  // 0: cosine emission (a small rectangle); else a spot whose falloff ends at this half angle
  std::array<double, 3> colour{1, 1, 1};

  double at(double px, double py) const {
    const double dx = px - x, dy = py - y, d2 = dx * dx + dy * dy + height * height, d = std::sqrt(d2);
    const double tilt = tilt_deg * std::numbers::pi / 180;
    const double along = (dx * std::sin(tilt) + height * std::cos(tilt)) / d;  // cosine of the angle to the axis
    double emission = std::max(0.0, along);
    if (cone_deg > 0) {
      const double edge = std::cos(cone_deg * std::numbers::pi / 180), inner = std::cos(.5 * cone_deg * std::numbers::pi / 180);
      const double t = std::clamp((along - edge) / (inner - edge), 0.0, 1.0);
      emission = t * t * (3 - 2 * t);
    }
    return flux * emission * height / (d2 * d);
  }
};

inline double albedo(double x, double y) {
  if (x > .2 && x < .43 && y > .31 && y < .72) return .75;
  if (x > .55 && x < .81 && y > .57 && y < .83) return .2;
  if ((x - .7) * (x - .7) + (y - .25) * (y - .25) < .012) return .65;
  return .4;
}

struct View {
  std::uint32_t size = 128;
  double shift_x = 0, shift_y = 0;  // in pixels, to the right and down
};

// Box-filtered by 4 x 4 points a pixel.
inline std::vector<float> draw(const Lamp& lamp, const View& view) {
  constexpr int sub = 4;
  std::vector<float> pixels(std::size_t{3} * view.size * view.size);
  for (std::uint32_t row = 0; row < view.size; ++row) {
    for (std::uint32_t column = 0; column < view.size; ++column) {
      double sum = 0;
      for (int j = 0; j < sub; ++j) {
        for (int i = 0; i < sub; ++i) {
          const double x = (column + (i + .5) / sub - view.shift_x) / view.size, y = (row + (j + .5) / sub - view.shift_y) / view.size;
          sum += albedo(x, y) * lamp.at(x, y);
        }
      }
      for (std::size_t c = 0; c < 3; ++c) {
        pixels[3 * (std::size_t{row} * view.size + column) + c] = static_cast<float>(sum / (sub * sub) * lamp.colour[c]);
      }
    }
  }
  return pixels;
}

// The picture of several lamps with a layer for each.
inline Picture draw(const std::vector<Lamp>& lamps, const View& view) {
  Picture picture;
  picture.width = picture.height = view.size;
  std::vector<float> sum(std::size_t{3} * view.size * view.size);
  for (const Lamp& lamp : lamps) {
    std::vector<float> pixels = draw(lamp, view);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += pixels[i];
    picture.add("light." + lamp.name, 3).pixels = std::move(pixels);
  }
  picture.add("", 3).pixels = std::move(sum);
  return picture;
}

// Noise of one seed's pixel as a factor of mean 1.
using Noise = std::function<double(std::mt19937_64&)>;

inline Noise gaussian(double relative) {
  return [relative](std::mt19937_64& random) { return std::normal_distribution<double>(1, relative)(random); };
}
// Standard deviation 1/sqrt(shape), skewness 2/sqrt(shape).
inline Noise gamma_noise(double shape) {
  return [shape](std::mt19937_64& random) { return std::gamma_distribution<double>(shape, 1 / shape)(random); };
}
// Gaussian, and with probability p an outlier that adds `size`; the mean stays 1.
inline Noise fireflies(double relative, double p, double size) {
  return [=](std::mt19937_64& random) {
    const double base = std::normal_distribution<double>(1 - p * size, relative)(random);
    return std::uniform_real_distribution<double>(0, 1)(random) < p ? base + size : base;
  };
}

// K noisy runs of `truth`; every layer has noise of its own, the channels of a pixel share it, and the picture is the sum of its lights
// where it has some.
inline std::vector<Picture> runs_of(const Picture& truth, int seeds, const Noise& noise, std::mt19937_64& random) {
  std::vector<Picture> runs;
  for (int k = 0; k < seeds; ++k) {
    Picture run;
    run.width = truth.width;
    run.height = truth.height;
    const bool has_lights = truth.layers.size() > 1;
    std::vector<float> sum(truth.find("")->pixels.size());
    for (const Layer& layer : truth.layers) {
      if (layer.name.empty() && has_lights) continue;
      std::vector<float> pixels = layer.pixels;
      for (std::size_t p = 0; p < pixels.size(); p += 3) {
        const auto factor = static_cast<float>(noise(random));
        for (std::size_t c = p; c < p + 3; ++c) {
          pixels[c] *= factor;
          sum[c] += pixels[c];
        }
      }
      if (!layer.name.empty()) run.add(layer.name, 3).pixels = std::move(pixels);
    }
    run.add("", 3).pixels = std::move(sum);
    runs.push_back(std::move(run));
  }
  return runs;
}

inline bool has_finding(const Comparison& comparison, const std::string& code, const std::string& text = "") {
  return std::any_of(comparison.findings.begin(), comparison.findings.end(),
                     [&](const Finding& f) { return f.code == code && f.text.find(text) != std::string::npos; });
}

// "CODE(size) CODE(size)", for messages.
inline std::string findings_text(const Comparison& comparison) {
  std::string text = name_of(comparison.verdict);
  for (const Finding& finding : comparison.findings) text += "; " + finding.code + ": " + finding.text;
  return text;
}

inline std::vector<Lamp> rig() {
  return {{"key", .35, .4, .55, 6, 10, 0, {1, .9, .75}}, {"fill", .8, .3, .7, 3, -15, 0, {.8, .9, 1}},
          {"spot", .6, .7, .6, 5, 5, 35, {1, 1, 1}},     {"rim", .15, .85, .4, 1.5, 20, 0, {1, .8, .6}},
          {"lamp", .5, .15, .3, .8, 0, 0, {1, .95, .9}}, {"tiny", .7, .5, .35, .16, 0, 0, {1, 1, 1}}};
}

}  // namespace etendue::synthetic
