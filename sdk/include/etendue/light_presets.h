// Temperatures and efficacies of named light sources, each with where it comes from. Ranges, as the sources give them: which value of it
// holds is for whoever knows the lamp.
#pragma once

#include "etendue/result.h"

#include <span>
#include <string>
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

// How watts become lumens, as people say it: "15 lm/W"; a preset that is one number, "CIE D65"; a Planckian radiator, "2856 K" for all that
// it radiates, "2856 K visible" for what of it lies within 380 nm to 780 nm.
struct EfficacyPolicy {
  double lm_W = 0;
  std::string name;    // as it was said
  std::string source;  // "" of a plain number
};
// EFFICACY_AMBIGUOUS for a preset that is a range; PRESET_UNKNOWN; those of parse_quantity(), DIMENSION_MISMATCH; TEMPERATURE_OUT_OF_RANGE.
Result<EfficacyPolicy> efficacy_policy(std::string_view text);

}  // namespace etendue
