// What data sheets say of a luminaire, computed from its web. Angles in degrees, flux in lm.
#pragma once

#include "etendue/intensity_web.h"

#include <array>
#include <optional>

namespace etendue {

// The plane that holds C and C + 180.
enum class PlanePair { c0_180, c90_270 };

// A full angle between the directions at which the intensity of a plane first falls to a share of a reference.
struct Spread {
  double full_deg = 0;
  double towards_c_deg = 0, away_deg = 0;  // both ends as signed gammas: positive towards C, negative towards C + 180
  bool ends_with_table = false;            // it had not fallen that far where the table ends: the angle is a lower bound
};

// IES: of that plane's largest intensity, from there to both sides. Nothing where the plane is dark.
std::optional<Spread> spread_about_peak(const IntensityWeb& web, PlanePair plane, double share);
// CIE: of the intensity at gamma 0, from there to both sides. Nothing where that is 0.
std::optional<Spread> spread_about_axis(const IntensityWeb& web, PlanePair plane, double share);
inline constexpr double beam_share = 0.5, field_share = 0.1;

// Where the web is brightest: the first such node of the table.
struct Peak {
  double cd = 0;
  WebAngles angles;  // of the web's own type
};
Peak peak_of(const IntensityWeb& web);

// Where the light goes, and how much of the lamps' light it is (EN 13032-2: LOR, DLOR, ULOR). EULUMDAT states 100 `lor` and 100
// `downward_share`.
struct LightOutput {
  double flux_lm = 0, downward_lm = 0, upward_lm = 0;
  double downward_share = 0;              // DFF: of the flux; 0 where there is none
  std::optional<double> lor, dlor, ulor;  // of the flux that the file states for its lamps, where it states one above 0
  std::optional<double> efficacy_lm_w;    // of the luminaire, where the input power is stated
};
LightOutput light_output(const IntensityDistribution& distribution, const IntensityWeb& web);

// Cones about the nadir with a quarter, a half, three quarters and the whole of the lower hemisphere's solid angle: 1 - cos gamma = 1/4,
// 1/2, 3/4, 1 (CIE 52, CIE 190 section 4.2).
inline constexpr std::array<double, 4> cie_cone_deg{41.409622109270856, 60, 75.522487814070076, 90};
std::array<double, 4> cie_cone_flux_lm(const IntensityWeb& web);

// lm that pass a cone about the nadir: all of the intensity up to the inner half angle, none from the outer one on (up to 180 degrees), and
// between them the square of (cos gamma - cos outer) / (cos inner - cos outer), as of a spot. To 1e-9 of the flux.
double flux_through_cone(const IntensityWeb& web, double inner_deg, double outer_deg);

// NEMA's beam types of floodlights by the field angle: 1 from 10 to 18 degrees, 2 to 29, 3 to 46, 4 to 70, 5 to 100, 6 to 130, 7 beyond.
// Nothing below 10 degrees.
std::optional<int> nema_type(double field_deg);

// Area of the luminous opening as seen from a direction in the web's frame, m2: flat ones from both sides, the bodies of the shape table by
// their silhouette. EULUMDAT's length lies along C90-C270, its four heights belong to the sides that face C0, C90, C180 and C270. Nothing
// for a point and for an unknown shape; 0 where a flat opening is seen from its edge.
std::optional<double> projected_opening_m2(const IntensityDistribution& distribution, const IntensityWeb& web, const Vec3d& direction);

// Mean luminance of the opening, cd/m2: intensity by projected area. Nothing where no area is seen.
std::optional<double> opening_luminance(const IntensityDistribution& distribution, const IntensityWeb& web, const Vec3d& direction);

// Plausibility: what is well-formed but hardly meant. NADIR_NOT_UNIQUE, PLANE_360_DIFFERS, EFFICIENCY_HIGH, EFFICIENCY_LOW, DARK,
// WATTS_ZERO, LORL_MISMATCH, DFF_MISMATCH: all warnings but WATTS_ZERO and NADIR_NOT_UNIQUE, which are notes.
Diagnostics review(const IntensityDistribution& distribution, const IntensityWeb& web);

}  // namespace etendue
