#include "etendue/units.h"

#include "edit_distance.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

namespace etendue {
namespace {

struct DimensionNames {
  std::string_view name, si_unit;
};
// In the order of the enumeration.
constexpr std::array<DimensionNames, 18> dimension_names{{{"luminous flux", "lm"},
                                                          {"luminous intensity", "cd"},
                                                          {"luminance", "cd/m2"},
                                                          {"illuminance", "lx"},
                                                          {"luminous exitance", "lm/m2"},
                                                          {"radiant flux", "W"},
                                                          {"radiant intensity", "W/sr"},
                                                          {"radiance", "W/m2/sr"},
                                                          {"irradiance", "W/m2"},
                                                          {"luminous efficacy", "lm/W"},
                                                          {"length", "m"},
                                                          {"angle", "rad"},
                                                          {"solid angle", "sr"},
                                                          {"temperature", "K"},
                                                          {"duration", "s"},
                                                          {"exposure value at ISO 100", "EV"},
                                                          {"exposure value without ISO", "EV_S"},
                                                          {"difference of exposure values", "stop"}}};

// A spelling of a unit. SI value = x * times / over: two factors, so that decimal submultiples are divisions and round once.
struct Spelling {
  std::string_view symbol;
  std::string_view full_name;  // never accepted, only recognised to suggest the symbol
  Dimension dimension;
  double times, over;
  std::string_view prefixes;  // SI prefixes that it takes, one letter each
  bool reciprocal = false;    // SI value = times / x (mired)
};
constexpr double foot = 0.3048;  // m, exact by definition
constexpr std::array<Spelling, 26> spellings{{
    {"lm", "lumen", Dimension::luminous_flux, 1, 1, "mkM"},
    {"cd", "candela", Dimension::luminous_intensity, 1, 1, "mkM"},
    {"cd/m2", "candela/m2", Dimension::luminance, 1, 1, "mkMG"},
    {"nit", "nits", Dimension::luminance, 1, 1, "mkMG"},
    {"fL", "foot-lambert", Dimension::luminance, 1, pi* foot* foot, ""},
    {"lx", "lumen/m2", Dimension::illuminance, 1, 1, "mkM"},
    {"lux", "luxes", Dimension::illuminance, 1, 1, "mkM"},
    {"fc", "foot-candle", Dimension::illuminance, 1, foot* foot, ""},
    {"lm/m2", "lumen/m2", Dimension::luminous_exitance, 1, 1, "k"},
    {"W", "watt", Dimension::radiant_flux, 1, 1, "umkM"},
    {"W/sr", "watt/sr", Dimension::radiant_intensity, 1, 1, "umkM"},
    {"W/m2/sr", "watt/m2/sr", Dimension::radiance, 1, 1, "umkM"},
    {"W/m2", "watt/m2", Dimension::irradiance, 1, 1, "umkM"},
    {"lm/W", "lumen/watt", Dimension::efficacy, 1, 1, ""},
    {"m", "metre", Dimension::length, 1, 1, "umck"},
    {"in", "inch", Dimension::length, 0.0254, 1, ""},
    {"ft", "foot", Dimension::length, foot, 1, ""},
    {"deg", "degree", Dimension::angle, pi, 180, ""},
    {"rad", "radian", Dimension::angle, 1, 1, "um"},
    {"sr", "steradian", Dimension::solid_angle, 1, 1, "um"},
    {"K", "kelvin", Dimension::temperature, 1, 1, ""},
    {"mired", "mireds", Dimension::temperature, 1e6, 1, "", true},
    {"s", "second", Dimension::duration, 1, 1, "um"},
    {"EV", "EV100", Dimension::exposure_value, 1, 1, ""},
    {"EV_S", "EVS", Dimension::exposure_value_s, 1, 1, ""},
    {"stop", "stops", Dimension::stop, 1, 1, ""},
}};

struct Factor {
  double times, over;
};
constexpr Factor factor_of_prefix(char prefix) {
  switch (prefix) {
    case 'u':
      return {1, 1e6};
    case 'm':
      return {1, 1e3};
    case 'c':
      return {1, 1e2};
    case 'k':
      return {1e3, 1};
    case 'M':
      return {1e6, 1};
    case 'G':
      return {1e9, 1};
    default:
      return {1, 1};
  }
}

struct ParsedUnit {
  const Spelling* spelling;
  Factor prefix;
};
std::optional<ParsedUnit> find_unit(std::string_view text) {
  for (const Spelling& s : spellings) {
    if (s.symbol == text) return ParsedUnit{&s, {1, 1}};
    if (text.size() > 1 && s.symbol == text.substr(1) && s.prefixes.find(text[0]) != std::string_view::npos)
      return ParsedUnit{&s, factor_of_prefix(text[0])};
  }
  return std::nullopt;
}

std::vector<Candidate> unit_candidates() {
  std::vector<Candidate> all;
  for (const Spelling& s : spellings) {
    const std::string symbol(s.symbol);
    all.push_back({symbol, symbol});
    all.push_back({std::string(s.full_name), symbol});
    for (const char prefix : s.prefixes) all.push_back({prefix + symbol, prefix + symbol});
  }
  return all;
}

Error number_invalid(std::string_view text, const char* why) {
  return {
      "NUMBER_INVALID", fmt::format("expected a decimal number and a unit such as \"1500 lm\", found \"{}\": {}", text, why), {}, {}, {}};
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }
std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace

std::string_view name_of(Dimension dimension) { return dimension_names[static_cast<std::size_t>(dimension)].name; }
std::string_view si_unit_of(Dimension dimension) { return dimension_names[static_cast<std::size_t>(dimension)].si_unit; }

Result<AnyQuantity> parse_quantity(std::string_view text) {
  const std::string_view body = trimmed(text);
  std::string_view digits = body;
  if (!digits.empty() && (digits.front() == '+' || digits.front() == '-')) digits.remove_prefix(1);
  // Keeps out "inf", "nan" and a second sign, which from_chars would take.
  if (digits.empty() || !(is_digit(digits.front()) || digits.front() == '.'))
    return number_invalid(text, "it does not start with a number");

  double number = 0;
  const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (status == std::errc::result_out_of_range) return number_invalid(text, "the number is beyond the range of a double");
  if (status != std::errc()) return number_invalid(text, "it does not start with a number");
  if (body.front() == '-') number = -number;

  const std::string_view rest(end, static_cast<std::size_t>(digits.data() + digits.size() - end));
  const std::string_view unit = trimmed(rest);
  if (unit.empty())
    return Error{
        "UNIT_MISSING", fmt::format("expected a unit after the number, found \"{}\"", text), {}, "write for example \"1500 lm\"", {}};
  if (is_digit(unit.front()) || std::string_view(".,'_+-").find(unit.front()) != std::string_view::npos)
    return number_invalid(text, "the decimal mark is a point, and digits are not grouped");

  const auto found = find_unit(unit);
  if (!found)
    return Error{"UNIT_UNKNOWN",
                 fmt::format("\"{}\" is no unit", unit),
                 {},
                 fmt::format("nearest: {}", fmt::join(nearest_candidates(unit, unit_candidates(), 3), ", ")),
                 {}};
  const Spelling& s = *found->spelling;
  const double si = s.reciprocal ? s.times / number : number * (s.times * found->prefix.times) / (s.over * found->prefix.over);
  if (!std::isfinite(si)) return number_invalid(text, "the value in SI units is not finite");
  return AnyQuantity{s.dimension, si};
}

Result<double> parse_si(std::string_view text, Dimension expected) {
  const Result<AnyQuantity> quantity = parse_quantity(text);
  if (!quantity) return quantity.error();
  if (quantity->dimension != expected)
    return Error{"DIMENSION_MISMATCH",
                 fmt::format("expected a {} (in {}), found a {}: \"{}\"", name_of(expected), si_unit_of(expected),
                             name_of(quantity->dimension), text),
                 {},
                 {},
                 {}};
  return quantity->si;
}

// fmt writes the shortest digits that read back as the same double, whatever the locale.
std::string to_string(const AnyQuantity& quantity) { return fmt::format("{} {}", quantity.si, si_unit_of(quantity.dimension)); }

namespace {
constexpr double meter_k = 12.5;         // cd s/m2, reflected-light meter constant (ISO 2720; Frostbite 3.0, eq 12)
constexpr double saturation_lens = 1.2;  // 78 / (100 q), q = .65 (ISO 12232; Frostbite 3.0, eq 71)
double in_exponent_range(double ev) { return std::clamp(ev, -1000.0, 1000.0); }
}  // namespace

// L = 2^EV K / S at S = 100.
double luminance_of_ev100(double ev100) { return std::exp2(in_exponent_range(ev100)) * meter_k / 100; }
double ev100_of_luminance(double luminance_cd_m2) {
  return std::log2(std::max(luminance_cd_m2, std::numeric_limits<double>::min())) - std::log2(meter_k / 100);
}
// Saturation is at H = 78/S = q L t / N^2, hence 1 / L_max = 1 / (1.2 2^EV).
double exposure_of_ev100(double ev100) { return std::exp2(-in_exponent_range(ev100)) / saturation_lens; }

}  // namespace etendue
