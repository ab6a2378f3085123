#include "etendue/microfacet_diffuse.h"

#include "fan.h"
#include "fresnel.h"
#include "microfacet.h"

namespace etendue::eval {
namespace {

double diffuse_transmittance(double eta) { return 1 + 1.44 / (eta * eta) - 0.71 / eta - 0.668 - 0.0636 * eta; }

}  // namespace

// With m = M / |M|, M = (alpha m'x, alpha m'y, m'z), GGX is the clamped cosine over directions m': D(m) n.m dm = m'z / pi dm'. Since
// n.m = m'z / |M|,
//   integral of D(m) <v.m> <l.m> dm = 1 / pi integral of <v'.m'> <l'.m'> / |M| dm',  v' = (alpha vx, alpha vy, vz),
// over the directions m' above the horizons of n, v' and l': a region of great circles, and smooth within it. |M|^2 =
// alpha^2 + (1 - alpha^2) m'z^2 has its scale alpha above the horizon.
FacetSum brdf_cos(const LambertianFacets& facets, const Vec3d& view, const Vec3d& light, double relative) {
  if (!(view.z > 0) || !(light.z > 0)) return {};
  const double alpha = std::clamp(facets.alpha, min_alpha, 1.0);
  const auto stretched = [alpha](const Vec3d& d) { return Vec3d{alpha * d.x, alpha * d.y, d.z}; };
  const Vec3d v = stretched(view), l = stretched(light);
  Fan fan;
  fan.contour = clipped(clipped(Contour{horizon_circle({0, 0, 1})}, normalised(v)), normalised(l));
  if (fan.contour.empty()) return {};
  const Vec3d mean = direction_integral(fan.contour);
  fan.centre = length(mean) > 0 ? normalised(mean) : Vec3d{0, 0, 1};
  fan.in_plane = basis_around(fan.centre).tangent;
  if (alpha < 0.5) fan.layer = alpha;
  const auto integrand = [&](const Vec3d& m, std::size_t) {
    const double size = std::sqrt(alpha * alpha + (1 - alpha * alpha) * m.z * m.z);
    const double vm = std::max(dot(v, m), 0.0), lm = std::max(dot(l, m), 0.0);
    const auto passed = [&](double part) { return 1 - dielectric_reflectance(std::min(part / size, 1.0), facets.eta); };
    double value = vm * lm / size;
    if (facets.interface != FacetInterface::none) value *= passed(lm);
    if (facets.interface == FacetInterface::both_ways) value *= passed(vm);
    return Rgb{value, 0, 0};
  };
  const Estimate sum = FanIntegrator(integrand, Tolerance{relative, 0}).integrate({fan});
  const double leaving = facets.interface == FacetInterface::diffuse_exit ? diffuse_transmittance(facets.eta) : 1;
  // The facets' normals enter Smith's masking only by the side of them that is seen.
  const double masking_over_view = 4 * light.z * GgxView(alpha, facets.masking, view).masked(light.z);
  const double scale = masking_over_view * leaving / (pi * pi);
  return {scale * sum.value.x, scale * sum.error.x};
}

}  // namespace etendue::eval
