// Quantities with their unit: strong types in SI, and the text form "1200 lm".
//   Flux f = lumens(800);  double cd = candelas.of(i);  auto q = parse_quantity("1.5 klx");
#pragma once

#include "etendue/result.h"

#include <string>
#include <string_view>

namespace etendue {

// What a number measures. Values are kept in the SI unit named here.
enum class Dimension {
  luminous_flux,       // lm
  luminous_intensity,  // cd
  luminance,           // cd/m2
  illuminance,         // lx
  luminous_exitance,   // lm/m2
  radiant_flux,        // W
  radiant_intensity,   // W/sr
  radiance,            // W/m2/sr
  irradiance,          // W/m2
  efficacy,            // lm/W
  length,              // m
  angle,               // rad
  solid_angle,         // sr
  temperature,         // K
  duration,            // s
  exposure_value,      // EV at ISO 100
  exposure_value_s,    // log2(N^2/t), no ISO
  stop,                // a difference of EV
};
std::string_view name_of(Dimension dimension);     // "luminous flux"
std::string_view si_unit_of(Dimension dimension);  // "lm"

template <Dimension D>
struct Quantity {
  double si = 0;                                                                  // in the SI unit of D
  friend constexpr auto operator<=>(const Quantity&, const Quantity&) = default;  // NOLINT(modernize-use-nullptr): clang-tidy 14 is wrong
};
using Flux = Quantity<Dimension::luminous_flux>;
using Intensity = Quantity<Dimension::luminous_intensity>;
using Luminance = Quantity<Dimension::luminance>;
using Illuminance = Quantity<Dimension::illuminance>;
using Efficacy = Quantity<Dimension::efficacy>;
using Length = Quantity<Dimension::length>;
using Angle = Quantity<Dimension::angle>;
using Temperature = Quantity<Dimension::temperature>;
using Duration = Quantity<Dimension::duration>;

// A unit makes a quantity from a number and reads a number back: lumens(800), lumens.of(flux).
template <Dimension D>
struct Unit {
  double in_si;
  constexpr Quantity<D> operator()(double x) const { return {x * in_si}; }
  constexpr double of(Quantity<D> q) const { return q.si / in_si; }
};
inline constexpr double pi = 3.14159265358979323846;
inline constexpr Unit<Dimension::luminous_flux> lumens{1};
inline constexpr Unit<Dimension::luminous_intensity> candelas{1};
inline constexpr Unit<Dimension::luminance> nits{1};
inline constexpr Unit<Dimension::illuminance> lux{1};
inline constexpr Unit<Dimension::efficacy> lumens_per_watt{1};
inline constexpr Unit<Dimension::length> metres{1};
inline constexpr Unit<Dimension::angle> radians{1};
inline constexpr Unit<Dimension::angle> degrees{pi / 180};
inline constexpr Unit<Dimension::temperature> kelvins{1};
inline constexpr Unit<Dimension::duration> seconds{1};

// A quantity whose dimension is known at run time only.
struct AnyQuantity {
  Dimension dimension;
  double si;
};

// "1500 lm", "20 knit", "60 cm", "-3 EV": decimal number, optional blank, unit with optional SI prefix where the unit takes one.
// Errors: UNIT_MISSING, UNIT_UNKNOWN (with the nearest spellings), NUMBER_INVALID (also for infinite and NaN).
Result<AnyQuantity> parse_quantity(std::string_view text);

// The same, of one dimension. Error: DIMENSION_MISMATCH names both dimensions.
Result<double> parse_si(std::string_view text, Dimension expected);

// Shortest decimal text that reads back as the same double, and the SI unit: "1500 lm".
std::string to_string(const AnyQuantity& quantity);

// Reflected-light meter (K = 12.5 cd s/m2): luminance of an EV at ISO 100, L = 2^EV K / 100.
// Never infinite: EV beyond +-1000 count as that, and a luminance at or below 0 as the smallest normal double (EV -1019).
double luminance_of_ev100(double ev100);
double ev100_of_luminance(double luminance_cd_m2);
// Saturation-based exposure (ISO 12232): what a picture in cd/m2 is multiplied by so that 1 is the sensor's saturation, 1 / (1.2 2^EV).
double exposure_of_ev100(double ev100);

}  // namespace etendue
