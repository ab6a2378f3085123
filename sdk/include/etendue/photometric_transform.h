// Distributions made from distributions: turned, unfolded, folded, scaled. What moves values moves them unchanged.
#pragma once

#include "etendue/photometry.h"

namespace etendue {

// The grid of type C with `turn_deg` (a multiple of 90) added to every C angle. Folded as far as the turn allows; planes are permuted,
// never interpolated. Mirrored halves are kept from C0 (about_0_180) or from C-90 (about_90_270). Error: WEB_INVALID for types A and B.
Result<IntensityGrid> turned(const IntensityGrid& grid, int turn_deg);

// Every plane of the full circle from 0 to 360, both included, without a mirror. Error: WEB_INVALID for types A and B.
Result<IntensityGrid> unfolded(const IntensityGrid& grid);

// The smallest part of the grid whose mirrors give the whole again, each value off by at most `tolerance` of the largest; the first of
// mirrored values is kept. `error` is the largest deviation found, in values of the grid: the bound of what is lost everywhere.
struct FoldedGrid {
  IntensityGrid grid;
  double error = 0;
};
FoldedGrid folded(const IntensityGrid& grid, double tolerance);

// Scaled to emit `flux_lm` under the interpolation linear in angle: the multiplier of an IES record, the flux of EULUMDAT's lamp set.
// Error: WEB_INVALID, also where nothing is emitted.
Result<IntensityDistribution> scaled_to_flux(IntensityDistribution distribution, double flux_lm);

}  // namespace etendue
