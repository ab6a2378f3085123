// What the verb `units` was asked for, and its parts.
#pragma once

#include <map>

#include "etendue/formulas.h"
#include "etendue/quantity_text.h"
#include "etendue/unit_names.h"
#include "session.h"

namespace etendue::cli {

struct UnitsOptions {
  std::vector<std::string> quantities;
  std::string to, shape, distance, efficacy, spot_flux, spot_falloff, meter, normalise, table, dialect, from;
  std::map<std::string, std::string> sizes;  // "radius" -> "15 cm": those that a shape takes
  std::optional<double> metres_per_unit;     // of a dialect, and the next three
  double exposure_stop = 0;
  bool normalize = false, reflector = false;
  bool two_sided = false, explain = false, list = false, jsonl = false, clamp = false;
};
// The names that `sizes` may hold, each an option: "--radius".
std::span<const std::string_view> size_names();

// What the options say about the light. Errors: SHAPE_UNKNOWN, SIZE_MISSING, ANGLE_MISSING, OPTION_UNUSED (a size that the shape does not
// have), and those of parse_si() and efficacy_policy().
Result<LightSetup> setup_of(const UnitsOptions& options);

// What --to asks for: a unit, or a colour.
struct Target {
  enum class Kind { unit, rgb, xy, cct } kind = Kind::unit;
  std::string name;
  NamedUnit unit{};
};
// UNIT_UNKNOWN, with the nearest.
Result<Target> target_named(const std::string& name);

struct Answer {
  std::vector<double> value;  // three for rgb, two for xy
  std::string unit, text;
  std::optional<bool> in_gamut;            // rgb
  std::optional<double> duv;               // cct
  std::optional<double> efficacy_lm_W;     // that the value depends on
  std::string efficacy;                    // which that is, as it was asked for: "CIE D65"
  std::optional<Explanation> explanation;  // with `explain`
};
// A quantity, a camera or a colour; with --clamp a temperature out of range is told in `told` and not refused.
Result<Written> read_quantity(std::string_view text, const UnitsOptions& options, Diagnostics& told);

Result<Answer> answer(const Written& given, const Target& target, const LightSetup& setup, const UnitsOptions& options);
// In every unit that can be known from what was given.
std::vector<Answer> every_answer(const Written& given, const LightSetup& setup, const UnitsOptions& options);

// Prints one quantity in the unit of --to, or in all that can be known, and adds to results.
Status say(Session& session, const std::string& text, const Written& written, const std::optional<Target>& target, const LightSetup& setup,
           const UnitsOptions& options, Json& results);

// --dialect: what another program calls the light, in --to or in its usual unit; --from: what its number is in ours. Adds to results.
Status state_in_dialect(Session& session, const std::string& text, const std::optional<Target>& target, const LightSetup& setup,
                        const UnitsOptions& options, Json& results);

// --list and --table NAME, as lines and as JSON.
void list_units(Session& session);
Status print_table(Session& session, const std::string& name);

}  // namespace etendue::cli
