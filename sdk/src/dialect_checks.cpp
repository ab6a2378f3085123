// Lights that were written in the wrong unit, and what one number means in ten programs.
#include "etendue/dialect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace etendue {

// Were the numbers as the format asks, a point or spot of I cd would be a lamp of 4 pi I / 683 W in Blender, a sun of E lx one of E / 683
// W/m2. Lamps there are of 10 W to some kW, suns about 1 W/m2; without the factor they seem to be of milliwatts.
std::optional<Diagnostic> suspected_compat_lights(std::string_view generator, std::span<const Light> lights) {
  constexpr double least_lamp_W = 20, least_sun_W_m2 = 0.1, lm_W = 683;
  if (generator.find("Blender") == std::string_view::npos) return {};
  const Light* brightest = nullptr;
  double most = 0;  // as a share of the least that is believed
  for (const Light& light : lights) {
    const bool sun = std::holds_alternative<DistantShape>(light.shape);
    if (!sun && !std::holds_alternative<PointShape>(light.shape) && !std::holds_alternative<SpotShape>(light.shape)) continue;
    if (!(light.emission.value > 0) || light.emission.radiant) continue;
    const double believed = sun ? light.emission.value / lm_W / least_sun_W_m2 : 4 * pi * light.emission.value / lm_W / least_lamp_W;
    if (believed > most) {
      most = believed;
      brightest = &light;
    }
  }
  if (brightest == nullptr || most >= 1) return {};
  Diagnostic warning;
  warning.severity = Severity::warning;
  warning.code = "LIGHTS_LOOK_UNITLESS";
  warning.text = fmt::format(
      "expected lights in candela and lux, found {} as the brightest, which would be {:.3g} {} in Blender: its exporter's unitless mode "
      "leaves out the factor of 683 lm/W",
      brightest->emission.value, most * (std::holds_alternative<DistantShape>(brightest->shape) ? least_sun_W_m2 : least_lamp_W),
      std::holds_alternative<DistantShape>(brightest->shape) ? "W/m2" : "W");
  warning.where.pointer = brightest->source;
  warning.hint = "export with Lighting Mode: Standard, or multiply all lights by 683";
  return warning;
}

Result<std::vector<SpreadRow>> interoperability_spread(double flux_lm, const SpotShape& spot) {
  struct Asked {
    const char* program;
    const char* unit;
    const char* divides_by;
    Dialect dialect;
    bool reflector;
  };
  static constexpr Asked asked[] = {
      {"Blender, its glTF exporter", "W", "683 lm/W, then 4 pi", Dialect::blender, false},
      {"Unity HDRP, reflector off", "lm", "4 pi", Dialect::hdrp, false},
      {"Frostbite", "lm", "pi", Dialect::frostbite, false},
      {"Filament, SPOT", "lm", "pi", Dialect::filament, false},
      {"Godot", "lm", "pi", Dialect::godot, false},
      {"three.js, power", "lm", "pi", Dialect::threejs, false},
      {"Filament, FOCUSED_SPOT", "lm", "the outer cone", Dialect::filament, true},
      {"Unity HDRP, reflector on", "lm", "the outer cone", Dialect::hdrp, true},
      {"Unreal Engine", "lm", "the outer cone", Dialect::unreal, false},
      {"pbrt, power", "lm", "its smoothstep from 5 degrees inside the cone", Dialect::pbrt, false},
  };
  std::vector<SpreadRow> rows;
  for (const Asked& a : asked) {
    StatedLight stated;
    stated.shape = spot;
    // pbrt has no inner cone but conedeltaangle, 5 degrees unless it is given.
    if (a.dialect == Dialect::pbrt) stated.shape = SpotShape{std::max(0.0, spot.outer_rad - 5 * pi / 180), spot.outer_rad};
    stated.form.unit = a.unit;
    stated.form.reflector = a.reflector;
    stated.amount = flux_lm;
    if (a.dialect == Dialect::blender) {
      stated.amount = flux_lm / 683;
      stated.form.efficacy_lm_W = 683;
    }
    const Result<FromDialect> read = from_dialect(a.dialect, stated);
    if (!read) return read.error();
    rows.push_back({a.program, fmt::format("{:.4g} {}", stated.amount, a.unit), a.divides_by, resolve(read->light)->rgb.y});
  }
  Light ours;
  ours.shape = spot;
  ours.emission.given = Emission::Given::flux;
  ours.emission.value = flux_lm;
  const Result<Resolved> resolved = resolve(ours);
  if (!resolved) return resolved.error();
  rows.push_back({"Etendue", fmt::format("{:.4g} lm", flux_lm), "the falloff that is rendered", resolved->rgb.y});
  return rows;
}

}  // namespace etendue
