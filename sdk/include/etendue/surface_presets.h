// Reflectances at normal incidence of common materials, each with where it comes from.
#pragma once

#include "etendue/result.h"
#include "etendue/vec.h"

#include <span>
#include <string_view>

namespace etendue {

struct F0Preset {
  std::string_view name;
  Rgb f0;            // linear Rec.709
  bool metal;        // it is its whole colour; a dielectric has an albedo besides
  double ior;        // of a dielectric, at 589 nm; 0 for metals
  bool reflectance;  // whether .16 reflectance^2 reaches it
  std::string_view source;
};
// Dielectrics by their index of refraction, f0 = ((n - 1) / (n + 1))^2; then metals.
std::span<const F0Preset> f0_presets();
// PRESET_UNKNOWN, with the nearest names.
Result<F0Preset> f0_preset(std::string_view name);

}  // namespace etendue
