// Flux by hemispheres and cones, and classes made of it.
#include "etendue/photometric_quantities.h"

#include <algorithm>

namespace etendue {

LightOutput light_output(const IntensityDistribution& distribution, const IntensityWeb& web) {
  LightOutput out;
  out.flux_lm = web.flux_lm();
  out.downward_lm = web.flux_between(0, 90);
  out.upward_lm = web.flux_between(90, 180);
  if (out.flux_lm > 0) out.downward_share = std::min(1.0, out.downward_lm / out.flux_lm);
  if (const std::optional<double> lamps = rated_flux_lm(distribution); lamps && *lamps > 0) {
    out.lor = out.flux_lm / *lamps;
    out.dlor = out.downward_lm / *lamps;
    out.ulor = out.upward_lm / *lamps;
  }
  if (const double watts = input_watts(distribution); watts > 0) out.efficacy_lm_w = out.flux_lm / watts;
  return out;
}

std::array<double, 4> cie_cone_flux_lm(const IntensityWeb& web) {
  std::array<double, 4> flux{};
  for (std::size_t i = 0; i < flux.size(); ++i) flux[i] = web.flux_between(0, cie_cone_deg[i]);
  return flux;
}

std::optional<int> nema_type(double field_deg) {
  if (!(field_deg >= 10)) return {};
  int type = 1;
  for (const double widest : {18.0, 29.0, 46.0, 70.0, 100.0, 130.0}) type += field_deg > widest ? 1 : 0;
  return type;
}

}  // namespace etendue
