// Diffuse albedo and f0 apart, glTF's specular-glossiness, and Mitsuba's nearest model.
#include "etendue/material.h"

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

double largest(const Rgb& c) { return std::max({c.x, c.y, c.z}); }

// For a given metallic m the residuals are ((1 - m) b - d)^2 + (k + m b - f)^2 in each channel, with the base colour b in [0, 1] of the
// channel and the dielectric part k = .08 specular (1 - m) in common.
struct AtMetallic {
  const TwoColour& target;
  double m;
  // The best b of a channel, by the derivative in b.
  double base(int channel, double k) const {
    const double d = target.diffuse[channel], f = target.f0[channel];
    return std::clamp(((1 - m) * d + m * (f - k)) / ((1 - m) * (1 - m) + m * m), 0.0, 1.0);
  }
  double residual(double k) const {
    double sum = 0;
    for (int c = 0; c < 3; ++c) {
      const double b = base(c, k), diffuse = (1 - m) * b - target.diffuse[c], f0 = k + m * b - target.f0[c];
      sum += diffuse * diffuse + f0 * f0;
    }
    return sum;
  }
};

// Where a function of one valley is least, to the width over phi^steps.
template <class Function>
double valley(double low, double high, int steps, Function f) {
  const double ratio = (std::sqrt(5.0) - 1) / 2;
  double a = high - ratio * (high - low), b = low + ratio * (high - low), fa = f(a), fb = f(b);
  for (int i = 0; i < steps; ++i) {
    if (fa <= fb) {
      high = b, b = a, fb = fa, a = high - ratio * (high - low), fa = f(a);
    } else {
      low = a, a = b, fa = fb, b = low + ratio * (high - low), fb = f(b);
    }
  }
  return (low + high) / 2;
}

// Mitsuba's index of refraction is infinite at F0 = 1.
constexpr double largest_f0 = 0.999;

// The residual is convex in (b, k), and so what is left of it in k alone is: it has one valley. Its ends are tried as well, since the
// search only comes near them.
double best_dielectric(const AtMetallic& at) {
  const double top = largest_f0 * (1 - at.m);
  const auto residual = [&at](double k) { return at.residual(k); };
  double best = valley(0, top, 60, residual);
  for (const double end : {0.0, top})
    if (residual(end) <= residual(best)) best = end;
  return best;
}

}  // namespace

TwoColour two_colour_of(const SpecularGlossiness& m) {
  return {m.diffuse * (1 - std::clamp(largest(m.specular), 0.0, 1.0)), m.specular, 1 - m.glossiness};
}

SpecularGlossiness specular_glossiness_of(const TwoColour& m) {
  SpecularGlossiness out{{0, 0, 0}, m.f0, 1 - m.roughness};
  const double left = 1 - largest(m.f0);
  for (int c = 0; c < 3; ++c) out.diffuse[c] = m.diffuse[c] <= 0 ? 0 : left > m.diffuse[c] ? m.diffuse[c] / left : 1;
  return out;
}

Principled fit_principled(const TwoColour& target) {
  // In m there may be several valleys: every step of a grid is tried, then the neighbourhood of the best. Both ends come first, so that a
  // grey dielectric and a metal stay what they are.
  const auto cost = [&target](double m) {
    const AtMetallic at{target, m};
    return at.residual(best_dielectric(at));
  };
  constexpr int steps = 64;
  double best = 0, least = cost(0);
  const auto consider = [&](double m) {
    if (const double c = cost(m); c < least - 1e-15) best = m, least = c;
  };
  consider(1);
  for (int i = 1; i < steps; ++i) consider(static_cast<double>(i) / steps);
  if (best > 0 && best < 1) consider(valley(best - 1.0 / steps, best + 1.0 / steps, 40, cost));

  const AtMetallic at{target, best};
  const double k = best_dielectric(at);
  Principled out;
  out.base_colour = {at.base(0, k), at.base(1, k), at.base(2, k)};
  out.metallic = best;
  out.roughness = target.roughness;
  // A metal without a dielectric part is black in Mitsuba (issue 443): it gets an F0 of 8e-6.
  out.specular = best < 1 ? k / (1 - best) / 0.08 : 0;
  if (best > 0) out.specular = std::max(out.specular, 1e-4);
  return out;
}

}  // namespace etendue
