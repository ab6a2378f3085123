// What data sheets say of a luminaire, computed from its web. Angles in degrees, flux in lm.
#pragma once

#include "etendue/intensity_web.h"

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

// Plausibility: what is well-formed but hardly meant. NADIR_NOT_UNIQUE, PLANE_360_DIFFERS, EFFICIENCY_HIGH, EFFICIENCY_LOW, DARK,
// WATTS_ZERO, LORL_MISMATCH, DFF_MISMATCH: all warnings but WATTS_ZERO and NADIR_NOT_UNIQUE, which are notes.
Diagnostics review(const IntensityDistribution& distribution, const IntensityWeb& web);

}  // namespace etendue
