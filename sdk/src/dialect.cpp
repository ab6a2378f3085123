#include "etendue/dialect.h"

#include "dialect_rules.h"
#include "edit_distance.h"
#include "parameter_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue {
namespace {

using Given = Emission::Given;

// In the order of the enumeration.
constexpr std::array<DialectInfo, 13> all_dialects{
    {{Dialect::blender, "blender", "Blender", "Cycles, light.cpp and kernel/light/area.h: area lights .25 / area", "the falloff of spots"},
     {Dialect::gltf_spec, "gltf_spec", "glTF", "KHR_lights_punctual: cd, cd, lx", ""},
     {Dialect::gltf_compat, "gltf_compat", "glTF by Blender in unitless mode", "glTF-Blender-IO, PR 1760: SPEC without the factor 683", ""},
     {Dialect::gltf_raw, "gltf_raw", "glTF by Blender in raw mode", "glTF-Blender-IO, PR 1760 and issue 564: Blender's number as it is",
      ""},
     {Dialect::usd, "usd", "OpenUSD", "UsdLux LightAPI and its overview; ovrtx documentation of normalize",
      "whether a renderer follows stage units (OpenUSD PR 3587) and lights the caps of cylinders"},
     {Dialect::hdrp, "hdrp", "Unity HDRP", "Unity, LightUnitUtils.cs", "the distance window"},
     {Dialect::unreal, "unreal", "Unreal Engine", "a public copy of LocalLightComponent.cpp, GetUnitsConversionFactor",
      "rectangles (I = lm / pi), and whether the newest version is the same"},
     {Dialect::filament, "filament", "Filament", "Filament, LightManager.cpp, setIntensity", ""},
     {Dialect::frostbite, "frostbite", "Frostbite", "Lagarde and de Rousiers 2014, tables 8, 9 and 12, eq 14 to 17", ""},
     {Dialect::godot, "godot", "Godot", "Godot documentation, physical light and camera units",
      "the falloff of spots and the distance window"},
     {Dialect::threejs, "threejs", "three.js", "three.js, PointLight.js, SpotLight.js, RectAreaLight.js: power", ""},
     {Dialect::pbrt, "pbrt", "pbrt-v4", "pbrt-v4, lights.cpp: power, illuminance", ""},
     {Dialect::vray, "vray", "V-Ray", "Chaos documentation, light units: lm, lm/m2/sr, W, W/m2/sr at 683 lm/W, hue of the colour alone",
      "the arithmetic: only its description is public"}}};

Error number_invalid(const char* parameter, const char* what, double value) {
  return parameter_error(parameter, "NUMBER_INVALID", fmt::format("expected {}, found {}", what, value));
}

// Watts become light by an efficacy that somebody states.
Result<double> efficacy_of(const DialectForm& form, const std::optional<double>& of_the_light = {}) {
  const std::optional<double> efficacy = form.efficacy_lm_W ? form.efficacy_lm_W : of_the_light;
  if (!efficacy)
    return parameter_error("efficacy", "EFFICACY_MISSING", "Blender's watts need an efficacy in lm/W to be light",
                           "its glTF exporter takes 683, the most that there is; white light has 200 to 400 for each watt of light");
  if (*efficacy > 0 && std::isfinite(*efficacy)) return *efficacy;
  return number_invalid("efficacy", "an efficacy above 0 lm/W and finite", *efficacy);
}

bool has_image(const Shape& shape) {
  const auto* environment = std::get_if<EnvironmentShape>(&shape);
  return environment != nullptr && environment->image.has_value();
}
Error mean_unknown() {
  return parameter_error(
      "unit", "UNIT_UNSUITABLE",
      "an environment's image is multiplied here; scaling it to a mean, an illuminance or an exposure value needs its pixels");
}

// Tubes have the caps that the program gives them.
void cap(Dialect dialect, Shape& shape) {
  if (auto* tube = std::get_if<TubeShape>(&shape)) tube->caps = dialect == Dialect::usd ? Caps::none : Caps::round;
}

}  // namespace

std::span<const DialectInfo> dialects() { return all_dialects; }

Result<DialectInfo> dialect_named(std::string_view name) {
  std::vector<Candidate> candidates;
  for (const DialectInfo& info : all_dialects) {
    if (info.name == name) return info;
    candidates.push_back({std::string(info.name), std::string(info.name)});
  }
  return parameter_error("dialect", "DIALECT_UNKNOWN", fmt::format("\"{}\" is no program whose lights are known", name),
                         fmt::format("nearest: {}", fmt::join(nearest_candidates(name, candidates, 3), ", ")));
}

Result<FromDialect> from_dialect(Dialect dialect, const StatedLight& stated) {
  StatedLight in_metres = stated;
  const Result<std::string> unit = unit_of(dialect, stated.shape, stated.form.unit);
  if (!unit) return unit.error();
  in_metres.form.unit = *unit;
  if (!std::isfinite(stated.amount) || (*unit != "EV" && stated.amount < 0))
    return number_invalid("amount", "a finite amount that is not negative", stated.amount);
  if (!std::isfinite(stated.form.exposure_stop)) return number_invalid("exposure_stop", "a finite exposure", stated.form.exposure_stop);
  const Result<double> metres = metres_per_unit(dialect, stated.shape, stated.form);
  if (!metres) return metres.error();
  in_metres.shape = scaled_shape(stated.shape, *metres);
  cap(dialect, in_metres.shape);
  const Result<double> factor = natural_per_amount(dialect, in_metres);
  if (!factor) return factor.error();

  FromDialect read;
  Light& light = read.light;
  light.shape = in_metres.shape;
  light.emission.given = natural_quantity(light.shape);
  light.emission.value = linear_amount(in_metres) * *factor;
  if (dialect == Dialect::vray)
    light.colour = RgbColour{stated.colour};
  else
    light.filter = stated.colour;
  light.two_sided = stated.two_sided;
  if (dialect == Dialect::blender) {
    const Result<double> efficacy = efficacy_of(stated.form);
    if (!efficacy) return efficacy.error();
    light.emission.radiant = true;
    light.emission.efficacy_lm_W = *efficacy;
  }
  if (has_image(light.shape)) {
    if (*unit == "lx" || *unit == "EV") return mean_unknown();
    light.filter = light.filter * (light.emission.value * light.emission.efficacy_lm_W.value_or(1));
    light.emission = {};
  }
  if (stated.range) {
    light.range_m = *stated.range * *metres;
    light.falloff = dialect == Dialect::gltf_spec || dialect == Dialect::gltf_compat || dialect == Dialect::gltf_raw ? Falloff::gltf
                                                                                                                     : Falloff::frostbite;
  }
  if (const Result<Resolved> resolved = resolve(light); !resolved) return resolved.error();
  add_differences(dialect, light, read.losses);
  return read;
}

Result<ToDialect> to_dialect(Dialect dialect, const Light& light, const DialectForm& form) {
  const Result<std::string> unit = unit_of(dialect, light.shape, form.unit);
  if (!unit) return unit.error();
  const Result<Resolved> resolved = resolve(light);
  if (!resolved) return resolved.error();
  if (has_image(light.shape) && (light.emission.given != Given::as_file || *unit == "lx" || *unit == "EV")) return mean_unknown();

  ToDialect written;
  StatedLight& stated = written.stated;
  stated.shape = light.shape;
  cap(dialect, stated.shape);
  stated.form = form;
  stated.form.unit = *unit;
  stated.two_sided = light.two_sided && dialect == Dialect::pbrt;
  const Result<double> metres = metres_per_unit(dialect, light.shape, form);
  if (!metres) return metres.error();
  const Result<double> factor = natural_per_amount(dialect, stated);
  if (!factor) return factor.error();

  Rgb rgb = resolved->rgb;
  // A disc of luminance L and half angle a lights a plane facing it with pi L sin^2(a).
  if (const auto* distant = std::get_if<DistantShape>(&light.shape); distant != nullptr && resolved->kind == Resolved::Kind::luminance)
    rgb *= pi * std::pow(std::sin(distant->diameter_rad / 2), 2);
  if (dialect == Dialect::blender) {
    const Result<double> efficacy = efficacy_of(form, light.emission.efficacy_lm_W);
    if (!efficacy) return efficacy.error();
    rgb = rgb / *efficacy;
    stated.form.efficacy_lm_W = *efficacy;
  }
  if (std::min({rgb.x, rgb.y, rgb.z}) < 0) {
    written.losses.add(fmt::format("light '{}': colour {:.6g} {:.6g} {:.6g}", light.name, rgb.x, rgb.y, rgb.z),
                       "out of Rec.709's gamut: clipped, at the same luminance");
    rgb = clipped_keeping_luminance(rgb);
  }
  if (!std::holds_alternative<RgbColour>(light.colour))
    written.losses.add(fmt::format("light '{}': colour by its temperature", light.name), "the same colour as linear Rec.709");
  const double brightest = std::max({rgb.x, rgb.y, rgb.z});
  if (brightest > 0) stated.colour = rgb / brightest;
  const double amount = dialect == Dialect::vray ? luminance_of(rgb) : brightest;
  if (*unit == "EV" && !(amount > 0)) return number_invalid("amount", "light: no exposure value says that there is none", amount);
  stated.amount = stated_amount(amount / *factor, stated.form);
  if (!std::isfinite(stated.amount)) return number_invalid("amount", "an amount that is finite", stated.amount);
  stated.shape = scaled_shape(stated.shape, 1 / *metres);
  if (light.range_m) stated.range = *light.range_m / *metres;
  add_differences(dialect, light, written.losses);
  return written;
}

}  // namespace etendue
