// Sums, multiples and quotients of quantities, where they have a meaning; the others do not compile.
//   Flux lit = 3 * lumens(800) + lumens(450);   double times = metres(3) / metres(2);
//   Flux lamp = watts(60) * lumens_per_watt(15);   Quantity<Dimension::stop> apart = ev - other_ev;
#pragma once

#include "etendue/light_units.h"

namespace etendue {

// An exposure value is a logarithm: it takes stops, and its difference is in stops, but it has no multiples and no sum.
template <Dimension D>
concept Logarithmic = D == Dimension::exposure_value || D == Dimension::exposure_value_s;
template <Dimension D>
concept Linear = !Logarithmic<D>;

template <Dimension D>
requires Linear<D>
constexpr Quantity<D> operator+(Quantity<D> a, Quantity<D> b) { return {a.si + b.si}; }
template <Dimension D>
requires Linear<D>
constexpr Quantity<D> operator-(Quantity<D> a, Quantity<D> b) { return {a.si - b.si}; }
template <Dimension D>
requires Linear<D>
constexpr Quantity<D> operator-(Quantity<D> a) { return {-a.si}; }
template <Dimension D>
requires Linear<D>
constexpr Quantity<D> operator*(double times, Quantity<D> q) { return {times * q.si}; }
template <Dimension D>
requires Linear<D>
constexpr Quantity<D> operator*(Quantity<D> q, double times) { return {q.si * times}; }
template <Dimension D>
requires Linear<D>
constexpr Quantity<D> operator/(Quantity<D> q, double over) { return {q.si / over}; }
template <Dimension D>
requires Linear<D>
constexpr double operator/(Quantity<D> a, Quantity<D> b) { return a.si / b.si; }

template <Dimension D>
requires Logarithmic<D>
constexpr Quantity<D> operator+(Quantity<D> ev, Quantity<Dimension::stop> by) { return {ev.si + by.si}; }
template <Dimension D>
requires Logarithmic<D>
constexpr Quantity<D> operator-(Quantity<D> ev, Quantity<Dimension::stop> by) { return {ev.si - by.si}; }
template <Dimension D>
requires Logarithmic<D>
constexpr Quantity<Dimension::stop> operator-(Quantity<D> a, Quantity<D> b) { return {a.si - b.si}; }

// Watts of any kind times lm/W are what they are of light; an even intensity times its solid angle is a flux.
template <Dimension Radiant>
requires(photometric_twin(Radiant).has_value()) constexpr Quantity<*photometric_twin(Radiant)> operator*(Quantity<Radiant> radiant,
                                                                                                         Efficacy efficacy) {
  return {radiant.si * efficacy.si};
}
constexpr Efficacy operator/(Flux flux, RadiantFlux radiant) { return {flux.si / radiant.si}; }
constexpr Flux operator*(Intensity intensity, SolidAngle solid_angle) { return {intensity.si * solid_angle.si}; }
constexpr Intensity operator/(Flux flux, SolidAngle solid_angle) { return {flux.si / solid_angle.si}; }

}  // namespace etendue
