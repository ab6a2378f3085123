// Diffuse reflection of a rough surface whose facets are Lambertian, by integration: what diffuse models stand for and are measured
// against.
#pragma once

#include "etendue/eval.h"

namespace etendue::eval {

// What light passes on its way into a facet and out of it again.
enum class FacetInterface {
  none,          // all light enters and leaves: eq 4
  diffuse_exit,  // enters with the exact Fresnel transmittance, leaves with the mean one of diffuse light: C.1. Not reciprocal
  both_ways,     // exact Fresnel transmittance towards the light and towards the view; what is reflected inside is lost
};
// GGX facets that reflect what enters them evenly to all sides; light that one facet sends to another is lost.
struct LambertianFacets {
  double alpha = 0.25;
  Masking masking = Masking::correlated;
  FacetInterface interface = FacetInterface::none;
  double eta = 1.5;  // index of refraction inside over that outside, at least 1
};

struct FacetSum {
  double value = 0;  // 1/sr
  double error = 0;  // bound
};
// BRDF times cosine of `light` for facets of albedo 1, as brdf_cos(): Lagarde and de Rousiers 2014, eq 4 and C.1 (there F_dr is Jensen et
// al.'s, 2001: .668 + .0636 eta + .71 / eta - 1.44 / eta^2), in double, adaptive, to that relative error. 0 if either direction is below
// the horizon.
FacetSum brdf_cos(const LambertianFacets& facets, const Vec3d& view, const Vec3d& light, double relative = 1e-8);

}  // namespace etendue::eval
