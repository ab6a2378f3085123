// What other programs' numbers for a light mean, to and from our types, with what is lost on the way.
//   StatedLight lamp{.shape = SpotShape{0, 30 * pi / 180}, .amount = 1000, .form = {.unit = "lm"}};
//   auto read = from_dialect(Dialect::frostbite, lamp);              // read->light: 318.3 cd on the axis
//   auto written = to_dialect(Dialect::threejs, read->light, {.unit = "cd"});
// Every program here multiplies its amount by a colour, channel by channel, without normalising it (V-Ray alone takes its hue): it arrives
// as our `filter`. Rules with their sources, and which of them could not be verified: sdk/docs/dialects.md and dialects().
#pragma once

#include "etendue/io.h"
#include "etendue/light.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

enum class Dialect { blender, gltf_spec, gltf_compat, gltf_raw, usd, hdrp, unreal, filament, frostbite, godot, threejs, pbrt, vray };

struct DialectInfo {
  Dialect dialect;
  std::string_view name;     // "gltf_compat"
  std::string_view program;  // "glTF as Blender's exporter writes it in its unitless mode"
  std::string_view source;
  std::string_view unverified;  // what of it no public source was read for; "" if nothing
};
std::span<const DialectInfo> dialects();
// DIALECT_UNKNOWN, with the nearest names.
Result<DialectInfo> dialect_named(std::string_view name);

// How an amount is meant, besides its number.
struct DialectForm {
  // One of units_of(); "" is the first of these. "W" (Blender, V-Ray, glTF RAW), "W/m2", "W/m2/sr", "W/sr" (glTF COMPAT), "lm", "cd",
  // "nit", "lx", "EV", "unitless" (Unreal).
  std::string unit{};
  double exposure_stop = 0;  // USD: times 2^exposure
  bool normalize = false;    // USD: divided by the area in stage units (distant: by pi sin^2 of its radius)
  bool reflector = false;    // HDRP's reflector and Filament's FOCUSED_SPOT: lumens over the cone, not over all directions or pi
  std::optional<double> metres_per_unit{};  // USD: required for everything but distant and dome lights. Unreal has .01, all others 1
  std::optional<double> efficacy_lm_W{};    // Blender: watts say nothing about light without it
};

// A light in a program's own terms. Lengths are in its own unit.
struct StatedLight {
  Shape shape;
  double amount = 0;
  DialectForm form{};
  Rgb colour{1, 1, 1};
  bool two_sided = false;         // pbrt
  std::optional<double> range{};  // where the program's light ends
};

// The units in which a program states lights of this shape, the usual one first; empty: it has no such light. A point in USD is a
// SphereLight with treatAsPoint and normalize.
std::vector<std::string_view> units_of(Dialect dialect, const Shape& shape);

// Errors of both: DIALECT_HAS_NO_SUCH_LIGHT, UNIT_UNSUITABLE (names those that are), METRES_PER_UNIT_MISSING, EFFICACY_MISSING,
// SIZE_MISSING, NUMBER_INVALID, COLOUR_INVALID, and those of resolve(). There and back the resolved light is the same to 1e-12, relative.
struct FromDialect {
  Light light;
  LossReport losses;
};
Result<FromDialect> from_dialect(Dialect dialect, const StatedLight& stated);

// The colour is scaled so that its brightest channel is 1; channels out of gamut are clipped keeping the luminance, which is a loss.
struct ToDialect {
  StatedLight stated;
  LossReport losses;
};
Result<ToDialect> to_dialect(Dialect dialect, const Light& light, const DialectForm& form = {});

// A warning (LIGHTS_LOOK_UNITLESS) where Blender's exporter seems to have written its lights without the 683 lm/W that the format asks for:
// its name as generator, and no light that would be one of 20 W or more if they were there. Small lamps alone can look the same.
std::optional<Diagnostic> suspected_compat_lights(std::string_view generator, std::span<const Light> lights);

// "1000 lm" typed into each program's spot of this shape: candela on the axis.
struct SpreadRow {
  std::string program, stated, divides_by;
  double candela = 0;
};
Result<std::vector<SpreadRow>> interoperability_spread(double flux_lm, const SpotShape& spot);

}  // namespace etendue
