#include "etendue/light_presets.h"

#include "named_preset.h"
#include "number_text.h"

#include "etendue/spectrum.h"
#include "etendue/units.h"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace etendue {
namespace {

constexpr std::string_view table_4 = "Lagarde and de Rousiers 2014, table 4";
constexpr TemperaturePreset temperatures[] = {
    {"match flame", 1700, 1800, table_4},
    {"candle flame", 1850, 1930, table_4},
    {"sun at sunrise or sunset", 2000, 3000, table_4},
    {"household tungsten bulb", 2500, 2900, table_4},
    {"tungsten lamp 500 W to 1 kW", 3000, 3000, table_4},
    {"quartz light", 3200, 3500, table_4},
    {"fluorescent light", 3200, 7500, table_4},
    {"tungsten lamp 2 kW", 3275, 3275, table_4},
    {"tungsten lamp 5 kW, 10 kW", 3380, 3380, table_4},
    {"direct sun at noon", 5000, 5400, table_4},
    {"daylight, sun and sky", 5500, 6500, table_4},
    {"sun through clouds or haze", 5500, 6500, table_4},
    {"overcast sky", 6000, 7500, table_4},
    {"RGB monitor", 6500, 6500, table_4},
    {"outdoor shade", 7000, 8000, table_4},
    {"partly cloudy sky", 8000, 10000, table_4},
};

// Of radiation: 1 nm sums over 380 nm to 780 nm of the CIE's tables as colour-science 0.4.6 has them. Of electricity: table 6 gives
// percents of 683.
constexpr std::string_view cie = "CIE 015:2018's illuminants, 380 nm to 780 nm";
constexpr std::string_view table_6 = "Lagarde and de Rousiers 2014, table 6, percents of 683 lm/W";
constexpr double percent = k_cd_lm_W / 100;
constexpr EfficacyPreset efficacies[] = {
    {"CIE A", WattsOf::visible_radiation, 155.8, 155.8, cie},
    {"CIE C", WattsOf::visible_radiation, 202.4, 202.4, cie},
    {"CIE D50", WattsOf::visible_radiation, 207.4, 207.4, cie},
    {"CIE D55", WattsOf::visible_radiation, 207.6, 207.6, cie},
    {"CIE D65", WattsOf::visible_radiation, 204.8, 204.8, cie},
    {"CIE D75", WattsOf::visible_radiation, 200.7, 200.7, cie},
    {"CIE E", WattsOf::visible_radiation, 182.0, 182.0, cie},
    {"CIE FL2", WattsOf::visible_radiation, 336.7, 336.7, cie},
    {"CIE FL4", WattsOf::visible_radiation, 370.3, 370.3, cie},
    {"CIE FL11", WattsOf::visible_radiation, 336.8, 336.8, cie},
    {"CIE HP1", WattsOf::visible_radiation, 395.0, 395.0, cie},
    {"CIE LED-B1", WattsOf::visible_radiation, 311.8, 311.8, cie},
    {"CIE LED-B3", WattsOf::visible_radiation, 316.9, 316.9, cie},
    {"CIE LED-B5", WattsOf::visible_radiation, 305.2, 305.2, cie},
    {"CIE LED-RGB1", WattsOf::visible_radiation, 291.4, 291.4, cie},
    {"CIE LED-V1", WattsOf::visible_radiation, 235.5, 235.5, cie},
    {"K_cd", WattsOf::visible_radiation, k_cd_lm_W, k_cd_lm_W,
     "SI 2019: light of 540 THz, the most there is; Blender's glTF exporter, V-Ray"},
    {"incandescent", WattsOf::electricity, 2 * percent, 5 * percent, table_6},
    {"fluorescent", WattsOf::electricity, 9 * percent, 15 * percent, table_6},
    {"LED of 2014", WattsOf::electricity, 0.66 * percent, 8.8 * percent, table_6},
    {"Bevy incandescent", WattsOf::electricity, 13.8, 13.8, "Bevy, light_consts.rs"},
    {"Bevy halogen", WattsOf::electricity, 19.8, 19.8, "Bevy, light_consts.rs"},
    {"Bevy LED", WattsOf::electricity, 90, 90, "Bevy, light_consts.rs"},
    {"LuxCore default", WattsOf::electricity, 17, 17, "LuxCoreRender, light.efficiency"},
};

// "15 lm/W", "2856 K", "2856 K visible".
Result<EfficacyPolicy> counted_policy(std::string_view text) {
  constexpr std::string_view band = "visible";
  std::string_view number = text;
  const bool visible = number.ends_with(band);
  if (visible) number.remove_suffix(band.size());
  const Result<AnyQuantity> given = parse_quantity(number);
  if (!given) return given.error();
  if (given->dimension == Dimension::temperature) {
    const Result<double> lm_W = blackbody_efficacy(given->si, visible ? visible_band : whole_spectrum);
    if (!lm_W) return lm_W.error();
    return EfficacyPolicy{*lm_W, std::string(text),
                          fmt::format("Planckian radiator of {} K, {}", given->si, visible ? "380 nm to 780 nm" : "all of its radiation")};
  }
  if (given->dimension == Dimension::efficacy && !visible) return EfficacyPolicy{given->si, std::string(text), ""};
  return Error{"DIMENSION_MISMATCH",
               fmt::format("expected a luminous efficacy (in lm/W) or the temperature of a Planckian radiator, found \"{}\"", text),
               {},
               {},
               {}};
}

}  // namespace

std::span<const TemperaturePreset> temperature_presets() { return temperatures; }
Result<TemperaturePreset> temperature_preset(std::string_view name) {
  return named_preset(temperature_presets(), name, "source whose temperature");
}
std::span<const EfficacyPreset> efficacy_presets() { return efficacies; }
Result<EfficacyPreset> efficacy_preset(std::string_view name) { return named_preset(efficacy_presets(), name, "source whose efficacy"); }

Result<EfficacyPolicy> efficacy_policy(std::string_view text) {
  text = trimmed(text);
  if (!text.empty() && std::string_view("0123456789.+-").find(text.front()) != std::string_view::npos) {
    const Result<EfficacyPolicy> counted = counted_policy(text);
    return counted ? counted : about("efficacy", counted.error());
  }
  const Result<EfficacyPreset> preset = efficacy_preset(text);
  if (!preset) return about("efficacy", preset.error());
  if (preset->low_lm_W < preset->high_lm_W)
    return parameter_error("efficacy", "EFFICACY_AMBIGUOUS",
                           fmt::format("expected one efficacy, found {}: {:.3g} to {:.3g} lm/W", text, preset->low_lm_W, preset->high_lm_W),
                           fmt::format("write one of them; {}", preset->source));
  return EfficacyPolicy{preset->low_lm_W, std::string(text), std::string(preset->source)};
}

}  // namespace etendue
