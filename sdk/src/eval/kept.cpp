// What a window leaves, as integrals over the squared distance q.
#include "window_part.h"

#include "quadrature.h"

#include <algorithm>
#include <cmath>

namespace etendue::eval {
namespace {

using Law = Falloff::Law;

// Integral of d^(k - 3) from d0 to d1 = d0 exp(log), log >= 0.
double power_integral(double k, double d0, double d1, double log) {
  if (k == 2) return log;
  return k > 2 ? -std::pow(d1, k - 2) * std::expm1((2 - k) * log) / (k - 2) : std::pow(d0, k - 2) * std::expm1((k - 2) * log) / (k - 2);
}

// Half the integral of 1 / (q (q + s)) from q0 to q1.
double soft_integral(double q0, double q1, double s) { return std::log1p((q1 - q0) / q0 * (s / (q1 + s))) / (2 * s); }

// Half the integral of (2 q - q^3) / (q + s) from q0 to q1 <= 1. Divided it is a polynomial and a logarithm, which cancel for large s,
// where the integrand's pole is far.
double soft_loss(double q0, double q1, double s) {
  const double span = q1 - q0;
  if (s <= 1) {
    const double thirds = (q0 * q0 + q0 * q1 + q1 * q1) / 3, halves = 0.5 * (q0 + q1);
    return 0.5 * (span * (2 - s * s + s * halves - thirds) - s * (2 - s * s) * std::log1p(span / (q0 + s)));
  }
  double sum = 0;
  for (const KronrodNode& node : kronrod15().nodes) {
    const double q = 0.5 * (q0 + q1) + 0.5 * span * node.x;
    sum += node.weight * q * (2 - q * q) / (q + s);
  }
  return 0.25 * span * sum;
}

}  // namespace

Kept::Kept(const Window& window)
    : unit_m(window.range_m > 0 ? window.range_m : 1), falloff_(window.falloff), endless_(!(window.range_m > 0)) {
  if (falloff_.law == Law::scale_bias) gain_ = unit_m > 1 ? 1 / (1 - 1 / (unit_m * unit_m)) : 0;
  if (falloff_.law == Law::karis) soft2_ = std::clamp(1 / (unit_m * unit_m), 1e-300, 1e300);
}

double Kept::at(double d2) const { return window_at({falloff_, endless_ ? 0 : unit_m}, std::sqrt(d2) * unit_m); }

double Kept::steepest() const {
  switch (falloff_.law) {
    case Law::power:
      return falloff_.exponent;
    case Law::power_squared:
      return 2 * falloff_.exponent;
    case Law::karis:
      return 8;
    default:
      return 3;
  }
}

// w is a sum of powers of d; Karis' of (1 - q^2)^2 q / (q + s) = q / (q + s) - q^2 (2 q - q^3) / (q + s).
double Kept::spread(double h2, double rho2) const {
  const double step = std::max(rho2, 1e-30 * h2), q = h2 + step, log = 0.5 * std::log1p(step / h2);
  const double h = std::sqrt(h2), d = std::sqrt(q), all = 0.5 / (h2 * q);
  const auto power = [&](double k) { return power_integral(k, h, d, log) / step; };
  const double n = falloff_.exponent;
  switch (falloff_.law) {
    case Law::power:
      return all - power(n);
    case Law::power_squared:
      return all - 2 * power(n) + power(2 * n);
    case Law::smoothstep:
      return all - 3 * power(2) + 2 * power(3);
    case Law::scale_bias:
      return gain_ * (all - power(2));
    case Law::karis:
      return (soft_integral(h2, q, soft2_) - (endless_ ? 0 : soft_loss(h2, q, soft2_))) / step;
    case Law::inverse_square:
      break;
  }
  return all;
}

double Kept::beyond(double q) const {
  if (endless_) return std::log1p(soft2_ / q) / (2 * soft2_);
  if (!(q < 1)) return 0;
  const double d = std::sqrt(q), log = -0.5 * std::log(q), all = 0.5 * (1 - q) / q;
  const auto power = [&](double k) { return power_integral(k, d, 1, log); };
  const double n = falloff_.exponent;
  switch (falloff_.law) {
    case Law::power:
      return all - power(n);
    case Law::power_squared:
      return all - 2 * power(n) + power(2 * n);
    case Law::smoothstep:
      return all - 3 * power(2) + 2 * power(3);
    case Law::scale_bias:
      return gain_ * (all - power(2));
    case Law::karis:
      return soft_integral(q, 1, soft2_) - soft_loss(q, 1, soft2_);
    case Law::inverse_square:
      break;
  }
  return all;
}

}  // namespace etendue::eval
