#include "etendue/probe.h"

#include "microfacet.h"

#include <cmath>
#include <cstdint>

namespace etendue::eval {
namespace {

// Bits in reverse order behind the point.
double van_der_corput(std::uint32_t i) {
  double value = 0, digit = 0.5;
  for (; i != 0; i >>= 1, digit *= 0.5) value += (i & 1) != 0 ? digit : 0;
  return value;
}

// Sum of weight times light over the sum of weights; light(l, n.h), l in the world.
template <class Light>
Rgb mean_over_lobe(const Vec3d& r, double alpha, unsigned samples, const Light& light) {
  const Basis frame = basis_around(r);
  const double a2 = std::max(alpha, min_alpha) * std::max(alpha, min_alpha);
  Rgb sum;
  double weights = 0;
  for (unsigned i = 0; i < samples; ++i) {
    const double phi = 2 * pi * (i + 0.5) / samples, u = van_der_corput(i);
    // The half vector's density is D n.h: n.h^2 = (1 - u) / (1 + (alpha^2 - 1) u).
    const double cos2 = (1 - u) / (1 + (a2 - 1) * u), cosine = std::sqrt(cos2), sine = std::sqrt(std::max(1 - cos2, 0.0));
    const Vec3d h = frame.tangent * (sine * std::cos(phi)) + frame.bitangent * (sine * std::sin(phi)) + r * cosine;
    const Vec3d l = h * (2 * cosine) - r;
    const double n_dot_l = dot(r, l);
    if (!(n_dot_l > 0)) continue;
    sum += light(l, cosine) * n_dot_l;
    weights += n_dot_l;
  }
  return weights > 0 ? sum / weights : Rgb{};
}

}  // namespace

Rgb prefiltered_karis(const FilteredRadiance& radiance, const Vec3d& r, double alpha, unsigned samples) {
  return mean_over_lobe(r, alpha, samples, [&](const Vec3d& l, double) { return radiance(l, 0); });
}

Rgb prefiltered_frostbite(const FilteredRadiance& radiance, const Vec3d& r, double alpha, unsigned samples, double texel_sr,
                          double last_level) {
  const double a2 = std::max(alpha, min_alpha) * std::max(alpha, min_alpha);
  return mean_over_lobe(r, alpha, samples, [&](const Vec3d& l, double n_dot_h) {
    // 1 + (alpha^2 - 1) c^2 without the difference of almost equal numbers: (l - r)^2 = 4 (1 - c^2).
    const Vec3d apart = l - r;
    const double sin2 = std::min(0.25 * dot(apart, apart), 1.0), d = sin2 + a2 * n_dot_h * n_dot_h;
    const double pdf = a2 / (pi * d * d) / 4;
    return radiance(l, std::clamp(0.5 * std::log2(1 / (samples * pdf * texel_sr)), 0.0, std::max(last_level, 0.0)));
  });
}

}  // namespace etendue::eval
