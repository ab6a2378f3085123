// Flux by hemispheres and cones, and classes made of it.
#include "etendue/photometric_quantities.h"

#include "angle.h"
#include "gauss.h"

#include <algorithm>
#include <cmath>
#include <vector>

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

// With F(gamma) the flux inside gamma and x = (cos gamma - cos outer) / (cos inner - cos outer), the share is x^2, and by parts
//   integral of share dF = integral over x from 0 to 1 of 2 x F(gamma(x)),
// which needs F alone, for webs of every type. F is smooth between the polar angles of a web of type C; those of A and B have none, and are
// cut every 5 degrees.
double flux_through_cone(const IntensityWeb& web, double inner_deg, double outer_deg) {
  using photometry::degree;
  const double outer = std::cos(outer_deg * degree), range = std::cos(inner_deg * degree) - outer;
  double below = web.flux_between(0, inner_deg), sum = 0, reached = inner_deg;
  if (!(range > 0)) return below;
  std::vector<double> cuts{inner_deg, outer_deg};
  if (web.type() == WebType::c) {
    cuts.insert(cuts.end(), web.polar().nodes().begin(), web.polar().nodes().end());
  } else {
    for (int cut = 5; cut < 180; cut += 5) cuts.push_back(cut);
  }
  std::erase_if(cuts, [&](double cut) { return cut < inner_deg || cut > outer_deg; });
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const double middle = 0.5 * (cuts[i] + cuts[i + 1]), half = 0.5 * (cuts[i + 1] - cuts[i]);
    for (const photometry::GaussNode& node : photometry::gauss_16) {
      const double gamma = middle + half * node.x;
      below += web.flux_between(reached, gamma);
      reached = gamma;
      // dx = -sin(gamma) / range dgamma, and x falls where gamma grows.
      const double x = (std::cos(gamma * degree) - outer) / range;
      sum += node.weight * half * degree * std::sin(gamma * degree) / range * 2 * x * below;
    }
  }
  return sum;
}

std::optional<int> nema_type(double field_deg) {
  if (!(field_deg >= 10)) return {};
  int type = 1;
  for (const double widest : {18.0, 29.0, 46.0, 70.0, 100.0, 130.0}) type += field_deg > widest ? 1 : 0;
  return type;
}

}  // namespace etendue
