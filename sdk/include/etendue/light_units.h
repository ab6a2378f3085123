// Light quantities into one another: what a shape of light makes of lumens, candelas, nits and lux.
//   Result<Luminance> l = luminance(lumens(1500), SphereShape{.radius = 0.15});   // 1688.69 cd/m2
//   Result<Intensity> i = intensity(lux(15000) | at(metres(2)), PointShape{});    // 60000 cd
//   luminance(lumens(1500), PointShape{})                                         // does not compile: a point has no surface
// For shapes that are known at run time: convert.h. The formulas, with their sources, are in formulas.h and sdk/docs/units.md.
#pragma once

#include "etendue/light.h"

#include <concepts>

namespace etendue {

using Exitance = Quantity<Dimension::luminous_exitance>;
using RadiantFlux = Quantity<Dimension::radiant_flux>;
using RadiantIntensity = Quantity<Dimension::radiant_intensity>;
using Radiance = Quantity<Dimension::radiance>;
using Irradiance = Quantity<Dimension::irradiance>;
using SolidAngle = Quantity<Dimension::solid_angle>;
using ExposureValue = Quantity<Dimension::exposure_value>;
inline constexpr Unit<Dimension::luminous_exitance> lumens_per_square_metre{1};
inline constexpr Unit<Dimension::radiant_flux> watts{1};
inline constexpr Unit<Dimension::radiant_intensity> watts_per_steradian{1};
inline constexpr Unit<Dimension::radiance> watts_per_steradian_square_metre{1};
inline constexpr Unit<Dimension::irradiance> watts_per_square_metre{1};
inline constexpr Unit<Dimension::solid_angle> steradians{1};
inline constexpr Unit<Dimension::exposure_value> ev100s{1};

// An illuminance means something for a light of finite distance only with that distance, from the light's origin along its axis.
struct IlluminanceAt {
  Illuminance illuminance;
  Length distance;
};
struct AtDistance {
  Length distance;
};
constexpr AtDistance at(Length distance) { return {distance}; }
constexpr IlluminanceAt operator|(Illuminance illuminance, AtDistance at) { return {illuminance, at.distance}; }

// Two shapes beyond light.h's, for what is known of a light without its form.
struct SurfaceOfArea {
  double area_m2 = 0;  // of one side, emitting equally in all directions: a mesh
};
struct BeamOfSolidAngle {
  double flux_over_axial_sr = 0;  // of an intensity distribution: its flux over its intensity on the axis
};

// How the intensity of a spot falls between its half angles i and o, over s = (cos t - cos o) / (cos i - cos o).
enum class SpotFalloff {
  hard,       // 1 up to the outer angle
  squared,    // s^2          (Frostbite 3.0, listing 4; KHR_lights_punctual)
  smoothstep  // s^2 (3 - 2s) (pbrt, PlayCanvas)
};

// What else decides how much flux a light has.
struct Conventions {
  bool two_sided = false;  // flat lights and surfaces of known area: flux is that of both sides together
  FluxConvention spot_flux = FluxConvention::falloff;
  SpotFalloff spot_falloff = SpotFalloff::squared;
};

namespace detail {
template <class S, class... Shapes>
inline constexpr bool one_of = (std::same_as<S, Shapes> || ...);
}  // namespace detail

// Shapes by what they emit with: intensity from a point, intensity along a line, luminance from a surface or from infinitely far away.
template <class S>
concept PunctualShape = detail::one_of<S, PointShape, SpotShape, FrustumShape, BeamOfSolidAngle>;
template <class S>
concept FormedShape = detail::one_of<S, SphereShape, DiskShape, RectShape, PolygonShape, TubeShape>;
template <class S>
concept SurfaceShape = FormedShape<S> || std::same_as<S, SurfaceOfArea>;
template <class S>
concept FarShape = detail::one_of<S, DistantShape, EnvironmentShape>;
template <class S>
concept LightShape = PunctualShape<S> || SurfaceShape<S> || FarShape<S> || std::same_as<S, LineShape>;

// Which quantities a shape knows.
template <class S, class Q>
concept Knows = LightShape<S> &&
    ((std::same_as<Q, Flux> && !FarShape<S>) ||
     (std::same_as<Q, Intensity> && (PunctualShape<S> || FormedShape<S> || std::same_as<S, LineShape>)) ||
     (std::same_as<Q, Luminance> && (SurfaceShape<S> || FarShape<S>)) || (std::same_as<Q, Exitance> && SurfaceShape<S>) ||
     (std::same_as<Q, IlluminanceAt> && (PunctualShape<S> || FormedShape<S> || std::same_as<S, LineShape>)) ||
     (std::same_as<Q, Illuminance> && FarShape<S>));

namespace detail {
// A quantity and, for illuminances of near lights, where.
struct Known {
  Dimension dimension;
  double si;
  std::optional<double> distance_m;
};
template <Dimension D>
constexpr Known known(Quantity<D> q) {
  return {D, q.si, {}};
}
constexpr Known known(const IlluminanceAt& e) { return {Dimension::illuminance, e.illuminance.si, e.distance.si}; }
// Instantiated for every LightShape. `wanted.si` is not read.
template <class S>
Result<double> converted(const Known& from, const Known& wanted, const S& shape, const Conventions& conventions);
template <Dimension D, class From, class S>
Result<Quantity<D>> made(const From& from, const S& shape, const Conventions& conventions, std::optional<double> distance_m = {}) {
  const Result<double> si = converted(known(from), {D, 0, distance_m}, shape, conventions);
  if (!si) return si.error();
  return Quantity<D>{*si};
}
}  // namespace detail

// Each is right to 1 ulp where the formula is algebraic in the sizes, to a few where it has an angle (solid angles: relative 1e-15).
// Errors: SIZE_MISSING (a size of 0, where the result would be infinite), NUMBER_INVALID (a quantity, size or angle that is negative, not
// finite or out of range; a distance that is not outside of the light; a result beyond a double). They name what, its value and its range.
// Intensities and illuminances are along the light's axis, those of tubes and lines perpendicular to it.
template <class From, class S>
requires Knows<S, From> && Knows<S, Flux> Result<Flux> flux(const From& from, const S& shape, const Conventions& conventions = {}) {
  return detail::made<Dimension::luminous_flux>(from, shape, conventions);
}
template <class From, class S>
requires Knows<S, From> && Knows<S, Intensity> Result<Intensity> intensity(const From& from, const S& shape,
                                                                           const Conventions& conventions = {}) {
  return detail::made<Dimension::luminous_intensity>(from, shape, conventions);
}
template <class From, class S>
requires Knows<S, From> && Knows<S, Luminance> Result<Luminance> luminance(const From& from, const S& shape,
                                                                           const Conventions& conventions = {}) {
  return detail::made<Dimension::luminance>(from, shape, conventions);
}
template <class From, class S>
requires Knows<S, From> && Knows<S, Exitance> Result<Exitance> exitance(const From& from, const S& shape,
                                                                        const Conventions& conventions = {}) {
  return detail::made<Dimension::luminous_exitance>(from, shape, conventions);
}
// On a plane facing the light, at a distance from its origin; exact near and far, not I/d^2, for lights with a size.
template <class From, class S>
requires Knows<S, From> && Knows<S, IlluminanceAt> Result<Illuminance> illuminance(const From& from, const S& shape, Length distance,
                                                                                   const Conventions& conventions = {}) {
  return detail::made<Dimension::illuminance>(from, shape, conventions, distance.si);
}
// On a plane facing a distant light, or lying under an even sky.
template <class From, class S>
requires Knows<S, From> && Knows<S, Illuminance> Result<Illuminance> illuminance(const From& from, const S& shape,
                                                                                 const Conventions& conventions = {}) {
  return detail::made<Dimension::illuminance>(from, shape, conventions);
}

// Solid angle whose product with the axial intensity is the flux: exact for cones up to 360 and frusta up to 180 degrees of full angle,
// relative error <= 1e-15. NUMBER_INVALID.
Result<SolidAngle> solid_angle(const SpotShape& spot, const Conventions& conventions = {});
Result<SolidAngle> solid_angle(const FrustumShape& frustum);
Result<SolidAngle> solid_angle_of_cone(Angle full_angle);

// The photometric twin of a radiometric dimension and back. Times an efficacy K in lm/W the radiometric quantity is the photometric one
// (Lagarde and de Rousiers, eq 9).
constexpr std::optional<Dimension> photometric_twin(Dimension radiant) {
  switch (radiant) {
    case Dimension::radiant_flux:
      return Dimension::luminous_flux;
    case Dimension::radiant_intensity:
      return Dimension::luminous_intensity;
    case Dimension::radiance:
      return Dimension::luminance;
    case Dimension::irradiance:
      return Dimension::illuminance;
    default:
      return {};
  }
}
constexpr std::optional<Dimension> radiant_twin(Dimension photometric) {
  for (const Dimension d : {Dimension::radiant_flux, Dimension::radiant_intensity, Dimension::radiance, Dimension::irradiance})
    if (photometric_twin(d) == photometric) return d;
  return {};
}

// Watts say nothing about light without it. NUMBER_INVALID unless it is above 0 and all is finite.
Result<double> photometric_si(double radiant_si, Efficacy efficacy);
Result<double> radiant_si(double photometric_si, Efficacy efficacy);

template <Dimension D>
requires(photometric_twin(D).has_value()) Result<Quantity<*photometric_twin(D)>> photometric(Quantity<D> radiant, Efficacy efficacy) {
  const Result<double> si = photometric_si(radiant.si, efficacy);
  if (!si) return si.error();
  return Quantity<*photometric_twin(D)>{*si};
}
template <Dimension D>
requires(radiant_twin(D).has_value()) Result<Quantity<*radiant_twin(D)>> radiometric(Quantity<D> photometric, Efficacy efficacy) {
  const Result<double> si = radiant_si(photometric.si, efficacy);
  if (!si) return si.error();
  return Quantity<*radiant_twin(D)>{*si};
}

}  // namespace etendue
