#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "etendue/photometric_quantities.h"

namespace etendue {
namespace {

// All planes meet at the nadir, and a plane at 360 degrees is the one at 0.
void review_closure(const IntensityDistribution& d, Diagnostics& found) {
  const IntensityGrid& grid = d.grid;
  if (grid.type != WebType::c) return;
  const std::size_t n = grid.vertical_deg.size(), planes = grid.horizontal_deg.size();
  const Where where{d.file, 0, 0, {}};
  const double peak = *std::max_element(grid.values.begin(), grid.values.end());
  constexpr double noise = 1e-3;  // of the peak: rounding of what is written
  double lo = grid.values[0], hi = lo;
  for (std::size_t j = 0; j < planes; ++j) {
    lo = std::min(lo, grid.values[j * n]);
    hi = std::max(hi, grid.values[j * n]);
  }
  if (grid.vertical_deg.front() == 0 && hi - lo > noise * peak)
    found.note("NADIR_NOT_UNIQUE", fmt::format("the planes give {} to {} for the nadir, which is one direction", lo, hi), where);
  if (planes < 2 || grid.horizontal_deg.back() - grid.horizontal_deg.front() != 360) return;
  double worst = 0;
  for (std::size_t i = 0; i < n; ++i) worst = std::max(worst, std::abs(grid.values[i] - grid.values[(planes - 1) * n + i]));
  if (worst > noise * peak)
    found.warning("PLANE_360_DIFFERS", fmt::format("the planes at 0 and 360 deg differ by up to {:.3g} of the peak", worst / peak), where);
}

void review_stated(const IntensityDistribution& d, const IntensityWeb& web, Diagnostics& found) {
  const auto* ldt = std::get_if<EulumdatRecord>(&d.record);
  if (ldt == nullptr || !(web.flux_lm() > 0)) return;
  const Where where{d.file, 0, 0, {}};
  constexpr double tolerated = 1.5;  // percentage points
  const double lorl = 100 * web.flux_lm() / *rated_flux_lm(d) / ldt->conversion_factor, dff = 100 * web.flux_between(0, 90) / web.flux_lm();
  if (std::abs(lorl - ldt->lorl_percent) > tolerated)
    found.warning("LORL_MISMATCH",
                  fmt::format("the light output ratio is stated as {} %, the intensities give {:.2f} %", ldt->lorl_percent, lorl), where);
  if (std::abs(dff - ldt->dff_percent) > tolerated)
    found.warning("DFF_MISMATCH",
                  fmt::format("the downward flux fraction is stated as {} %, the intensities give {:.2f} %", ldt->dff_percent, dff), where);
}

}  // namespace

Diagnostics review(const IntensityDistribution& d, const IntensityWeb& web) {
  Diagnostics found;
  const Where where{d.file, 0, 0, {}};
  review_closure(d, found);
  if (!(web.flux_lm() > 0)) found.warning("DARK", "the luminaire emits nothing", where);
  if (const auto rated = rated_flux_lm(d); rated && *rated > 0) {
    const double efficiency = web.flux_lm() / *rated;
    if (efficiency > 1.05) found.warning("EFFICIENCY_HIGH", fmt::format("{:.1f} % of the rated flux comes out", 100 * efficiency), where);
    if (efficiency < 0.05) found.warning("EFFICIENCY_LOW", fmt::format("{:.2g} % of the rated flux comes out", 100 * efficiency), where);
  }
  if (input_watts(d) == 0) found.note("WATTS_ZERO", "the input power is stated as 0 W", where);
  review_stated(d, web, found);
  return found;
}

}  // namespace etendue
