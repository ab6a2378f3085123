#include "etendue/directional_albedo.h"
#include "facets.h"
#include "microfacet.h"
#include "quadrature.h"

#include <array>
#include <cmath>
#include <vector>

namespace etendue::eval {

// The albedo as a polynomial in y, y^2 = t = c / (c + a), c the cosine of the view and a the alpha that it has to do with: near grazing it
// hangs on c / a alone, t spreads that evenly, and c log c, which correlated masking brings in, is smooth in y to one more derivative.
// Schlick's masking bends where c is its k instead. Of anisotropic facets the coefficients are even harmonics of the azimuth, which has two
// axes of symmetry.
class AlbedoCurve {
 public:
  explicit AlbedoCurve(const SpecularLobe& lobe) : facets_(lobe.distribution, lobe.alpha_x, lobe.alpha_y), masking_(lobe.masking) {
    const bool round = lobe.alpha_x == lobe.alpha_y || lobe.distribution == Distribution::blinn_phong;
    harmonics_ = round ? 1 : 12;
    coefficients_.assign(harmonics_ * nodes, 0);
    // Chebyshev's nodes in both: sums of cosines, discrete and orthogonal.
    for (std::size_t j = 0; j < harmonics_; ++j) {
      const double azimuth = round ? 0 : 0.5 * pi * (static_cast<double>(j) + 0.5) / static_cast<double>(harmonics_);
      for (std::size_t i = 0; i < nodes; ++i) {
        const double turn = pi * (static_cast<double>(i) + 0.5) / nodes;
        const double value = directional_albedo(lobe, view_at(std::cos(turn), azimuth), tolerance).sum();
        for (std::size_t k = 0; k < harmonics_; ++k) {
          const double along = 2 * static_cast<double>(k) * azimuth, share = (k == 0 ? 1.0 : 2.0) / static_cast<double>(harmonics_);
          for (std::size_t n = 0; n < nodes; ++n)
            coefficients_[k * nodes + n] +=
                value * share * std::cos(along) * (n == 0 ? 1.0 : 2.0) / nodes * std::cos(static_cast<double>(n) * turn);
        }
      }
    }
    average();
  }

  double at(const Vec3d& direction) const {
    const double a = scale(direction), t = direction.z / (direction.z + a);
    const double x = 2 * std::sqrt(t * (1 + a)) - 1;  // t ends at 1 / (1 + a)
    double sum = series(0, x);
    if (harmonics_ > 1) {
      const double across = direction.x * direction.x + direction.y * direction.y;
      const double cosine = across > 0 ? (direction.x * direction.x - direction.y * direction.y) / across : 1;  // of twice the azimuth
      double before = 1, now = cosine;
      for (std::size_t k = 1; k < harmonics_; ++k) {
        sum += series(k, x) * now;
        const double next = 2 * cosine * now - before;
        before = now;
        now = next;
      }
    }
    return std::clamp(sum, 0.0, 1.0);
  }
  double mean() const { return mean_; }

 private:
  static constexpr std::size_t nodes = 32;
  static constexpr double tolerance = 1e-7;

  double scale(const Vec3d& direction) const {
    const double a = std::min(facets_.alpha_towards(direction), 1.0);
    return std::max(a, 2 * schlick_masking_k(masking_, a));
  }
  Vec3d view_at(double x, double azimuth) const {
    const Vec3d around{std::cos(azimuth), std::sin(azimuth), 0};
    const double a = scale(around), t = 0.25 * (1 + x) * (1 + x) / (1 + a), c = std::min(a * t / (1 - t), 1.0);
    return {around.x * std::sqrt(1 - c * c), around.y * std::sqrt(1 - c * c), c};
  }
  // Clenshaw's sum.
  double series(std::size_t harmonic, double x) const {
    const double* c = &coefficients_[harmonic * nodes];
    double b1 = 0, b2 = 0;
    for (std::size_t n = nodes - 1; n > 0; --n) {
      const double b0 = c[n] + 2 * x * b1 - b2;
      b2 = b1;
      b1 = b0;
    }
    return c[0] + x * b1 - b2;
  }
  // Over c, 2 c dc, with c = a sinh(w) that sees the grazing views; over a quarter of the azimuths.
  void average() {
    const int azimuths = harmonics_ > 1 ? 64 : 1;
    for (int i = 0; i < azimuths; ++i) {
      const double azimuth = 0.5 * pi * (i + 0.5) / azimuths;
      const Vec3d around{std::cos(azimuth), std::sin(azimuth), 0};
      const double a = std::min(facets_.alpha_towards(around), 1.0), end = std::asinh(1 / a);
      const int panels = static_cast<int>(std::ceil(end / 1.5));
      for (int p = 0; p < panels; ++p) {
        for (const GaussNode& node : gauss24()) {
          const double w = end * (p + 0.5 * (1 + node.x)) / panels, c = std::min(a * std::sinh(w), 1.0), s = std::sqrt(1 - c * c);
          mean_ += node.weight * 0.5 * end / panels * a * std::cosh(w) * 2 * c * at({around.x * s, around.y * s, c}) / azimuths;
        }
      }
    }
  }

  Facets facets_;
  Masking masking_;
  std::size_t harmonics_ = 1;
  std::vector<double> coefficients_;
  double mean_ = 0;
};

std::shared_ptr<const AlbedoCurve> albedo_curve(const SpecularLobe& lobe) {
  if (lobe.distribution == Distribution::phong) return nullptr;
  SpecularLobe bare = lobe;
  bare.compensation = nullptr;
  return std::make_shared<const AlbedoCurve>(bare);
}
double albedo(const AlbedoCurve& curve, const Vec3d& direction) { return curve.at(direction); }
double mean_albedo(const AlbedoCurve& curve) { return curve.mean(); }

}  // namespace etendue::eval
