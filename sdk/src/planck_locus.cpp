#include "planck_locus.h"

#include <cmath>
#include <iterator>

namespace etendue {
namespace {

constexpr Vec3d bars[] = {
#include "cie1931.inc"
};
static_assert(std::size(bars) == wavelength_count);

// f(y) = y / (e^y - 1) with its derivatives f' = f g, g = (1 - f - y) / y, and f'' = f' g + f g', g' = -(f' + 1 + g) / y. Where y is small
// these cancel, and the series 1 - y/2 + y^2/12 - y^4/720 + y^6/30240 takes their place: its next term is y^8/1209600, 1e-18 of f at y = .1
// and 1e-13 of the second derivative, which only steers an iteration.
struct Bose {
  double f, first, second;
};
Bose bose(double y) {
  if (y < 0.1) {
    const double s = y * y;
    return {1 - y / 2 + s / 12 * (1 - s / 60 * (1 - s / 42)), -0.5 + y / 6 * (1 - s / 30 * (1 - s / 28)),
            1.0 / 6 * (1 - s / 10 * (1 - s * 5 / 84))};
  }
  const double f = y / std::expm1(y);
  const double g = (1 - f - y) / y;
  const double first = f * g;
  return {f, first, first * g - f * (first + 1 + g) / y};
}

}  // namespace

const Vec3d& colour_matching(int nm) { return bars[nm - first_nm]; }

// Planck's spectrum, lambda^-5 / (exp(c2 M / lambda) - 1), is (c2 M)^-1 lambda^-4 f(a M) with a = c2 / lambda; the factor in front is the
// same at all wavelengths, and chromaticity does not see it. X, Y, Z and their derivatives by M are then sums of f, f' a, f'' a^2. With N =
// (4X, 6Y) and D = X + 15Y + 3Z: uv = N/D, uv' = (N' - uv D')/D, uv'' = (N'' - 2 uv' D' - uv D'')/D.
LocusPoint planck_locus(double reciprocal_K) {
  Vec3d xyz, xyz1, xyz2;
  for (int i = 0; i < wavelength_count; ++i) {
    const double micrometres = (first_nm + i) * 1e-3;
    const double squared = micrometres * micrometres;
    const double a = c2_m_K * 1e6 / micrometres;
    const Bose f = bose(a * reciprocal_K);
    const Vec3d weighted = bars[i] / (squared * squared);
    xyz += weighted * f.f;
    xyz1 += weighted * (f.first * a);
    xyz2 += weighted * (f.second * a * a);
  }
  const Vec3d to_denominator{1, 15, 3};
  const double d = dot(xyz, to_denominator), d1 = dot(xyz1, to_denominator), d2 = dot(xyz2, to_denominator);
  const Vec2d uv{4 * xyz.x / d, 6 * xyz.y / d};
  const Vec2d first{(4 * xyz1.x - uv.x * d1) / d, (6 * xyz1.y - uv.y * d1) / d};
  const Vec2d second{(4 * xyz2.x - 2 * first.x * d1 - uv.x * d2) / d, (6 * xyz2.y - 2 * first.y * d1 - uv.y * d2) / d};
  return {uv, first, second};
}

}  // namespace etendue
