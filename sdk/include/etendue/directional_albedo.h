// What a lobe gives back of a white sky: its directional albedo, with what f0 and f90 have of it apart (the "DFG" integrals of Karis 2013,
// eq 8, and of Lagarde and de Rousiers 2014, eq 55-58), exactly, fast, and as what facets pass on to each other.
#pragma once

#include "etendue/eval.h"

#include <cstdint>
#include <memory>

namespace etendue::eval {

// With Schlick's Fresnel F = f0 + (f90 - f0) w the albedo is f0 * f0_part + f90 * f90_part: the integrals of f cos / F times 1 - w and w.
struct AlbedoParts {
  double f0_part = 0, f90_part = 0;
  double error = 0;  // bound, of either
  std::uint64_t evaluations = 0;

  double sum() const { return f0_part + f90_part; }  // of a lobe that mirrors all
};
// In double by adaptive quadrature, to that relative error of the sum. `view`: unit, in the shading frame. 0 below the horizon.
// Fresnel::schlick_gaussian has w of its own; for exact Fresnel terms it is Schlick's.
AlbedoParts directional_albedo(const SpecularLobe& lobe, const Vec3d& view, double relative = 1e-10);
// With whatever Fresnel term it has.
Estimate reflectance(const SpecularLobe& lobe, const Vec3d& view, double relative = 1e-10);

// Of white Disney and Frostbite diffuse, by the cosine of the view, in closed form: the third channel of Lagarde and de Rousiers' listing
// 18 (which is Frostbite's with roughness = sqrt(alpha)).
double disney_albedo(double roughness, double cosine);
double frostbite_albedo(double roughness, double cosine);

// For SpecularLobe::compensation, of the lobe's facets and masking; its Fresnel term has no part in it. Made in some .1 s (Blinn-Phong 1
// s); within 5e-7 of directional_albedo() for round GGX and 5e-5 for the other round facets. Stretched ones take seconds: within 5e-5 for
// alphas of 1 to .3, 1e-2 for 1 to .1. Null for Phong's, which has no facets.
std::shared_ptr<const AlbedoCurve> albedo_curve(const SpecularLobe& lobe);
double albedo(const AlbedoCurve& curve, const Vec3d& direction);
double mean_albedo(const AlbedoCurve& curve);  // of light from all over the hemisphere: 1 / pi integral of albedo times cosine

// The parts over all alphas and cosines of round facets, for fast use: 32 x 32 pairs of floats, read by cubics. Made in one to two seconds;
// the lobe's own alphas have no part in it. Null for Phong's.
class AlbedoTable;
std::shared_ptr<const AlbedoTable> albedo_table(const SpecularLobe& lobe);
// alpha from 1e-4 to 1. Within 5e-4 of directional_albedo() for GGX, 1e-3 for the others, each part; `error` is 0.
AlbedoParts albedo_parts(const AlbedoTable& table, double alpha, double cosine);

}  // namespace etendue::eval
