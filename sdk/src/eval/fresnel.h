// Fresnel reflectance: Schlick's approximation, dielectrics and conductors exactly.
#pragma once

#include "etendue/vec.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {

inline double pow5(double x) {
  const double x2 = x * x;
  return x2 * x2 * x;
}

// Schlick 1994: f0 + (f90 - f0) w with w = (1 - cos theta)^5.
inline double schlick_weight(double cosine) { return pow5(std::clamp(1 - cosine, 0.0, 1.0)); }
inline Rgb schlick(const Rgb& f0, double f90, double weight) { return f0 * (1 - weight) + Rgb{f90, f90, f90} * weight; }

// The same weight as a power of 2 (Lagarde's fit, Karis 2013, eq 5): at most .0038 from it, and 1.7e-4 at normal incidence, not 0.
inline double gaussian_schlick_weight(double cosine) {
  const double c = std::clamp(cosine, 0.0, 1.0);
  return std::exp2((-5.55473 * c - 6.98316) * c);
}

// No material reflects less than .02: what is below is meant as occlusion, and takes the grazing reflectance along (Schueler 2009;
// Lagarde and de Rousiers 2014, listing 27, which takes .33 for a third).
inline double occluded_f90(const Rgb& f0) { return std::clamp(50 * 0.33 * (f0.x + f0.y + f0.z), 0.0, 1.0); }

// Reflectances of light that swings across the plane of incidence and in it.
struct Polarised {
  double s, p;
};
// Of a dielectric, eta the index inside over that outside. With c the cosine of incidence and t = eta cos(theta_t) =
// sqrt(eta^2 - 1 + c^2): r_s = (c - t) / (c + t), r_p = (eta^2 c - t) / (eta^2 c + t). From eta < 1 on beyond the critical angle all is
// reflected: t = 0.
inline Polarised dielectric_reflectances(double cosine, double eta) {
  const double eta2 = eta * eta;
  const double t = std::sqrt(std::max(eta2 - 1 + cosine * cosine, 0.0));
  const double s = (cosine - t) / (cosine + t), p = (eta2 * cosine - t) / (eta2 * cosine + t);
  return {s * s, p * p};
}
inline double dielectric_reflectance(double cosine, double eta) {
  const Polarised r = dielectric_reflectances(cosine, eta);
  return 0.5 * (r.s + r.p);
}

// Unpolarised reflectance of an absorbing medium of index eta + i k (Born and Wolf 14.2), with c, s the cosine and sine of incidence:
//   a^2 + b^2 = sqrt((eta^2 - k^2 - s^2)^2 + 4 eta^2 k^2),  2 a^2 = a^2 + b^2 + eta^2 - k^2 - s^2,
//   R_s = (a^2 + b^2 - 2 a c + c^2) / (a^2 + b^2 + 2 a c + c^2),
//   R_p = R_s (c^2 (a^2 + b^2) - 2 a c s^2 + s^4) / (c^2 (a^2 + b^2) + 2 a c s^2 + s^4).
inline double conductor_reflectance(double cosine, double eta, double k) {
  const double c2 = cosine * cosine, s2 = 1 - c2;
  const double t = eta * eta - k * k - s2;
  const double ab2 = std::sqrt(t * t + 4 * eta * eta * k * k);
  const double ac2 = 2 * cosine * std::sqrt(std::max(0.5 * (ab2 + t), 0.0));
  const double rs = (ab2 + c2 - ac2) / (ab2 + c2 + ac2);
  const double rp = rs * (c2 * ab2 + s2 * s2 - ac2 * s2) / (c2 * ab2 + s2 * s2 + ac2 * s2);
  return 0.5 * (rs + rp);
}

}  // namespace etendue::eval
