// GGX microfacets in the shading frame (z is the normal): density, masking, and the choice of a visible normal.
#pragma once

#include "etendue/material.h"
#include "etendue/units.h"
#include "etendue/vec.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {

// Half vector h = (v + l) / |v + l| in what the lobes need of it. The sine of (n, h) comes from the components across the normal,
// because 1 - cos^2 has no correct digit left where alpha is 1e-4.
struct HalfAngle {
  double cos2, sin2;  // of the angle between normal and h
  double v_dot_h;     // = |v + l| / 2
};
inline HalfAngle half_angle(const Vec3d& view, const Vec3d& light) {
  const Vec3d sum = view + light;
  const double across = sum.x * sum.x + sum.y * sum.y, along = sum.z * sum.z, total = across + along;
  return {along / total, across / total, 0.5 * std::sqrt(total)};
}

// Smallest alpha that is evaluated: below it a surface is a mirror and has no BRDF (Mitsuba's microfacet distribution clamps here too).
inline constexpr double min_alpha = 1e-4;

// Karis 2013, eq 4: for lights that have a place (roughness + 1)^2 / 8, with roughness^2 = alpha; for pictures alpha / 2. 0: not his.
inline double schlick_masking_k(Masking masking, double alpha) {
  const double r1 = std::sqrt(alpha) + 1;
  return masking == Masking::schlick_direct ? r1 * r1 / 8 : masking == Masking::schlick_image ? alpha / 2 : 0;
}
// x / G1(x).
inline double schlick_seen_area(double x, double k) { return x * (1 - k) + k; }

// The specular lobe for one view direction, without Fresnel.
//   D = alpha^2 / (pi (alpha^2 cos^2 + sin^2)^2)           of the half angle (Walter et al. 2007, eq 33)
//   S(x) = sqrt(x^2 + alpha^2 (1 - x^2)), x a cosine;  Smith's G1(x) = 2 x / (x + S(x))
//   separable:  G1(v) G1(l) / (4 n.v n.l)        = 1 / ((n.v + S(n.v)) (n.l + S(n.l)))
//   correlated: G2(v, l) / (4 n.v n.l)           = 1 / (2 (n.l S(n.v) + n.v S(n.l)))   (Heitz 2014, eq 99)
//   Schlick's form: G1(x) = x / K(x), K(x) = x (1 - k) + k: 1 / (4 K(n.v) K(n.l))
class GgxView {
 public:
  GgxView(double alpha, Masking masking, const Vec3d& view)
      : alpha2_(std::max(alpha, min_alpha) * std::max(alpha, min_alpha)),
        nv_(view.z),
        sv_(root(view.z)),
        k_(schlick_masking_k(masking, std::max(alpha, min_alpha))),
        masking_(masking) {}

  double density(const HalfAngle& h) const {
    const double d = alpha2_ * h.cos2 + h.sin2;
    return alpha2_ / (pi * d * d);
  }
  // G / (4 n.v n.l).
  double masked(double nl) const {
    switch (masking_) {
      case Masking::correlated:
        return 1 / (2 * (nl * sv_ + nv_ * root(nl)));
      case Masking::separable:
        return 1 / ((nv_ + sv_) * (nl + root(nl)));
      default:
        return 1 / (4 * schlick_seen_area(nv_, k_) * schlick_seen_area(nl, k_));
    }
  }
  // D G / (4 n.v n.l) times n.l.
  double operator()(const HalfAngle& h, double nl) const { return density(h) * nl * masked(nl); }
  // Density of the light directions that follow from visible normals: G1(v) D / (4 n.v).
  double pdf(const HalfAngle& h) const { return density(h) / (2 * (nv_ + sv_)); }
  double highest_pdf() const { return pdf({1, 0, 1}); }

 private:
  double root(double x) const { return std::sqrt(x * x + alpha2_ * (1 - x * x)); }

  double alpha2_, nv_, sv_, k_;
  Masking masking_;
};

// With the density cos / pi.
inline Vec3d cosine_direction(const Vec2d& u) {
  const double r = std::sqrt(u.x), phi = 2 * pi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(1 - u.x, 0.0))};
}

// Normal of a facet as seen from `view`, with density G1(v) max(v.h, 0) D(h) / n.v: Heitz 2018, Sampling the GGX Distribution of
// Visible Normals. The surface is stretched by 1 / alpha to a hemisphere, whose projection onto the plane across the view is sampled.
inline Vec3d sample_seen_ggx(double alpha_x, double alpha_y, const Vec3d& view, const Vec2d& u) {
  const double ax = std::max(alpha_x, min_alpha), ay = std::max(alpha_y, min_alpha);
  const Vec3d v = normalised(Vec3d{ax * view.x, ay * view.y, view.z});
  const double across = v.x * v.x + v.y * v.y;
  const Vec3d t1 = across > 0 ? Vec3d{-v.y, v.x, 0} / std::sqrt(across) : Vec3d{1, 0, 0};
  const Vec3d t2 = cross(v, t1);
  const double r = std::sqrt(u.x), phi = 2 * pi * u.y;
  const double p1 = r * std::cos(phi);
  const double s = 0.5 * (1 + v.z);
  const double p2 = (1 - s) * std::sqrt(std::max(1 - p1 * p1, 0.0)) + s * r * std::sin(phi);
  const Vec3d h = t1 * p1 + t2 * p2 + v * std::sqrt(std::max(1 - p1 * p1 - p2 * p2, 0.0));
  return normalised(Vec3d{ax * h.x, ay * h.y, std::max(h.z, 1e-300)});
}

}  // namespace etendue::eval
