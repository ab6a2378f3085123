// Times that rise, rotations of unit length, and inverse bind matrices whose last row is 0 0 0 1.
#include <fmt/format.h>

#include <cmath>

#include "data_checks.h"

namespace etendue::gltf {
namespace {

// The validator's: what normalised bytes can miss the length of a quaternion by.
constexpr double unit_tolerance = 0.00769;

void check_times(DataChecks& checks, std::int64_t accessor, const std::string& pointer) {
  if (!checks.is_new("times", accessor)) return;
  const auto elements = checks.elements(accessor);
  if (!elements || elements->format != Format{Shape::scalar, 5126}) return;
  double previous = -1;
  for (std::size_t i = 0; i < elements->count; ++i) {
    const double time = value_at<float>(*elements, i, 0);
    if (time < 0)
      return checks.asset.error("ACCESSOR_ANIMATION_INPUT_NEGATIVE", fmt::format("time number {} is negative: {}", i, time), pointer);
    if (time <= previous)
      return checks.asset.error("ACCESSOR_ANIMATION_INPUT_NON_INCREASING",
                                fmt::format("time number {} is not after the one before: {} after {}", i, time, previous), pointer);
    previous = time;
  }
}

void check_rotations(DataChecks& checks, std::int64_t accessor, bool is_cubic, const std::string& pointer) {
  if (!checks.is_new("rotations", accessor, is_cubic ? 1 : 0)) return;
  const auto elements = checks.elements(accessor);
  if (!elements || elements->format.shape != Shape::vec4) return;
  with_type(elements->format.component, [&](auto type) {
    // Of a spline, every second of three is a rotation, between its tangents.
    for (std::size_t i = is_cubic ? 1 : 0; i < elements->count; i += is_cubic ? 3 : 1) {
      double squares = 0;
      for (std::size_t c = 0; c < 4; ++c) squares += std::pow(value_at<decltype(type)>(*elements, i, c), 2);
      if (std::abs(std::sqrt(squares) - 1) <= unit_tolerance) continue;
      return checks.asset.error("ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION",
                                fmt::format("rotation number {} is of length {}", i, std::sqrt(squares)), pointer);
    }
  });
}

void check_inverse_binds(DataChecks& checks, std::int64_t accessor, const std::string& pointer) {
  if (!checks.is_new("inverse binds", accessor)) return;
  const auto elements = checks.elements(accessor);
  if (!elements || elements->format != Format{Shape::mat4, 5126}) return;
  constexpr std::size_t last_row[] = {3, 7, 11, 15};
  for (std::size_t i = 0; i < elements->count; ++i)
    for (const std::size_t component : last_row)
      if (const double value = value_at<float>(*elements, i, component); value != (component == 15 ? 1 : 0))
        return checks.asset.error("ACCESSOR_INVALID_IBM", fmt::format("matrix number {} has a last row other than 0 0 0 1: {}", i, value),
                                  pointer);
}

}  // namespace

void check_motion(DataChecks& checks) {
  const Json &animations = array_at(checks.asset.json(), "animations"), &skins = array_at(checks.asset.json(), "skins");
  for (std::size_t a = 0; a < animations.size(); ++a) {
    const Json &samplers = array_at(animations[a], "samplers"), &channels = array_at(animations[a], "channels");
    for (std::size_t s = 0; s < samplers.size(); ++s)
      check_times(checks, index_of(samplers[s], "input"), fmt::format("/animations/{}/samplers/{}/input", a, s));
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const std::string* path = text_of(object_at(channels[c], "target"), "path");
      const std::int64_t sampler = index_of(channels[c], "sampler");
      if (path == nullptr || *path != "rotation" || sampler < 0 || static_cast<std::size_t>(sampler) >= samplers.size()) continue;
      const Json& source = samplers[static_cast<std::size_t>(sampler)];
      const std::string* interpolation = text_of(source, "interpolation");
      check_rotations(checks, index_of(source, "output"), interpolation != nullptr && *interpolation == "CUBICSPLINE",
                      fmt::format("/animations/{}/channels/{}/sampler", a, c));
    }
  }
  for (std::size_t s = 0; s < skins.size(); ++s)
    check_inverse_binds(checks, index_of(skins[s], "inverseBindMatrices"), fmt::format("/skins/{}/inverseBindMatrices", s));
}

}  // namespace etendue::gltf
