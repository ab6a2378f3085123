#include "etendue/false_colour.h"

#include "parameter_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue {
namespace {

// Luminances .007 .068 .148 .244 .335 .454 .576 .674 .900.
constexpr std::array<Rgb, 9> anchors{{{0, 0, 0.1},
                                      {0.1, 0.02, 0.45},
                                      {0.02, 0.12, 0.8},
                                      {0, 0.28, 0.6},
                                      {0.02, 0.45, 0.12},
                                      {0.28, 0.55, 0.02},
                                      {0.85, 0.55, 0.02},
                                      {1, 0.6, 0.45},
                                      {1, 0.9, 0.6}}};

}  // namespace

Rgb false_colour(double position) {
  const double at = std::clamp(position, 0.0, 1.0) * (anchors.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(at), anchors.size() - 2);
  const double t = at - static_cast<double>(i);
  return anchors[i] * (1 - t) + anchors[i + 1] * t;
}

Result<FalseColourCounts> false_colour(std::span<const float> values, const FalseColourScale& scale, std::span<Vec3f> colours) {
  if (values.size() != colours.size())
    return parameter_error("colours", "BATCH_SIZES_DIFFER",
                           fmt::format("expected as many colours as values, found {} and {}", colours.size(), values.size()));
  if (!(scale.least < scale.greatest) || !std::isfinite(scale.least) || !std::isfinite(scale.greatest) ||
      (scale.logarithmic && !(scale.least > 0)) || scale.bands < 0 || scale.bands > 4096)
    return parameter_error(
        "scale", "SCALE_INVALID",
        fmt::format("expected least < greatest, finite, above 0 on a logarithmic scale, and 0 to 4096 bands, found {}, {} and {}",
                    scale.least, scale.greatest, scale.bands));
  const auto measure = [&](double x) { return scale.logarithmic ? std::log2(x) : x; };
  const double first = measure(scale.least), width = measure(scale.greatest) - first;
  FalseColourCounts counts;
  const auto colour_of = [&](double x) {
    if (std::isnan(x)) return ++counts.nan, false_colour_of_nan;
    if (x < scale.least) return ++counts.below, false_colour_below;
    if (x > scale.greatest) return ++counts.above, false_colour_above;
    double position = (measure(x) - first) / width;
    if (scale.bands > 0) position = (std::min(std::floor(position * scale.bands), scale.bands - 1.0) + 0.5) / scale.bands;
    return false_colour(position);
  };
  for (std::size_t i = 0; i < values.size(); ++i) colours[i] = vec_cast<float>(colour_of(values[i]));
  return counts;
}

}  // namespace etendue
