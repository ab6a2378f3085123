// Temperatures and efficacies of named light sources, each with where it comes from. Ranges, as the sources give them: which value of it
// holds is for whoever knows the lamp.
#pragma once

#include "etendue/result.h"

#include <span>
#include <string_view>

namespace etendue {

struct TemperaturePreset {
  std::string_view name;
  double low_K, high_K;
  std::string_view source;
};
// Frostbite's table 4.
std::span<const TemperaturePreset> temperature_presets();
// PRESET_UNKNOWN, with the nearest names.
Result<TemperaturePreset> temperature_preset(std::string_view name);

// lm per watt of what: of the radiation within 380 nm to 780 nm, or of the electrical power that a lamp takes up, losses included. They are
// not interchangeable: a bulb has 156 of the former and 14 of the latter.
enum class WattsOf { visible_radiation, electricity };
struct EfficacyPreset {
  std::string_view name;
  WattsOf watts;
  double low_lm_W, high_lm_W;
  std::string_view source;
};
std::span<const EfficacyPreset> efficacy_presets();
// PRESET_UNKNOWN.
Result<EfficacyPreset> efficacy_preset(std::string_view name);

}  // namespace etendue
