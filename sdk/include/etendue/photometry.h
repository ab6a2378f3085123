// Intensity distributions: luminous intensity over direction as photometric files tabulate it, kept in the file's own grid and raw values.
// What evaluates and integrates them is intensity_web.h.
#pragma once

#include "etendue/result.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace etendue {

// Coordinates, by LM-63's names (CIE 102 calls LM-63's type C "A" and the reverse).
enum class WebType {
  c,  // vertical: gamma from the nadir, 0..180; horizontal: C about the vertical axis.  dOmega = sin(gamma) dgamma dC
  b,  // horizontal: H, the latitude; vertical: V, the longitude about a horizontal axis. dOmega = cos(H) dH dV
  a   // vertical: V, the latitude; horizontal: H, the longitude about the vertical axis. dOmega = cos(V) dV dH
};

// Which part of the web is stored. Mirrors are exact: nothing is unfolded.
enum class WebSymmetry {
  none,          // C: all around (the last plane joins the first where 360 deg is not stored); A, B: the tabulated range
  about_0_180,   // C: mirrored by the C0-C180 plane; a half circle from 0 or 180 is stored
  about_90_270,  // C: mirrored by the C90-C270 plane; a half circle from 90 or -90 is stored
  quadrant,      // C: both mirrors; C0..C90 is stored
  rotational,    // C: one plane
  lateral,       // A, B: H and -H alike, H from 0 is stored
  vertical,      // A, B: V and -V alike, V from 0 is stored
  lateral_and_vertical
};
std::string_view name_of(WebType type);          // "C"
std::string_view name_of(WebSymmetry symmetry);  // "about_0_180"

struct IntensityGrid {
  WebType type = WebType::c;
  WebSymmetry symmetry = WebSymmetry::none;
  std::vector<double> vertical_deg, horizontal_deg;  // strictly increasing
  std::vector<double> values;                        // as written; the vertical angle runs fastest
};

// A line of an IES header: "[NAME] text", or free text with an empty name. [MORE] lines stand as they are written.
struct Keyword {
  std::string name, text;
  friend bool operator==(const Keyword&, const Keyword&) = default;
};

// How the output of a lamp depends on the angle at which the luminaire is installed. Never applied to the candelas here.
struct LampTilt {
  std::string file;  // TILT=<file>; empty: included
  int geometry = 1;  // 1: lamp vertical; 2: horizontal and stays so; 3: horizontal and tilts
  std::vector<double> angles_deg, factors;
  bool resolved = true;  // false: the named file was not read, angles and factors are empty
};

enum class IesVersion { lm_63_1986, lm_63_1991, lm_63_1995, lm_63_2002, lm_63_2019 };
std::string_view name_of(IesVersion version);  // "1995"

// LM-63's own numbers, as written.
struct IesRecord {
  IesVersion version = IesVersion::lm_63_2019;
  std::vector<Keyword> keywords;
  std::optional<LampTilt> tilt;
  double lamps = 1, lumens_per_lamp = -1;  // -1: absolute photometry
  double multiplier = 1;
  bool feet = false;
  double width = 0, length = 0, height = 0;  // in feet or metres, signs code the shape by version
  double ballast_factor = 1;
  double third_factor = 1;  // 1986, 1991: ballast-lamp factor; 1995, 2002: 1; 2019: how the file was made
  double watts = 0;
};

// One of several ways to equip a luminaire: alternatives, never a sum.
struct LampSet {
  double lamps = 1;  // below 0: absolute photometry
  std::string type;
  double flux_lm = 0;  // of all lamps of the set; of the luminaire in absolute photometry
  std::string colour, rendering;
  double watts = 0;  // with ballast
};

// EULUMDAT's own fields, as written.
struct EulumdatRecord {
  std::string company;
  int luminaire_type = 1;  // Ityp
  int symmetry = 0;        // Isym
  double c_step_deg = 0;   // Dc, 0: not equidistant
  double gamma_step_deg = 0;
  std::string report, luminaire, number, file_name, date;
  double length_mm = 0, width_mm = 0, height_mm = 0;   // width 0: circular
  double opening_length_mm = 0, opening_width_mm = 0;  // width 0: circular
  std::array<double, 4> opening_height_mm{};           // towards C0, C90, C180, C270
  double dff_percent = 0, lorl_percent = 0;            // stated
  double conversion_factor = 1, tilt_deg = 0;
  std::vector<LampSet> lamp_sets;
  std::optional<std::array<double, 10>> direct_ratios;  // room indices .6 .8 1 1.25 1.5 2 2.5 3 4 5
  std::vector<double> c_deg;                            // all that are listed, also where fewer planes are stored
};

struct IntensityDistribution {
  std::string file;  // where it came from
  IntensityGrid grid;
  std::variant<IesRecord, EulumdatRecord> record;
  std::size_t lamp_set = 0;  // which of EULUMDAT's
};

// What a grid's value and its candelas may be at most, so that flux and squares stay within a double. The sun has 3e27 cd.
inline constexpr double largest_candelas = 1e100;

// cd for a grid value of 1: IES multiplier x ballast factor (x ballast-lamp factor in 1986 and 1991 alone; LM-63 3.18); EULUMDAT
// conversion factor x flux of the chosen lamp set / 1000.
double candelas_per_value(const IntensityDistribution& distribution);

// Candelas do not scale with the lamp: lumens per lamp -1, or a negative number of lamps.
bool is_absolute(const IntensityDistribution& distribution);

// Flux that the file states for its lamps (EULUMDAT, absolute: for the luminaire). Nothing for IES's absolute photometry.
std::optional<double> rated_flux_lm(const IntensityDistribution& distribution);

double input_watts(const IntensityDistribution& distribution);

// Text of an IES keyword, [MORE] lines joined by a blank; "" if there is none. EULUMDAT: LUMINAIRE, MANUFAC, LUMCAT, TEST, LAMP.
std::string keyword_of(const IntensityDistribution& distribution, std::string_view name);

// The luminous opening, by the shape table of the file's version (they differ: -d 0 -d is a sphere in 1995, a vertical disk in 2002).
enum class OpeningShape {
  point,
  rectangle,
  box,
  disk,
  ellipse,
  vertical_cylinder,
  vertical_elliptical_cylinder,
  sphere,
  ellipsoid,
  cylinder_along_length,
  cylinder_along_width,
  vertical_disk,
  unknown  // a combination of signs that the version does not define
};
std::string_view name_of(OpeningShape shape);
struct LuminousOpening {
  OpeningShape shape = OpeningShape::point;
  double width_m = 0, length_m = 0, height_m = 0;  // across (C90-C270), along (C0-C180), vertical; never negative
};
LuminousOpening opening_of(const IntensityDistribution& distribution);

// What every distribution must fulfil to be evaluated: angles strictly increasing and in range, as many values as angles say, finite values
// and factors, no negative candela. Errors: WEB_INVALID.
Status check(const IntensityDistribution& distribution);

}  // namespace etendue
