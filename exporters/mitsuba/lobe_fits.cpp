#include "lobe_fits.h"

#include "etendue/units.h"
#include "etendue/unshown.h"

#include <algorithm>
#include <cmath>

namespace etendue::mitsuba {
namespace {

constexpr double narrowest_coat = 0.001, widest_coat = 0.1;

double power_5(double x) { return x * x * x * x * x; }

// Mean over a white sky of what leaves: (1 / pi) double integral of f cos(light) cos(view), which is
// 2 integral of f mu_light mu_view d mu_light d mu_view d phi. `lobe` gives f mu_light mu_view. Midpoint rule.
template <class Lobe>
double sky_albedo(const Lobe& lobe) {
  constexpr int steps = 48;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double view = (i + 0.5) / steps, view_sine = std::sqrt(1 - view * view);
    for (int j = 0; j < steps; ++j) {
      const double light = (j + 0.5) / steps, light_sine = std::sqrt(1 - light * light);
      for (int k = 0; k < steps; ++k) {
        const double cosine = view * light + view_sine * light_sine * std::cos(pi * (k + 0.5) / steps);
        // |v + l| = 2 cos(half, light).
        const double half_length = std::sqrt(2 + 2 * cosine);
        sum += lobe(view, light, half_length / 2, (view + light) / half_length);
      }
    }
  }
  // The azimuth's other half is the same.
  return 2 * 2 * pi * sum / (static_cast<double>(steps) * steps * steps);
}

// Estevez and Kulla's fit of the cloth's shadowing: exp(L) with L = a / (1 + b x^c) + d x + e, mirrored at .5.
double cloth_lambda(double cosine, double alpha) {
  const double t = (1 - alpha) * (1 - alpha);
  const auto mixed = [t](double at_1, double at_0) { return at_1 + t * (at_0 - at_1); };
  const double a = mixed(21.5473, 25.3245), b = mixed(3.82987, 3.32435), c = mixed(0.19823, 0.16801), d = mixed(-1.97760, -1.27393),
               e = mixed(-4.32054, -4.85967);
  const auto fit = [&](double x) { return a / (1 + b * std::pow(x, c)) + d * x + e; };
  return cosine < 0.5 ? std::exp(fit(cosine)) : std::exp(2 * fit(0.5) - fit(1 - cosine));
}

}  // namespace

// (1 - a^2) / (-a^2 ln a^2), which falls with a.
double coat_peak(double width) { return (1 - width * width) / (-width * width * std::log(width * width)); }

double coat_width(double ggx_alpha) {
  const double wanted = 1 / std::max(ggx_alpha * ggx_alpha, 1e-12);
  double low = narrowest_coat, high = widest_coat;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (coat_peak(middle) > wanted ? low : high) = middle;
  }
  return (low + high) / 2;
}

// Half vectors h are chosen by D cos: cos^2 = (1 - a^(2 (1 - u))) / (1 - a^2) (Burley 2012, B.2). With d light = 4 (v.h) dh the reflected
// share of a view is the mean of F G cos(light) (v.h) / cos(h) over them.
double principled_coat_albedo(double a) {
  constexpr int steps = 48;
  // Smith's G1 with alpha = .25.
  const auto passed = [](double cosine) { return 2 / (1 + std::sqrt(1 + 0.0625 * (1 / (cosine * cosine) - 1))); };
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double view = (i + 0.5) / steps, view_sine = std::sqrt(1 - view * view);
    for (int j = 0; j < steps; ++j) {
      const double square = (1 - std::pow(a, 2 * (1 - (j + 0.5) / steps))) / (1 - a * a);
      const double half = std::sqrt(square), half_sine = std::sqrt(1 - square);
      for (int k = 0; k < steps; ++k) {
        const double cosine = view * half + view_sine * half_sine * std::cos(pi * (k + 0.5) / steps);
        const double light = 2 * cosine * half - view;
        if (cosine <= 0 || light <= 0) continue;
        const double fresnel = 0.04 + 0.96 * power_5(1 - cosine);
        sum += 2 * view * fresnel * passed(view) * passed(light) * light * cosine / half;
      }
    }
  }
  return sum / (static_cast<double>(steps) * steps * steps);
}

double principled_sheen_albedo() {
  return sky_albedo([](double view, double light, double half_light, double) { return power_5(1 - half_light) * view * light; });
}

double cloth_albedo(double roughness) {
  // Narrower cloth than alpha = .005 reflects at the very rim alone.
  const double alpha = std::max(roughness * roughness, 5e-3);
  return sky_albedo([alpha](double view, double light, double, double half_normal) {
    const double sine = std::sqrt(std::max(0.0, 1 - half_normal * half_normal));
    const double density = (2 + 1 / alpha) * std::pow(sine, 1 / alpha) / (2 * pi);
    return density / (4 * (1 + cloth_lambda(view, alpha) + cloth_lambda(light, alpha)));
  });
}

}  // namespace etendue::mitsuba
