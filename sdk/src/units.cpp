#include "etendue/unit_names.h"

#include "article.h"
#include "number_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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

Error number_invalid(std::string_view text, const char* why) {
  return {
      "NUMBER_INVALID", fmt::format("expected a decimal number and a unit such as \"1500 lm\", found \"{}\": {}", text, why), {}, {}, {}};
}

}  // namespace

std::string_view name_of(Dimension dimension) { return dimension_names[static_cast<std::size_t>(dimension)].name; }
std::string_view si_unit_of(Dimension dimension) { return dimension_names[static_cast<std::size_t>(dimension)].si_unit; }

Result<AnyQuantity> parse_quantity(std::string_view text) {
  std::string_view rest = trimmed(text);
  double number = 0;
  if (const char* const why = take_number(rest, number)) return number_invalid(text, why);
  const std::string_view unit = trimmed(rest);
  if (unit.empty())
    return Error{
        "UNIT_MISSING", fmt::format("expected a unit after the number, found \"{}\"", text), {}, "write for example \"1500 lm\"", {}};
  if ((unit.front() >= '0' && unit.front() <= '9') || unit.front() == '+' || unit.front() == '-')
    return number_invalid(text, "digits are not grouped, and a sign stands in front");
  const NamedUnit* const found = find_unit(unit);
  if (found == nullptr) return unit_named(unit).error();
  const double si = found->to_si(number);
  if (!std::isfinite(si)) return number_invalid(text, "the value in SI units is not finite");
  return AnyQuantity{found->dimension, si};
}

Result<double> parse_si(std::string_view text, Dimension expected) {
  const Result<AnyQuantity> quantity = parse_quantity(text);
  if (!quantity) return quantity.error();
  if (quantity->dimension != expected)
    return Error{"DIMENSION_MISMATCH",
                 fmt::format("expected {} (in {}), found {}: \"{}\"", with_article(name_of(expected)), si_unit_of(expected),
                             with_article(name_of(quantity->dimension)), text),
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
