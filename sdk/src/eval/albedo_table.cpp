#include "etendue/directional_albedo.h"
#include "microfacet.h"

#include <array>
#include <cmath>

namespace etendue::eval {
namespace {

// Weights of the four values around a place between the inner two (0 <= t <= 1): the cubic through them (Lagrange).
std::array<double, 4> cubic(double t) {
  const double before = t + 1, after = t - 1, beyond = t - 2;
  return {-t * after * beyond / 6, before * after * beyond / 2, -before * t * beyond / 2, before * t * after / 6};
}

}  // namespace

// Rows over alpha^(1/4), columns over the share of asinh(sqrt(1 / alpha)) that asinh(sqrt(c / alpha)) is, c the cosine of the view: even
// over the decades of both, even in alpha where it is large, and even in sqrt(c) where c is far below alpha: masking hangs on c / alpha,
// and correlated masking has a c log c at grazing. Kept are the albedo and q = w^(1/5) of the mean Schlick weight w, which is 1 - c for
// a mirror: far smoother than w.
class AlbedoTable {
 public:
  explicit AlbedoTable(SpecularLobe lobe) {
    for (std::size_t i = 0; i < size; ++i) {
      const double row = lowest + (1 - lowest) * static_cast<double>(i) / (size - 1), a = row * row * row * row;
      lobe.alpha_x = lobe.alpha_y = a;
      for (std::size_t j = 0; j < size; ++j) {
        // Exactly along the horizon nothing is seen: the limit stands for it.
        const double share = std::max(static_cast<double>(j) / (size - 1), 1e-4), root = std::sinh(share * widest(a));
        const double c = std::min(a * root * root, 1.0);
        const AlbedoParts parts = directional_albedo(lobe, {std::sqrt(1 - c * c), 0, c}, 1e-6);
        entries_[i * size + j] = {static_cast<float>(parts.sum()), static_cast<float>(std::pow(parts.f90_part / parts.sum(), 0.2))};
      }
    }
  }
  AlbedoParts at(double alpha, double cosine) const {
    const double a = std::clamp(alpha, min_alpha, 1.0);
    const Place row = place((std::sqrt(std::sqrt(a)) - lowest) / (1 - lowest));
    const Place column = place(std::asinh(std::sqrt(std::clamp(cosine, 0.0, 1.0) / a)) / widest(a));
    double sum = 0, q = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        const Entry& e = entries_[(row.first + i) * size + column.first + j];
        const double weight = row.weights[i] * column.weights[j];
        sum += weight * static_cast<double>(e.sum);
        q += weight * static_cast<double>(e.q);
      }
    }
    AlbedoParts parts;
    parts.f90_part = sum * q * q * q * q * q;
    parts.f0_part = sum - parts.f90_part;
    return parts;
  }

 private:
  static constexpr std::size_t size = 32;
  static constexpr double lowest = 0.1;  // min_alpha^(1/4)
  static double widest(double alpha) { return std::asinh(std::sqrt(1 / alpha)); }

  struct Entry {
    float sum = 0, q = 0;
  };
  struct Place {
    std::size_t first;
    std::array<double, 4> weights;
  };
  // At both ends the cubic of the outermost four.
  static Place place(double x) {
    const double along = std::clamp(x, 0.0, 1.0) * (size - 1);
    const auto first = static_cast<std::size_t>(std::clamp(std::floor(along) - 1, 0.0, static_cast<double>(size - 4)));
    return {first, cubic(along - static_cast<double>(first) - 1)};
  }

  std::array<Entry, size * size> entries_{};
};

std::shared_ptr<const AlbedoTable> albedo_table(const SpecularLobe& lobe) {
  if (lobe.distribution == Distribution::phong) return nullptr;
  return std::make_shared<const AlbedoTable>(lobe);
}
AlbedoParts albedo_parts(const AlbedoTable& table, double alpha, double cosine) { return table.at(alpha, cosine); }

}  // namespace etendue::eval
