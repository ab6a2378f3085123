// Distributions made from distributions: turned, unfolded, folded, resampled, scaled. What moves values moves them unchanged.
#pragma once

#include "etendue/photometry.h"

namespace etendue {

// The grid of type C with `turn_deg` added to every C angle. By a multiple of 90 planes are permuted and stay folded as far as the turn
// allows; mirrored halves are kept from C0 (about_0_180) or from C-90 (about_90_270). By another angle the web is unfolded and gets one
// plane more, where the new C0 falls between two, which changes no intensity. Error: WEB_INVALID for types A and B.
Result<IntensityGrid> turned(const IntensityGrid& grid, double turn_deg);

// Every plane of the full circle from 0 to 360, both included, without a mirror. Error: WEB_INVALID for types A and B.
Result<IntensityGrid> unfolded(const IntensityGrid& grid);

// The smallest part of the grid whose mirrors give the whole again, each value off by at most `tolerance` of the largest; the first of
// mirrored values is kept. `error` is the largest deviation found, in values of the grid: the bound of what is lost everywhere.
struct FoldedGrid {
  IntensityGrid grid;
  double error = 0;
};
FoldedGrid folded(const IntensityGrid& grid, double tolerance);

// Onto other angles of the same kind, by the interpolation linear in both. The webs before and after are bilinear between their angles, so
// their difference is bilinear in every cell of both together and largest at a corner of one: `error`, in values of the grid, is exact. The
// angles must begin and end where the grid's do; a full circle ends one turn behind its first plane. A rotational grid keeps its plane.
// Error: WEB_INVALID.
struct ResampledGrid {
  IntensityGrid grid;
  double error = 0;
};
Result<ResampledGrid> resampled(const IntensityGrid& grid, const std::vector<double>& vertical_deg,
                                const std::vector<double>& horizontal_deg);

// As resampled() takes them: equal steps of at most `step_deg` over the range that the grid stores.
std::vector<double> vertical_steps(const IntensityGrid& grid, double step_deg);
std::vector<double> horizontal_steps(const IntensityGrid& grid, double step_deg);

// The distribution with another grid; what its record says of the old one (EULUMDAT's listed planes and steps) follows.
IntensityDistribution with_grid(IntensityDistribution distribution, IntensityGrid grid);

// Scaled to emit `flux_lm` under the interpolation linear in angle: the multiplier of an IES record, the flux of EULUMDAT's lamp set.
// Error: WEB_INVALID, also where nothing is emitted.
Result<IntensityDistribution> scaled_to_flux(IntensityDistribution distribution, double flux_lm);

}  // namespace etendue
