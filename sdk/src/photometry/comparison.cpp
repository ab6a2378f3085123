#include "etendue/photometric_comparison.h"

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

bool bilinear_in_c_and_gamma(const IntensityWeb& web) { return web.type() == WebType::c && web.interpolation() == Interpolation::linear; }

// Angles at which a web of type C bends, and just beyond both ends of its table, where it falls to nothing.
void add_gammas(const IntensityWeb& web, std::vector<double>& gammas) {
  if (web.type() != WebType::c) return;
  const std::vector<double>& nodes = web.polar().nodes();
  gammas.insert(gammas.end(), nodes.begin(), nodes.end());
  constexpr double beyond = 1e-7;
  gammas.push_back(std::max(0.0, nodes.front() - beyond));
  gammas.push_back(std::min(180.0, nodes.back() + beyond));
}

void add_planes(const IntensityWeb& web, std::vector<double>& planes) {
  if (web.type() != WebType::c || web.symmetry() == WebSymmetry::rotational) return;
  for (const double azimuth : web.azimuth().nodes())
    for (int copy = 0; copy < web.copies(); ++copy) {
      const Vec3d u = direction_of(WebType::c, {90, web.unfolded(90, azimuth, copy).horizontal_deg}, web.frame());
      planes.push_back(angles_of(WebType::c, u).horizontal_deg);
    }
}

std::vector<double> in_order(std::vector<double> angles) {
  std::sort(angles.begin(), angles.end());
  angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
  return angles;
}

std::vector<double> every(double step, double last) {
  std::vector<double> angles;
  for (int i = 0; i * step <= last; ++i) angles.push_back(i * step);
  return angles;
}

}  // namespace

WebDifference difference(const IntensityWeb& first, const IntensityWeb& second) {
  WebDifference found;
  found.flux_lm = second.flux_lm() - first.flux_lm();
  found.exact = bilinear_in_c_and_gamma(first) && bilinear_in_c_and_gamma(second);
  std::vector<double> gammas = found.exact ? std::vector<double>{} : every(0.5, 180),
                      planes = found.exact ? std::vector<double>{0} : every(0.5, 359.5);
  for (const IntensityWeb* web : {&first, &second}) {
    add_gammas(*web, gammas);
    add_planes(*web, planes);
  }
  gammas = in_order(std::move(gammas));
  planes = in_order(std::move(planes));
  for (const double c : planes)
    for (const double gamma : gammas) {
      const double d = second.at(c, gamma) - first.at(c, gamma);
      if (std::abs(d) > std::abs(found.largest_cd)) found.largest_cd = d, found.c_deg = c, found.gamma_deg = gamma;
    }
  // Midpoints of rings of equal width in gamma, weighted by their solid angle.
  constexpr int rings = 720, turns = 360;
  double weight = 0;
  for (int i = 0; i < rings; ++i) {
    const double gamma = 180.0 * (i + 0.5) / rings, sine = std::sin(gamma * pi / 180);
    for (int j = 0; j < turns; ++j) {
      const double c = 360.0 * (j + 0.5) / turns, d = second.at(c, gamma) - first.at(c, gamma);
      found.mean_cd += sine * d;
      found.mean_abs_cd += sine * std::abs(d);
      found.rms_cd += sine * d * d;
      weight += sine;
    }
  }
  found.mean_cd /= weight;
  found.mean_abs_cd /= weight;
  found.rms_cd = std::sqrt(found.rms_cd / weight);
  return found;
}

}  // namespace etendue
