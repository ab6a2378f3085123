// How the reference by sampling and the adaptive one agree over random lights, points, views and BRDFs.
#pragma once

#include "eval_protocol.h"

#include <cmath>
#include <vector>

namespace etendue::eval::protocol {

inline std::vector<Brdf> every_brdf(double roughness) {
  const double alpha = roughness * roughness;
  return {Lambert{{0.8, 0.5, 0.2}},
          DisneyDiffuse{{0.8, 0.5, 0.2}, roughness},
          FrostbiteDiffuse{{0.8, 0.5, 0.2}, roughness},
          GltfDiffuse{{0.8, 0.5, 0.2}, 1.5},
          OrenNayar{{0.8, 0.5, 0.2}, oren_nayar_sigma_rad(alpha)},
          GotandaDiffuse{{0.8, 0.5, 0.2}, roughness, 0.04},
          GgxLobe{alpha, {1, 1, 1}, 1, Masking::correlated},
          Conductor{{0.2, 0.9, 1.1}, {3.9, 2.4, 2.1}, alpha, Masking::separable},
          Standard{{0.5, 0.2, 0.1}, 0, roughness, 0.5},
          Principled{{0.5, 0.4, 0.3}, 0, roughness, 0.5},
          MetalRough{{0.5, 0.7, 0.9}, 0.5, roughness, 1.5},
          TwoColour{{0.5, 0.3, 0.1}, {0.04, 0.1, 0.3}, roughness}};
}

inline constexpr Kind every_kind[] = {Kind::rect,      Kind::sphere,    Kind::disk, Kind::capsule,
                                      Kind::flat_tube, Kind::open_tube, Kind::star, Kind::line};

struct SampledAgreement {
  std::size_t count = 0;         // of estimates
  std::size_t beyond_error = 0;  // further apart than both errors together
  std::size_t not_numbers = 0;
  std::size_t settled = 0;  // whose heaviest sample adds no more than a standard error: none is rare
  double mean_square = 0;   // of these, of the difference over the standard error
  double square_error = 0;  // standard error of that mean, from how the squares scatter
  double mean_error = 0;    // of all, of the error told over the value
};

// `rounds` lights and views for each BRDF at each of four roughnesses; half of the views see the light's middle mirrored.
inline SampledAgreement agreement(Kind kind, bool above, int rounds, const Sampling& sampling) {
  SampledAgreement a;
  double fourth = 0;
  Random random(700 + 2 * static_cast<std::uint64_t>(kind) + (above ? 1 : 0));
  for (const double roughness : {0.3, 0.5, 0.8, 1.0}) {
    for (const Brdf& brdf : every_brdf(roughness)) {
      for (int i = 0; i < rounds;) {
        const Placement p = place(kind, random, above);
        Vec3d view = p.normal * (2 * dot(p.normal, p.towards)) - p.towards;
        if (i % 2 == 1) view = random.direction();
        if (dot(view, p.normal) < 0.05) continue;
        ++i;
        const ShadingPoint point{p.position, p.normal, p.normal, view, brdf};
        const Estimate exact = reference(p.emitter, point, {1e-6, 0});
        const SampledEstimate sampled = monte_carlo(p.emitter, point, sampling);
        const double wrong = sampled.value.x - exact.value.x;
        ++a.count;
        if (!std::isfinite(wrong) || !std::isfinite(sampled.error().x)) {
          ++a.not_numbers;
          continue;
        }
        a.beyond_error += std::abs(wrong) > sampled.error().x + exact.error.x;
        if (sampled.heaviest.x <= sampled.standard_error.x) {
          const double square = wrong * wrong / (sampled.standard_error.x * sampled.standard_error.x);
          ++a.settled;
          a.mean_square += square;
          fourth += square * square;
        }
        a.mean_error += sampled.error().x / exact.value.x;
      }
    }
  }
  const auto settled = static_cast<double>(a.settled);
  a.mean_square /= settled;
  a.square_error = std::sqrt((fourth / settled - a.mean_square * a.mean_square) / settled);
  a.mean_error /= static_cast<double>(a.count);
  return a;
}

// (value - reference) / standard error follows a t-distribution of 31 degrees of freedom, whose square is 31 / 29 on the mean.
inline constexpr double expected_square = 31.0 / 29;

// How many of n may leave three standard errors: a t-distribution of 31 degrees of freedom does so in .0053 of all cases (two-sided), and
// more than this many happen once in 10^4.
inline std::size_t exceedances(std::size_t n) {
  constexpr double p = 0.0053;
  double term = std::pow(1 - p, static_cast<double>(n)), cumulated = term;
  std::size_t k = 0;
  for (; cumulated < 1 - 1e-4; ++k) {
    term *= static_cast<double>(n - k) / static_cast<double>(k + 1) * p / (1 - p);
    cumulated += term;
  }
  return k;
}

}  // namespace etendue::eval::protocol
