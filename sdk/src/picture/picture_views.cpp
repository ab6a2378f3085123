#include "etendue/picture_views.h"

#include "etendue/batch.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace etendue {
namespace {

bool of_illuminance(Measure measure) { return measure == Measure::illuminance || measure == Measure::ev100_of_illuminance; }

Error missing(const Picture& picture, std::string_view layer) {
  std::string names;
  for (const Layer& known : picture.layers) names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", known.name);
  return {"LAYER_MISSING", fmt::format("expected a layer \"{}\", found {}", layer, names.empty() ? "none" : names), {}, {}, {}};
}

}  // namespace

Result<std::vector<float>> measured(const Picture& picture, std::string_view layer, Measure measure, const Calibration& calibration) {
  const Layer* found = picture.find(layer);
  if (found == nullptr) return missing(picture, layer);
  const auto white = picture.numbers.find("whiteLuminance");
  const double scale = !of_illuminance(measure) && white != picture.numbers.end() ? white->second : 1;
  const auto channels = static_cast<std::size_t>(found->channels);
  std::vector<float> values(found->pixels.size() / channels);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float* p = found->pixels.data() + i * channels;
    values[i] = static_cast<float>(scale * (channels == 1 ? p[0] : luminance_of(Rgb{p[0], p[1], p[2]})));
  }
  if (measure == Measure::luminance || measure == Measure::illuminance) return values;

  // EV = log2(100 x / K), and of illuminances the same with C.
  Calibration meter = calibration;
  if (of_illuminance(measure)) meter.meter_k = calibration.meter_c;
  constexpr float infinity = std::numeric_limits<float>::infinity();
  std::vector<float> ev(values.size());
  if (const BatchOutcome done = ev100_of_luminance(values, meter, ev, -infinity); !done) return done.error();
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::isnan(values[i]) || values[i] == infinity) ev[i] = values[i];
  return ev;
}

Result<FalseColourView> false_colour_view(const Picture& picture, std::string_view layer, Measure measure, const Calibration& calibration,
                                          const FalseColourScale& scale) {
  const Result<std::vector<float>> values = measured(picture, layer, measure, calibration);
  if (!values) return values.error();
  std::vector<Vec3f> colours(values->size());
  const Result<FalseColourCounts> counts = false_colour(*values, scale, colours);
  if (!counts) return counts.error();
  FalseColourView view{{picture.width, picture.height, {}, {}, {}}, *counts};
  Layer& drawn = view.picture.add("", 3);
  for (std::size_t i = 0; i < colours.size(); ++i)
    for (int c = 0; c < 3; ++c) drawn.pixels[3 * i + static_cast<std::size_t>(c)] = colours[i][c];
  return view;
}

}  // namespace etendue
