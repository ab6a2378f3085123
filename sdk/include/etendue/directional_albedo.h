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

// For SpecularLobe::compensation, of the lobe's facets and masking; its Fresnel term has no part in it. Takes some ten milliseconds, with
// anisotropic facets a second; what it says is within 1e-4 of directional_albedo().
std::shared_ptr<const AlbedoCurve> albedo_curve(const SpecularLobe& lobe);
double albedo(const AlbedoCurve& curve, const Vec3d& direction);
double mean_albedo(const AlbedoCurve& curve);  // of light from all over the hemisphere: 1 / pi integral of albedo times cosine

}  // namespace etendue::eval
