// Chromaticity and colour temperature of lights, and their linear Rec.709 (D65), in double.
#pragma once

#include "etendue/result.h"
#include "etendue/vec.h"

namespace etendue {

// Luminance of linear Rec.709, Y = .2126 R + .7152 G + .0722 B.
constexpr double luminance_of(const Rgb& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

// CIE 1931 chromaticity.
struct Chromaticity {
  double x = 0, y = 0;
};

// Planckian radiator, c2 of SI 2019, CIE 1931 2 degree observer, 360-830 nm summed at 1 nm. Domain: 100 K to 100000 K, and infinity
// (the limit, a spectrum of lambda^-4); TEMPERATURE_OUT_OF_RANGE.
Result<Chromaticity> planckian(double temperature_K);
// CIE daylight (CIE 015): 4000 K to 25000 K; TEMPERATURE_OUT_OF_RANGE.
Result<Chromaticity> daylight(double temperature_K);
// CIE daylight, and below 4000 K, where it is not defined, a locus that leaves it smoothly for the Planckian one, which it reaches at 2500
// K (others jump by .0037 u'v' at 4000 K). 100 K to 25000 K.
Result<Chromaticity> daylight_or_planckian(double temperature_K);

// A temperature and how far beside the Planckian locus: Duv is the distance in CIE 1960 (u, v), positive above (greenish), negative below.
struct ColourTemperature {
  double kelvin = 0, duv = 0;
};
// The point at that distance along the normal of the locus. Domain: 500 K to 100000 K, |Duv| <= .05, within which normals do not meet (the
// locus' least radius of curvature is .100); TEMPERATURE_OUT_OF_RANGE, DUV_OUT_OF_RANGE.
Result<Chromaticity> to_chromaticity(const ColourTemperature& temperature);
// Its inverse: correlated colour temperature, the nearest point of the locus in CIE 1960 (u, v), to the rounding of a double.
// NOT_NEAR_LOCUS where there is none within |Duv| <= .05, TEMPERATURE_OUT_OF_RANGE where the nearest is an end of 500 K to 100000 K.
Result<ColourTemperature> to_colour_temperature(const Chromaticity& xy);

// Reciprocal megakelvin, 10^6 / T: equal steps look about equal, and filters are sold by it. TEMPERATURE_OUT_OF_RANGE unless positive.
Result<double> mired_of(double temperature_K);
// A conversion filter's shift: 10^6 / (10^6 / T + shift). Positive is warmer. TEMPERATURE_OUT_OF_RANGE where nothing positive is left.
Result<double> shifted_by_mired(double temperature_K, double shift_mired);

// Chromaticity diagrams: CIE 1960 (u, v), in which Duv is measured, and CIE 1976 (u', v') = (u, 1.5 v), in which differences are stated.
struct Uv {
  double u = 0, v = 0;
};
Uv to_uv1960(const Chromaticity& xy);
Chromaticity from_uv1960(const Uv& uv);
// Distance in (u', v').
double difference_uv1976(const Chromaticity& a, const Chromaticity& b);

// Linear Rec.709 with luminance_of = 1 exactly (up to rounding), no adaptation, negative channels kept. The matrix is derived from the
// primaries and D65 = (.3127, .3290). Black for a chromaticity without luminance (y <= 0).
Rgb to_rgb(const Chromaticity& xy);
// (0, 0) for black.
Chromaticity to_chromaticity(const Rgb& rgb);

// A colour moved into the gamut (no negative channel) at the same Y: clipped, then rescaled. Black if Y <= 0.
Rgb clipped_keeping_luminance(const Rgb& rgb);

}  // namespace etendue
