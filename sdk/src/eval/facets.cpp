#include "facets.h"

#include "microfacet.h"
#include "quadrature.h"

namespace etendue::eval {
namespace {

// x in [lo, hi] at which a rising function is `wanted`: Newton's steps, halving where they leave the bracket.
// f gives its value and its slope.
template <class Function>
double where(const Function& f, double wanted, double lo, double hi) {
  double x = 0.5 * (lo + hi);
  for (int i = 0; i < 100; ++i) {
    const auto [value, slope] = f(x);
    (value < wanted ? lo : hi) = x;
    const double step = (wanted - value) / slope, next = x + step;
    const bool inside = next > lo && next < hi;
    const double to = inside ? next : 0.5 * (lo + hi);
    if (std::abs(to - x) <= 1e-15 * (1 + std::abs(x)) || !(hi > lo)) return to;
    x = to;
  }
  return x;
}

// cos(psi)^power of the squared sine: 1 - sin^2 has too few digits for a power of 1e8.
double cosine_power(double sine2, double power) { return power > 0 ? std::exp(0.5 * power * std::log1p(-std::min(sine2, 1.0))) : 1; }
double cosine_power_at(double psi, double power) {
  const double sine = std::sin(psi);
  return cosine_power(sine * sine, power);
}

// Integral of cos(psi)^power from 0 to psi, |psi| <= pi / 2: a bell of width 1 / sqrt(power), nothing beyond nine of them.
double bell_integral(double psi, double power) {
  const double end = std::min(std::abs(psi), 9 / std::sqrt(power));
  double sum = 0;
  for (const GaussNode& node : gauss24()) sum += node.weight * cosine_power_at(0.5 * end * (1 + node.x), power);
  return std::copysign(0.5 * end * sum, psi);
}

double root_pi() { return std::sqrt(pi); }

}  // namespace

double blinn_phong_exponent(double alpha) {
  const double a = std::clamp(alpha, min_alpha, 1.0);
  return 2 / (a * a) - 2;
}
double alpha_of_blinn_phong(double exponent) { return std::sqrt(2 / (std::max(exponent, 0.0) + 2)); }
double phong_exponent(double alpha) { return 0.25 * blinn_phong_exponent(alpha); }
double alpha_of_phong(double exponent) { return alpha_of_blinn_phong(4 * exponent); }

Facets::Facets(Distribution distribution, double alpha_x, double alpha_y)
    : distribution_(distribution), ax_(std::max(alpha_x, min_alpha)), ay_(std::max(alpha_y, min_alpha)) {
  if (distribution != Distribution::blinn_phong) return;
  exponent_ = blinn_phong_exponent(std::sqrt(ax_ * ay_));
  slope_scale_ = 0.5 / bell_integral(0.5 * pi, exponent_ + 1);
}

double Facets::density(const Vec3d& half) const {
  const double x = half.x / ax_, y = half.y / ay_, z2 = half.z * half.z;
  const double across = half.x * half.x + half.y * half.y, total = across + z2, q2 = x * x + y * y;
  switch (distribution_) {
    case Distribution::ggx: {
      const double d = (q2 + z2) / total;
      return 1 / (pi * ax_ * ay_ * d * d);
    }
    case Distribution::beckmann: {
      const double cos2 = z2 / total;
      if (cos2 < 1e-150) return 0;  // whose square is nothing, and exp(-1e150) even less
      return std::exp(-q2 / z2) / (pi * ax_ * ay_ * cos2 * cos2);
    }
    default:
      return (exponent_ + 2) / (2 * pi) * cosine_power(across / total, exponent_);
  }
}

// Beckmann's, of t = tan^2 and the larger alpha: (1 + t)^2 exp(-t / a^2) rises with t up to 1 + t = 2 a^2.
double Facets::highest_density() const {
  if (distribution_ == Distribution::blinn_phong) return (exponent_ + 2) / (2 * pi);
  const double a2 = std::max(ax_, ay_) * std::max(ax_, ay_), peak = 1 / (pi * ax_ * ay_);
  if (distribution_ == Distribution::beckmann && 2 * a2 > 1) return peak * 4 * a2 * a2 * std::exp(1 / a2 - 2);
  return peak * std::max(1.0, a2 * a2);
}

double Facets::alpha_towards(const Vec3d& v) const {
  const double s = std::hypot(v.x, v.y);
  return distribution_ == Distribution::blinn_phong || !(s > 0) ? std::sqrt(ax_ * ay_) : std::hypot(ax_ * v.x, ay_ * v.y) / s;
}

// With c, s the cosine and sine of the view, p the slope towards it and P1(p) the density of that slope alone,
//   U = integral of P1(p) max(c + s p, 0) dp.
// GGX, Beckmann: p spreads as one of alpha 1 does, times a = sqrt((ax vx)^2 + (ay vy)^2) / s (Heitz 2014, 5.3): U is that of alpha 1 for
// c and a s.   GGX: P1 = 1 / (2 (1 + p^2)^(3/2)), U = (c + sqrt(c^2 + (a s)^2)) / 2.
// Beckmann: P1 = exp(-p^2) / sqrt(pi), U = c (1 + erf(c / (a s))) / 2 + a s exp(-(c / (a s))^2) / (2 sqrt(pi)).
double Facets::seen_area(const Vec3d& v) const {
  const double across = std::hypot(ax_ * v.x, ay_ * v.y);
  switch (distribution_) {
    case Distribution::ggx:
      return 0.5 * (v.z + std::hypot(v.z, across));
    case Distribution::beckmann: {
      if (!(across > 0)) return v.z;
      const double x = v.z / across;
      return 0.5 * v.z * (1 + std::erf(x)) + 0.5 * across * std::exp(-x * x) / root_pi();
    }
    default:
      return power_area(v.z, std::hypot(v.x, v.y));
  }
}

// Blinn-Phong: P1 = C (1 + p^2)^-(n + 3)/2 (the integral of P over the other slope), and with p = tan(psi), psi from -e on, e the
// elevation of the view: U = c (1/2 + integral of C cos^(n + 1) from 0 to e) + s C / (n + 1) cos(e)^(n + 1), cos(e) = s.
double Facets::power_area(double c, double s) const {
  const double n1 = exponent_ + 1;
  return c * (0.5 + slope_scale_ * bell_integral(std::atan2(c, s), n1)) + s * slope_scale_ / n1 * cosine_power(c * c, n1);
}

// The slope towards the view has the density P1(p) (c + s p) / U from -c / s on; the other follows P given p.
Vec2d Facets::seen_gaussian_slope(double c, double s, const Vec2d& u) const {
  constexpr double end = 6.5;  // exp(-end^2) is 5e-19
  const double from = s * end > c ? -c / s : -end;
  const auto seen = [&](double p) { return 0.5 * c * (1 + std::erf(p)) - 0.5 * s * std::exp(-p * p) / root_pi(); };
  const double first = seen(from), all = seen(end) - first;
  const auto running = [&](double p) { return std::pair{seen(p) - first, std::exp(-p * p) / root_pi() * (c + s * p)}; };
  const auto normal = [](double p) { return std::pair{0.5 * (1 + std::erf(p)), std::exp(-p * p) / root_pi()}; };
  return {where(running, u.x * all, from, end), where(normal, u.y, -end, end)};
}

Vec2d Facets::seen_power_slope(double c, double s, const Vec2d& u) const {
  const double n1 = exponent_ + 1, n2 = exponent_ + 2;
  const double from = std::max(-std::atan2(c, s), -9 / std::sqrt(n1)), end = std::min(0.5 * pi, 9 / std::sqrt(n1));
  const auto seen = [&](double psi) { return c * bell_integral(psi, n1) - s / n1 * cosine_power_at(psi, n1); };
  const double first = seen(from), all = seen(end) - first;
  const auto running = [&](double psi) { return std::pair{seen(psi) - first, cosine_power_at(psi, n1) * (c + s * std::tan(psi))}; };
  const double p = std::tan(where(running, u.x * all, from, end));
  // P(p, p') for a fixed p: p' = sqrt(1 + p^2) tan(chi), chi spread like cos^(n + 2).
  const double half = bell_integral(end, n2);
  const auto bell = [&](double chi) { return std::pair{bell_integral(chi, n2), cosine_power_at(chi, n2)}; };
  return {p, std::sqrt(1 + p * p) * std::tan(where(bell, (2 * u.y - 1) * half, -end, end))};
}

Vec3d Facets::seen_normal(const Vec3d& view, const Vec2d& u) const {
  if (distribution_ == Distribution::ggx) return sample_seen_ggx(ax_, ay_, view, u);
  const bool gaussian = distribution_ == Distribution::beckmann;
  const double ax = gaussian ? ax_ : 1, ay = gaussian ? ay_ : 1;
  const Vec3d v = normalised(Vec3d{ax * view.x, ay * view.y, view.z});
  const double s = std::hypot(v.x, v.y);
  const Vec2d ahead = s > 0 ? Vec2d{v.x / s, v.y / s} : Vec2d{1, 0};
  const Vec2d p = gaussian ? seen_gaussian_slope(v.z, s, u) : seen_power_slope(v.z, s, u);
  return normalised(Vec3d{ax * (ahead.x * p.x - ahead.y * p.y), ay * (ahead.y * p.x + ahead.x * p.y), 1});
}

}  // namespace etendue::eval
