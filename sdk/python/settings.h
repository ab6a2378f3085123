// A camera's settings as a tuple of numbers.
#pragma once

#include "etendue/camera.h"

#include <optional>
#include <tuple>

namespace etendue::python {

// f_number, t_stop, shutter_s, shutter_angle_rad, frames_per_s, iso, nd_density, compensation_stop.
using Settings = std::tuple<std::optional<double>, std::optional<double>, std::optional<double>, std::optional<double>,
                            std::optional<double>, std::optional<double>, double, double>;
inline CameraSettings settings_of(const Settings& s) {
  const auto& [f_number, t_stop, shutter_s, shutter_angle_rad, frames_per_s, iso, nd_density, compensation_stop] = s;
  return {f_number, t_stop, shutter_s, shutter_angle_rad, frames_per_s, iso, nd_density, compensation_stop};
}
inline Settings settings_numbers(const CameraSettings& c) {
  return {c.f_number, c.t_stop, c.shutter_s, c.shutter_angle_rad, c.frames_per_s, c.iso, c.nd_density, c.compensation_stop};
}

}  // namespace etendue::python
