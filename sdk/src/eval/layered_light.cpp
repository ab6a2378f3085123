#include "etendue/layered_light.h"

#include <cmath>
#include <numbers>

namespace etendue::eval {
namespace {

// Directions even over the hemisphere: Fibonacci's spiral.
Vec3d even_direction(int i, int count) {
  const double z = (i + 0.5) / count, r = std::sqrt(1 - z * z), azimuth = 2 * pi * std::fmod(i * std::numbers::phi, 1.0);
  return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

}  // namespace

Rgb brdf_cos(std::span<const LayerValue> layers, std::span<const double> weights, const Vec3d& view, const Vec3d& light) {
  Rgb sum;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const Basis basis = basis_around(layers[i].normal);
    const auto local = [&basis](const Vec3d& d) { return Vec3d{dot(d, basis.tangent), dot(d, basis.bitangent), dot(d, basis.normal)}; };
    if (weights[i] > 0) sum += brdf_cos(Brdf(layers[i].surface), local(view), local(light)) * weights[i];
  }
  return sum;
}

double blending_error(std::span<const LayerValue> layers, std::span<const double> masks, LayerBlend blend) {
  constexpr int views = 64, lights = 1024;
  const std::vector<double> weights = layer_weights(masks);
  const LayerValue one[] = {blended(layers, masks, NormalBlend::replace, blend)};
  constexpr double whole[] = {1};
  double squares = 0, all = 0;
  for (int v = 0; v < views; ++v) {
    const Vec3d view = even_direction(v, views);
    for (int l = 0; l < lights; ++l) {
      const Vec3d light = even_direction(l, lights);
      const Rgb lit = brdf_cos(layers, weights, view, light), difference = brdf_cos(one, whole, view, light) - lit;
      squares += dot(difference, difference);
      all += dot(lit, lit);
    }
  }
  return all > 0 ? std::sqrt(squares / all) : 0;
}

}  // namespace etendue::eval
