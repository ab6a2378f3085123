// How wrong rules of a few places over small lights are (sdk/src/eval/far_places.h), against 12 places along each side or 12 rings, over
// random surfaces and lights: alpha and n.v log-uniform from 1e-4, half of the lights within a few widths of the lobe's mirror direction,
// sides of any ratio. Prints a line a kind of light, order and band of sizes: kind, order, largest size of the band, configurations, the
// largest error as a part of the light and of the bound (far_places.h; 1 and more would break it), and that configuration's alpha, n.v and
// BRDF.
//   far_errors [CONFIGURATIONS [SEED]]
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numeric>
#include <tuple>

#include "../../sdk/src/eval/far_places.h"
#include "../../sdk/src/eval/kernels.h"
#include "eval_protocol.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

constexpr std::array<const char*, 9> brdf_names{"ggx",        "standard", "metal-rough", "two-colour",  "conductor",
                                                "principled", "disney",   "frostbite",   "gltf-diffuse"};
Brdf brdf_of(std::size_t which, double alpha, Random& random) {
  const double roughness = std::sqrt(alpha), mix = random.uniform(0, 1), f0 = random.log_uniform(0.02, 1);
  const Rgb base = Rgb{1, 1, 1} * random.uniform(0, 1), grey = Rgb{1, 1, 1} * f0;
  const auto masking = std::array{Masking::correlated, Masking::separable, Masking::schlick_direct,
                                  Masking::schlick_image}[static_cast<std::size_t>(random.uniform(0, 4))];
  switch (which) {
    case 0:
      return GgxLobe{alpha, grey, 1, masking};
    case 1:
      return Standard{base, mix, roughness, random.uniform(0.35, 1)};
    case 2:
      return MetalRough{base, mix, roughness, 1.5};
    case 3:
      return TwoColour{base, grey, roughness};
    case 4:
      return Conductor{Rgb{1, 1, 1} * random.log_uniform(0.1, 4), Rgb{1, 1, 1} * random.uniform(1, 6), alpha, masking};
    case 5:
      return Principled{base, mix, roughness, random.uniform(0.25, 1)};
    case 6:
      return DisneyDiffuse{base, roughness};
    case 7:
      return FrostbiteDiffuse{base, roughness};
    default:
      return GltfDiffuse{base, 1.5};
  }
}

struct Worst {
  int count = 0;
  double error = 0, ratio = 0, alpha = 0, cosine = 0;
  const char* brdf = "";
};
std::map<std::tuple<int, std::size_t, int>, Worst> worst;

}  // namespace

int main(int argc, char** argv) {
  const int configurations = argc > 1 ? std::atoi(argv[1]) : 100000;
  Random random(argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1);
  for (int i = 0; i < configurations; ++i) {
    const int kind = i % 3;
    const std::size_t which = static_cast<std::size_t>(i / 3) % brdf_names.size();
    const double alpha = random.log_uniform(1e-4, 1), cosine = i % 2 == 0 ? random.log_uniform(1e-4, 1) : random.uniform(0, 1);
    const Vec3d view{std::sqrt((1 - cosine) * (1 + cosine)), 0, cosine};
    Vec3d towards = random.direction();
    towards.z = std::abs(towards.z);
    if (i / 27 % 2 == 0) {
      const double slope = alpha * random.log_uniform(0.01, 100), turn = random.uniform(0, 2 * pi);
      const Vec3d h = normalised(Vec3d{slope * std::cos(turn), slope * std::sin(turn), 1});
      towards = normalised(h * (2 * dot(view, h)) - view);
    }
    if (!(towards.z > 1e-6)) continue;
    const Brdf brdf = brdf_of(which, alpha, random);
    const double lobe = which >= 6 ? 0 : std::max(which == 5 ? std::max(alpha, 1e-3) : alpha, min_alpha);
    const double pole = nearest_singularity(towards, view, lobe), size = random.log_uniform(0.02, 0.9) * pole;
    Emitter light;
    light.radiance = {1, 1, 1};
    Vec3d n = random.direction();
    if (dot(n, towards) > 0) n = n * -1.0;
    const Basis b = basis_around(n);
    const double turn = random.uniform(0, 2 * pi), ratio = random.uniform(0, 1) < 0.5 ? 1 : random.log_uniform(0.01, 1);
    const Vec3d x = b.tangent * std::cos(turn) + b.bitangent * std::sin(turn), y = cross(n, x);
    const double across = size / std::sqrt(1 + ratio * ratio);
    if (kind == 0) light.shape = rectangle(towards, x, y, 2 * across, 2 * across * ratio);
    if (kind == 1) light.shape = SphereEmitter{towards, size};
    if (kind == 2) light.shape = DiskEmitter{towards, n, x, size};
    const ShadingPoint point{{}, {0, 0, 1}, {0, 0, 1}, view, brdf};
    const LocalFrame frame(point);
    const auto seen = far_seen(light, frame, horizons_of(frame, point.normal, point.surface_normal), frame.vector(view), lobe);
    if (!seen) continue;
    const double widest = std::max(seen->x, seen->y);
    if (widest > largest_far_size) continue;
    with_kernel(brdf, frame.vector(view), [&](const auto& kernel) {
      const double truth = over_places(*seen, {12, 12}, kernel).x;
      if (!(truth > 0)) return;
      const double rounding = far_rounding(lobe, cosine, seen->facing);
      const int band = static_cast<int>(widest * 10);
      const auto tell = [&](std::size_t order, const FarCounts& counts, double bound) {
        const double error = std::abs(over_places(*seen, counts, kernel).x / truth - 1);
        Worst& w = worst[{kind, order, band}];
        ++w.count;
        if (const double ratio = error / (bound + rounding); ratio > w.ratio) w = {w.count, error, ratio, alpha, cosine, brdf_names[which]};
      };
      if (kind == 0) {
        for (std::size_t n = 1; n <= most_far_order; ++n) tell(n, {n, n}, far_bound_of_side(n, seen->x) + far_bound_of_side(n, seen->y));
      } else {
        for (std::size_t rings = 0; rings <= most_far_rings; ++rings) tell(rings, {rings, 1}, far_bound_of_rings(rings, seen->x));
      }
    });
  }
  for (const auto& [key, w] : worst) {
    const auto [kind, order, band] = key;
    fmt::print("{} {} {:.1f} {} {:.3g} {:.3g} {:.3g} {:.3g} {}\n", std::array{"rect", "sphere", "disk"}[static_cast<std::size_t>(kind)],
               order, 0.1 * (band + 1), w.count, w.error, w.ratio, w.alpha, w.cosine, w.brdf);
  }
}
