// What the fits of linearly transformed cosines share: the lobe at the nodes of a rule, and the cosines by their unknowns.
#pragma once

#include "etendue/ltc.h"

#include <array>
#include <cmath>
#include <vector>

namespace etendue::eval {

// The lobe of height-correlated GGX over the directions above the horizon on one side of the plane of incidence, with what they stand for:
// a sum over `solid_angle` is an integral over both sides. Visible normals (Heitz 2018) by Gauss's nodes in t, sin^2 t the first number of
// the sample, and by equal steps of its angle over the half of a turn that the plane of incidence does not mirror, 24 of each a panel.
struct LobeDirection {
  Vec3d light;
  double solid_angle, lobe, fresnel_weight;  // 1/sr, of a lobe that mirrors all; Schlick's weight (1 - v.h)^5
};
struct SampledLobe {
  SampledLobe(double alpha, double cosine, int panels);
  double alpha, cosine;
  std::vector<LobeDirection> directions;
  double f0_part = 0, f90_part = 0;  // of the albedo: sums of the lobe times 1 - w and times w
  double albedo() const { return f0_part + f90_part; }
};

// The matrix is M R U: U = (s, 0, k; 0, t, 0; 0, 0, 1) widens the cosine by s within the plane of incidence and t across it, and slants it
// by k; R turns its axis by `angle` from the mirror direction, M puts that in its place. Lengths are counted in alphas.
struct CosineUnknowns {
  enum { angle, log_s, log_t, slant, count };
};
using CosineShape = std::array<double, CosineUnknowns::count>;
inline CosineShape narrow_cosine(double alpha, double cosine) {
  return {0, std::log(2.0), std::log(2.0) + std::log(std::max(cosine, alpha)), 0};
}
// Of (R U)^-1 = (1 / s, 0, -k / s; 0, 1 / t, 0; 0, 0, 1) R^-1 what a node holds.
inline std::array<double, 5> terms_of(const CosineShape& p, double alpha) {
  using U = CosineUnknowns;
  const double s = std::exp(p[U::log_s]), k = alpha * p[U::slant];
  const double c = std::cos(alpha * p[U::angle]), n = std::sin(alpha * p[U::angle]);
  return {(c + k * n) / s, (n - k * c) / s, std::exp(p[U::log_t]), -n, c};
}

// Both parts of the lobe by the same two cosines: of the f0 part the first has the share of_f0, the second the rest, and of_f90 of the
// other.
struct CosinePair {
  CosineShape first, second;
  double of_f0 = 1, of_f90 = 0;
};
// Fitted for reading between the nodes of a table as `axes` has: each starts from what it is given. `one`: the first cosine is all there
// is, and the lobe is that of f0 = 1. Nothing if `progress`, told the share that is done, says false.
enum class Cosines { one, two };
std::optional<std::vector<CosinePair>> fit_between(const LtcTable& axes, const std::vector<CosinePair>& starts, Cosines cosines,
                                                   const std::function<bool(double share_done)>& progress);

}  // namespace etendue::eval
