#include "etendue/directional_albedo.h"

#include "kernels.h"
#include "line_integral.h"

#include <array>

namespace etendue::eval {
namespace {

// In slopes p of the half vector, with dl = 4 v.h dh, dh = (n.h)^3 dp and D (n.h)^4 = P(p) (facets.h),
//   albedo = integral of P(p) (c + s p.e) G2 / c dp,   e the azimuth of the view, c and s its cosine and sine,
// over the slopes that mirror the view to above the horizon. With h = (p, 1) / sqrt(1 + p^2),
//   n.l = 2 (v.h) (n.h) - c = c (1 / c^2 - |p - (s / c) e|^2) / (1 + p^2):
// a disc of the radius 1 / c about (s / c) e. Seen from p = 0, where P has its peak, the border is R = (s x + sqrt(c^2 + s^2 x^2)) / c away
// in the direction whose cosine to e is x, 1 / R the other way, and n.l = c (R - r) (r + 1 / R) / (1 + r^2).
class SlopeIntegral {
 public:
  SlopeIntegral(const SpecularLobe& lobe, const Vec3d& view)
      : kernel_(lobe, view), c_(view.z), s_(std::hypot(view.x, view.y)), ahead_(s_ > 0 ? Vec2d{view.x / s_, view.y / s_} : Vec2d{1, 0}) {}

  // `weights`: Rgb of the cosine between view and half vector. Round facets look the same on both sides of the view.
  template <class Weights>
  Estimate integrate(const Weights& weights, double relative) const {
    Estimate total;
    const auto ray = [&](double psi) { return along_ray(psi, weights); };
    const auto add = [&](double begin, double end, double peak, double width, double times) {
      Estimate part = integrate_peaked(ray, begin, end, peak, width, {relative, 0});
      total.value += part.value * times;
      total.error += part.error * times;
    };
    // Rays turn from ahead to back within c of the plane across the view.
    const double turn = std::clamp(c_, 1e-9, 1.0);
    const auto& [ax, ay] = std::pair{kernel_.lobe.alpha_x, kernel_.lobe.alpha_y};
    if (ax == ay || kernel_.lobe.distribution == Distribution::blinn_phong) {
      add(0, 0.5 * pi, 0.5 * pi, turn, 2);
      add(0.5 * pi, pi, 0.5 * pi, turn, 2);
    } else {
      // Narrow facets stand out along their wide axis.
      const double azimuth = std::atan2(ahead_.y, ahead_.x), wide = (ax > ay ? 0 : 0.5 * pi) - azimuth;
      const double narrow = std::clamp(std::min(ax, ay) / std::max(ax, ay), 1e-9, 1.0);
      struct Peak {
        double at, width;
      };
      std::array<Peak, 4> peaks{{{0.5 * pi, turn}, {1.5 * pi, turn}, {wide, narrow}, {wide + pi, narrow}}};
      for (Peak& p : peaks) p.at -= 2 * pi * std::floor(p.at / (2 * pi));
      std::sort(peaks.begin(), peaks.end(), [](const Peak& a, const Peak& b) { return a.at < b.at; });
      for (std::size_t i = 0; i < peaks.size(); ++i) {
        const double begin = peaks[i].at, end = i + 1 < peaks.size() ? peaks[i + 1].at : peaks[0].at + 2 * pi, middle = 0.5 * (begin + end);
        if (!(middle > begin)) continue;
        add(begin, middle, begin, peaks[i].width, 1);
        add(middle, end, end, peaks[(i + 1) % peaks.size()].width, 1);
      }
    }
    total.evaluations = evaluations_;
    return total;
  }

 private:
  // All slopes in one direction, psi from the view's azimuth. Two substitutions spread the nodes over all scales: r = a sinh(w) from the
  // peak, which is a wide there, to half of R, and R - r = b sinh(w) from the border, where masking bends at n.l = alpha, b = alpha R / c.
  // What singularities there are stand beside the rays at a distance of their own size, so that panels of 1.5 in w with 24 nodes are
  // exact to 1e-13.
  template <class Weights>
  Rgb along_ray(double psi, const Weights& weights) const {
    const double x = std::cos(psi), root = std::hypot(c_, s_ * x);
    const double border = x > 0 ? (s_ * x + root) / c_ : c_ / (root - s_ * x);
    const Vec2d direction{ahead_.x * x - ahead_.y * std::sin(psi), ahead_.y * x + ahead_.x * std::sin(psi)};
    const double a = width_along(direction), narrowest = std::max(std::min(kernel_.lobe.alpha_x, kernel_.lobe.alpha_y), min_alpha);
    const double b = border * std::min(narrowest / c_, 1.0);
    Rgb sum;
    const auto at = [&](double r, double away, double dr) {
      const double factor = 1 / (1 + r * r), short_factor = std::sqrt(factor);
      const Vec3d half{direction.x * r, direction.y * r, 1};
      const double over_normal = c_ + s_ * r * x;  // v.h / n.h
      if (!(over_normal > 0)) return;
      const double nl = c_ * away * (r + 1 / border) * factor;
      const Vec3d light{2 * over_normal * factor * half.x - ahead_.x * s_, 2 * over_normal * factor * half.y - ahead_.y * s_, nl};
      const double density = kernel_.facets.density(half) * factor * factor;
      sum += weights(std::min(over_normal * short_factor, 1.0)) * (density * over_normal * 4 * nl * kernel_.masked(light) * r * dr);
    };
    const auto panels = [&](double scale, auto&& use) {
      const double end = std::asinh(0.5 * border / scale);
      const int count = static_cast<int>(std::ceil(end / 1.5));
      for (int i = 0; i < count; ++i) {
        for (const GaussNode& node : gauss24()) {
          const double w = end / count * (i + 0.5 * (1 + node.x));
          use(scale * std::sinh(w), 0.5 * end / count * node.weight * scale * std::cosh(w));
        }
      }
      evaluations_ += 24 * static_cast<std::uint64_t>(count);
    };
    panels(a, [&](double r, double dr) { at(r, border - r, dr); });
    panels(b, [&](double away, double dr) { at(border - away, away, dr); });
    return sum;
  }
  double width_along(const Vec2d& direction) const {
    const double ax = std::max(kernel_.lobe.alpha_x, min_alpha), ay = std::max(kernel_.lobe.alpha_y, min_alpha);
    if (kernel_.lobe.distribution == Distribution::blinn_phong) return std::sqrt(ax * ay);
    return 1 / std::hypot(direction.x / ax, direction.y / ay);
  }

  SpecularKernel kernel_;
  double c_, s_;
  Vec2d ahead_;
  mutable std::uint64_t evaluations_ = 0;
};

// Phong's lobe has no facets: the sky over the outline of the hemisphere.
Estimate under_sky(const SpecularLobe& lobe, const Vec3d& view, double relative) {
  Emitter sky;
  sky.shape = EnvironmentEmitter{};
  sky.radiance = {1, 1, 1};
  return reference(sky, {{}, {0, 0, 1}, {0, 0, 1}, view, lobe, {1, 0, 0}}, {relative, 0});
}

double weight_of(const SpecularLobe& lobe, double v_dot_h) {
  return lobe.fresnel == Fresnel::schlick_gaussian ? gaussian_schlick_weight(v_dot_h) : schlick_weight(v_dot_h);
}

}  // namespace

AlbedoParts directional_albedo(const SpecularLobe& lobe, const Vec3d& view, double relative) {
  if (!(view.z > 0)) return {};
  if (lobe.distribution == Distribution::phong) {
    SpecularLobe part = lobe;
    part.compensation = nullptr;
    if (part.fresnel != Fresnel::schlick_gaussian) part.fresnel = Fresnel::schlick;
    part.f0 = {1, 1, 1};
    part.f90 = 0;
    const Estimate f0 = under_sky(part, view, relative);
    part.f0 = {0, 0, 0};
    part.f90 = 1;
    const Estimate f90 = under_sky(part, view, relative);
    return {f0.value.x, f90.value.x, std::max(f0.error.x, f90.error.x), f0.evaluations + f90.evaluations};
  }
  const Estimate sum = SlopeIntegral(lobe, view)
                           .integrate(
                               [&](double v_dot_h) {
                                 const double w = weight_of(lobe, v_dot_h);
                                 return Rgb{1 - w, w, 1};
                               },
                               relative);
  return {sum.value.x, sum.value.y, std::max(sum.error.x, sum.error.y), sum.evaluations};
}

Estimate reflectance(const SpecularLobe& lobe, const Vec3d& view, double relative) {
  if (!(view.z > 0)) return {};
  if (lobe.distribution == Distribution::phong || lobe.compensation != nullptr) return under_sky(lobe, view, relative);
  return SlopeIntegral(lobe, view).integrate([&](double v_dot_h) { return fresnel_reflectance(lobe, v_dot_h); }, relative);
}

// With k = F90 - 1 = A + r v.l (2 (v.h)^2 = 1 + v.l), A = bias - 1 + r, w = (1 - cosine)^5 of either side and x = n.l, the albedo is
//   1 / pi integral of (1 + k w(v)) (1 + k w(l)) x dl = 2 integral of (1 + (w(v) + w(l)) <k> + w(v) w(l) <k^2>) x dx,
// means over the azimuth: <v.l> = c x, <(v.l)^2> = c^2 x^2 + s^2 (1 - x^2) / 2. The integral of x^a (1 - x)^5 is a! 5! / (a + 6)!: 1/42,
// 1/168 and 1/504 for a = 1, 2, 3.
namespace {
double disney_form(double roughness, double bias, double cosine) {
  const double c = std::clamp(cosine, 0.0, 1.0), s2 = 1 - c * c, r = roughness, a = bias - 1 + r, w = schlick_weight(c);
  const double light = 2 * (a / 42 + r * c / 168), view = w * (a + 2 * r * c / 3);
  const double both = 2 * w * (a * a / 42 + 2 * a * r * c / 168 + r * r * (c * c / 504 + 0.5 * s2 * (1 / 42.0 - 1 / 504.0)));
  return 1 + light + view + both;
}
}  // namespace
double disney_albedo(double roughness, double cosine) { return disney_form(roughness, 0.5, cosine); }
double frostbite_albedo(double roughness, double cosine) {
  return (1 + roughness * (1 / 1.51 - 1)) * disney_form(roughness, 0.5 * roughness, cosine);
}

}  // namespace etendue::eval
