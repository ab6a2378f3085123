// The globally best Disney parameters of a diffuse albedo and an f0.
//
// At the optimum each base colour is at 0, free or at 1, and k at its lowest, free or at its highest: one of 81 cases. In each the
// residual, minimised over what is free, is a rational function P/Q of m, and the optimum is a root of its derivative or an end of [0, 1].
// So the roots of all P'Q - PQ' hold the optimum's metal mask among them. Cases are left out whose bound colours alone cost more than the
// best so far.
#include "etendue/material_fit.h"

#include "metal_profile.h"
#include "polynomial.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue {
namespace {

enum class Base { zero, free, one };
using Bases = std::array<Base, 3>;
using Channel = MetalProfile::Channel;

double square(double x) { return x * x; }
// From x to the nearest point of [low, high].
double distance(double x, double low, double high) { return x < low ? low - x : x > high ? x - high : 0; }

// What two residuals may differ by and count as equal: an rms of 4e-10, and rounding.
double tie(double residual) { return 1e-18 + 1e-14 * residual; }

// P / Q.
struct Rational {
  Polynomial p, q;
  double operator()(double m) const { return p(m) / q(m); }
  Polynomial slope_numerator() const { return p.derivative() * q - p * q.derivative(); }
};

constexpr Polynomial s = Polynomial::linear(1, -1), m1 = Polynomial::linear(0, 1), n = Polynomial::quadratic(1, -2, 2);

// k = kappa s. A free channel leaves (m d - s (f - k))^2 / n, its distance from the line through (s, m), n = s^2 + m^2.
Rational bound_case(const std::array<Channel, 3>& channels, const Bases& bases, double kappa) {
  Polynomial free, bound;
  for (std::size_t i = 0; i < 3; ++i) {
    const Channel c = channels[i];
    const Polynomial f0 = s * kappa - Polynomial::constant(c.f);  // of k - f
    if (bases[i] == Base::free) {
      const Polynomial off = m1 * c.d + s * f0;
      free = free + off * off;
    } else {
      const Polynomial diffuse = bases[i] == Base::one ? s - Polynomial::constant(c.d) : Polynomial::constant(c.d);
      const Polynomial specular = bases[i] == Base::one ? f0 + m1 : f0;
      bound = bound + diffuse * diffuse + specular * specular;
    }
  }
  return {free + n * bound, n};
}

// k free: the sum is A k^2 - 2 B k + C with A = a/n, B = b/n, C = c/n, which leaves C - B^2/A = (c a - b^2) / (n a).
Rational free_case(const std::array<Channel, 3>& channels, const Bases& bases) {
  Polynomial a, b, c;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [d, f] = channels[i];
    if (bases[i] == Base::free) {
      const Polynomial off = m1 * d - s * f;
      a = a + s * s, b = b - s * off, c = c + off * off;
    } else {
      const bool one = bases[i] == Base::one;
      const Polynomial diffuse = one ? s - Polynomial::constant(d) : Polynomial::constant(d);
      const Polynomial specular = one ? m1 - Polynomial::constant(f) : Polynomial::constant(-f);
      a = a + n, b = b - n * specular, c = c + n * (diffuse * diffuse + specular * specular);
    }
  }
  return {c * a - b * b, n * a};
}

// Every base free and k as well: the sum of (m d' - s f')^2 / n over the deviations d', f' of the channels from their means. With m : s =
// sin t : cos t it is D sin^2 t - 2 X sin t cos t + F cos^2 t, a Rayleigh quotient of the covariance of (d, f), least at
// 2 t = atan2(2 X, D - F), or at an end where that is not within [0, pi].
class FreeOptimum {
 public:
  explicit FreeOptimum(const std::array<Channel, 3>& channels) {
    double mean_d = 0, mean_f = 0;
    for (const Channel& c : channels) mean_d += c.d / 3, mean_f += c.f / 3;
    for (const Channel& c : channels) dd_ += square(c.d - mean_d), df_ += (c.d - mean_d) * (c.f - mean_f), ff_ += square(c.f - mean_f);
  }
  double metal() const {
    if (df_ <= 0) return dd_ < ff_ ? 1 : 0;
    const double t = std::atan2(2 * df_, dd_ - ff_) / 2;
    return std::sin(t) / (std::sin(t) + std::cos(t));
  }
  double residual(double m) const { return (dd_ * m * m - 2 * df_ * m * (1 - m) + ff_ * square(1 - m)) / (square(1 - m) + m * m); }

 private:
  double dd_ = 0, df_ = 0, ff_ = 0;
};

class Search {
 public:
  explicit Search(const MetalProfile& profile) : profile_(profile), best_(profile(0)) { consider(1); }

  void consider(double m) {
    const MetalProfile::Point point = profile_(m);
    if (point.residual < best_.residual - tie(best_.residual)) best_ = point;
  }
  // The stationary points of a case. What it leaves at the optimum is the optimum's residual: other points need no closer look.
  void consider(const Rational& one) {
    for (const double m : sign_changes(one.slope_numerator()))
      if (!(one(m) > best_.residual + tie(best_.residual))) consider(m);
  }
  // Good points to measure the cases by: the best of a grid, and around it.
  void look_around() {
    constexpr int steps = 16;
    for (int i = 1; i < steps; ++i) consider(static_cast<double>(i) / steps);
    double width = 0.5 / steps;
    for (int halving = 0; halving < 8; ++halving, width /= 2) {
      const double at = best_.m;
      consider(std::max(at - width, 0.0));
      consider(std::min(at + width, 1.0));
    }
  }
  void every_case() {
    const auto& channels = profile_.channels();
    const double low = profile_.lowest(), high = profile_.highest();
    for (int code = 0; code < 27; ++code) {
      const Bases bases{static_cast<Base>(code % 3), static_cast<Base>(code / 3 % 3), static_cast<Base>(code / 9)};
      double cost = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto [d, f] = channels[i];
        if (bases[i] == Base::zero) cost += d * d + square(distance(f, 0, high));
        // (s, m + k) is on a line x + y = 1 + k.
        if (bases[i] == Base::one) cost += square(distance(d + f, 1, 1 + high)) / 2;
      }
      if (cost > best_.residual) continue;
      consider(bound_case(channels, bases, low));
      if (low == high) continue;
      consider(bound_case(channels, bases, high));
      if (code != free_code) consider(free_case(channels, bases));
    }
  }

  MetalProfile::Point best() const { return best_; }

 private:
  static constexpr int free_code = 1 + 3 + 9;  // has FreeOptimum

  const MetalProfile& profile_;
  MetalProfile::Point best_;
};

MetalProfile::Point global_optimum(const MetalProfile& profile) {
  Search search(profile);
  if (profile.lowest() == profile.highest()) {
    search.look_around();
    search.every_case();
    return search.best();
  }
  // Without the bounds the residual is nowhere larger: where its least is reached, the optimum is found.
  const FreeOptimum free(profile.channels());
  const double least = free.residual(free.metal());
  const auto reached = [&] { return search.best().residual <= least + tie(least); };
  if (reached()) return search.best();
  // Reflectance .5 before others that are as good.
  constexpr double middle = largest_dielectric_f0 / 4;
  search.consider(bound_case(profile.channels(), {Base::free, Base::free, Base::free}, middle));
  if (reached()) return search.best();
  search.consider(free.metal());
  if (reached()) return search.best();
  search.look_around();
  search.every_case();
  return search.best();
}

// Towards `end` until the rms is above the limit. The rms grows by at most the way that m goes: with the other parameters left as they are,
// the six values move by at most sqrt(6) |dm|. So (limit - rms) is a step that never passes the place.
double reach(const MetalProfile& profile, double from, double end, double limit) {
  constexpr double resolution = 1e-5;
  double m = from;
  while (m != end) {
    const double room = limit - std::sqrt(profile(m).residual / 6);
    if (room < resolution) break;
    m = end > m ? std::min(m + room, end) : std::max(m - room, end);
  }
  return m;
}

DisneyColours colours_of(const std::array<Channel, 3>& channels, double m, double k) {
  DisneyColours out;
  for (int c = 0; c < 3; ++c) out.base_colour[c] = MetalProfile::base(channels[static_cast<std::size_t>(c)], m, k);
  out.metal = m;
  if (m < 1) out.reflectance = std::sqrt(std::clamp(k / (1 - m) / largest_dielectric_f0, 0.0, 1.0));
  return out;
}

// In an order that no permutation of the channels changes, so that the sums over them are the same to the last bit.
std::array<Channel, 3> ordered(std::array<Channel, 3> channels) {
  std::sort(channels.begin(), channels.end(), [](const Channel& a, const Channel& b) { return a.d != b.d ? a.d < b.d : a.f < b.f; });
  return channels;
}

}  // namespace

ColourPair colour_pair_of(const DisneyColours& c) {
  const double s = 1 - c.metal, dielectric = largest_dielectric_f0 * square(c.reflectance) * s;
  return {c.base_colour * s, Rgb{dielectric, dielectric, dielectric} + c.base_colour * c.metal};
}

double squared_difference(const DisneyColours& colours, const ColourPair& pair) {
  const ColourPair got = colour_pair_of(colours);
  double sum = 0;
  for (int c = 0; c < 3; ++c)
    sum += square(got.diffuse[c] - MetalProfile::held(pair.diffuse[c])) + square(got.f0[c] - MetalProfile::held(pair.f0[c]));
  return sum;
}

DisneyFit fit_disney(const ColourPair& pair, DielectricF0 dielectric, double tolerance) {
  const std::array<Channel, 3> channels = MetalProfile::channels_of(pair);
  const MetalProfile profile(ordered(channels), dielectric);
  const MetalProfile::Point best = global_optimum(profile);
  const double limit = std::sqrt(best.residual / 6) + tolerance;
  return {colours_of(channels, best.m, best.k), best.residual, reach(profile, best.m, 0, limit), reach(profile, best.m, 1, limit)};
}

DisneyColours fit_disney_at(double metal, const ColourPair& pair, DielectricF0 dielectric) {
  const std::array<Channel, 3> channels = MetalProfile::channels_of(pair);
  const MetalProfile profile(ordered(channels), dielectric);
  const MetalProfile::Point best = profile(std::isnan(metal) ? 0 : std::clamp(metal, 0.0, 1.0));
  return colours_of(channels, best.m, best.k);
}

}  // namespace etendue
