// Facets of a rough mirror, by the distribution of their normals: GGX and Beckmann, round or stretched, and Blinn-Phong's.
//
// In slopes p = (-mx / mz, -my / mz) of the facets a distribution is a density P(p) = D(m) (n.m)^4, of integral 1:
//   GGX:         P = 1 / (pi ax ay (1 + q^2)^2),        q^2 = (px / ax)^2 + (py / ay)^2   (Walter et al. 2007, eq 33)
//   Beckmann:    P = exp(-q^2) / (pi ax ay)                                               (eq 25)
//   Blinn-Phong: D = (n + 2) / (2 pi) (n.m)^n, so P = (n + 2) / (2 pi) (1 + |p|^2)^-(n + 4)/2, n = 2 / alpha^2 - 2 (eq 30)
// All else follows from D and from the area of facets that a view sees, in projection,
//   U(v) = integral of D(m) <v.m> dm = n.v / G1(v) = n.v (1 + Lambda(v))  (Smith 1967; Heitz 2014, eq 5 and 43):
// facets that the view sees have the density D(m) <v.m> / U(v), and light that they mirror D / (4 U(v)).
#pragma once

#include "etendue/eval.h"

namespace etendue::eval {

// The mean of fresnel_reflectance over light from all over the hemisphere.
Rgb mean_fresnel(const SpecularLobe& lobe);

class Facets {
 public:
  Facets(Distribution distribution, double alpha_x, double alpha_y);

  // D of a half vector of any length: what is across the normal keeps its digits at alpha 1e-4.
  double density(const Vec3d& half) const;
  double highest_density() const;
  // U of a unit direction above the horizon.
  double seen_area(const Vec3d& direction) const;
  // The alpha that a view from there has to do with: of round facets the only one.
  double alpha_towards(const Vec3d& direction) const;
  // A facet's normal with the density D(m) <v.m> / U(v).
  Vec3d seen_normal(const Vec3d& view, const Vec2d& u) const;

 private:
  double power_area(double c, double s) const;
  Vec2d seen_gaussian_slope(double c, double s, const Vec2d& u) const;
  Vec2d seen_power_slope(double c, double s, const Vec2d& u) const;

  Distribution distribution_;
  double ax_, ay_;
  // Blinn-Phong: the exponent, and what makes the density of one slope (1 + p^2)^-(n + 3)/2 an integral of 1.
  double exponent_ = 0, slope_scale_ = 0;
};

}  // namespace etendue::eval
