// specular_luminance over random configurations. Prints one line a shape and tolerance: shape, tolerance, configurations, answers that were
// off by more than was asked, the worst error in units of that, answers that told a larger error, mean evaluations and ns; those of
// `reference` at that tolerance (a part of the configurations) and of `ltc` one by one, ns.
//   adaptive_errors [CONFIGURATIONS [SEED [SHAPE]]]
// Each answer that was off by more is told on stderr.
// Half of the lights cross the horizon. Half of the views have the mirror direction within the light, a quarter has a cosine uniform in
// [.05, 1], a quarter one that is log-uniform from 1e-4 on; alpha is log-uniform from 1e-4 on; F = 1 and f0 = .04; a third has separable
// masking.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "etendue/specular_light.h"
#include "etendue/specular_methods.h"
#include "eval_protocol.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

constexpr std::array<double, 4> tolerances{1e-2, 1e-3, 1e-4, 1e-6};

Vec3d view_at(const Vec3d& normal, double cosine, double turn) {
  const Basis b = basis_around(normal);
  return b.normal * cosine + (b.tangent * std::cos(turn) + b.bitangent * std::sin(turn)) * std::sqrt((1 - cosine) * (1 + cosine));
}
Vec3d view_for(const Placement& p, int turn, Random& random) {
  // Of lights that have all but set none may be found.
  for (int attempt = 0; turn % 4 < 2 && attempt < 50; ++attempt) {
    const LightSample s = sample_light(p.emitter, p.position, random.square());
    const double cosine = dot(s.direction, p.normal);
    if (s.pdf > 0 && cosine > 1e-4) return normalised(p.normal * (2 * cosine) - s.direction);
  }
  const double cosine = turn % 4 == 2 ? random.uniform(0.05, 1) : random.log_uniform(1e-4, 1);
  return view_at(p.normal, cosine, random.uniform(0, 2 * pi));
}

// A sun of .1 to 5 degrees, above the horizon or across it.
Placement place_sun(Random& random, bool above) {
  for (;;) {
    Placement p;
    p.normal = random.direction(), p.towards = random.direction();
    const double radius = random.log_uniform(0.1, 5) * pi / 180, height = std::asin(dot(p.normal, p.towards));
    if (above ? height < radius : std::abs(height) > radius) continue;
    const double sine = std::sin(radius);
    p.emitter.shape = DistantEmitter{p.towards, Rgb{1, 1, 1} * (pi * sine * sine), radius};
    return p;
  }
}

class Stopwatch {
 public:
  double ns() const { return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

struct Figures {
  int count = 0, broken = 0, told_more = 0, compared = 0;
  double worst = 0, evaluations = 0, ns = 0, reference_evaluations = 0, reference_ns = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const int configurations = argc > 1 ? std::atoi(argv[1]) : 20000;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  const std::string_view only = argc > 3 ? argv[3] : "";
  const std::array<std::pair<std::optional<Kind>, const char*>, 6> shapes{{{Kind::rect, "rect"},
                                                                           {Kind::sphere, "sphere"},
                                                                           {Kind::disk, "disk"},
                                                                           {Kind::capsule, "tube"},
                                                                           {Kind::star, "star"},
                                                                           {std::nullopt, "sun"}}};
  const SpecularMethod* const ltc = find_specular_method("ltc");
  for (const auto& [kind, name] : shapes) {
    if (!only.empty() && only != name) continue;
    std::array<Figures, tolerances.size()> figures;
    double ltc_ns = 0;
    int ltc_count = 0;
    Random random(seed * 1000 + (kind ? static_cast<std::uint64_t>(*kind) : 99));
    const int count = configurations / static_cast<int>(shapes.size());
    for (int i = 0; i < count; ++i) {
      const Placement p = kind ? place(*kind, random, i % 2 == 0) : place_sun(random, i % 2 == 0);
      const double alpha = random.log_uniform(1e-4, 1), f0 = i % 3 == 0 ? 0.04 : 1;
      const GgxLobe lobe{alpha, {f0, f0, f0}, 1, random.uniform(0, 1) < 1.0 / 3 ? Masking::separable : Masking::correlated};
      const ShadingPoint point{p.position, p.normal, p.normal, view_for(p, i / 2, random), lobe};
      const Rgb lux = illuminance(p.emitter, p.position, p.normal);
      const double floor = 1e-3 * lux.x;
      double aimed = 3e-8;
      Estimate truth = reference(p.emitter, point, {aimed, aimed * floor});
      if (lobe.masking == Masking::correlated) {
        const Stopwatch watch;
        const auto value = ltc->luminance(p.emitter, point);
        ltc_ns += watch.ns(), ltc_count += value.has_value();
      }
      for (std::size_t t = 0; t < tolerances.size(); ++t) {
        const double tolerance = tolerances[t];
        Figures& f = figures[t];
        const Stopwatch watch;
        const Estimate light = specular_luminance(p.emitter, point, tolerance).value_or(Estimate{});
        f.ns += watch.ns(), f.evaluations += static_cast<double>(light.evaluations), ++f.count;
        const auto off = [&] { return std::abs(light.value.x - truth.value.x) / (tolerance * std::max(truth.value.x, floor)); };
        // Where the two disagree the reference is asked more closely.
        if (!(off() <= 0.9) && aimed > 1e-9) {
          aimed = 1e-9;
          truth = reference(p.emitter, point, {aimed, aimed * floor});
        }
        const double allowed = tolerance * std::max(truth.value.x, floor);
        f.worst = std::max(f.worst, off());
        if (!(off() <= 1 + truth.error.x / allowed)) {
          ++f.broken;
          fmt::print(stderr,
                     "{} number {} asked {:g}: off by {:.3g}, told {:.3g} of it; alpha {:.3g} n.v {:.3g} f0 {:g} value {:.6g} E {:.3g}\n",
                     name, i, tolerance, off(), light.error.x / allowed, alpha, dot(point.view, p.normal), f0, truth.value.x, lux.x);
        }
        f.told_more += !(light.error.x <= allowed * 1.01 + 1e-15);
        if (i % 16 == 0) {
          const Stopwatch reference_watch;
          f.reference_evaluations += static_cast<double>(reference(p.emitter, point, {tolerance, tolerance * floor}).evaluations);
          f.reference_ns += reference_watch.ns(), ++f.compared;
        }
      }
    }
    for (std::size_t t = 0; t < tolerances.size(); ++t) {
      const Figures& f = figures[t];
      const int n = std::max(f.count, 1), c = std::max(f.compared, 1);
      fmt::print("{} {:g} {} {} {:.3g} {} {:.0f} {:.0f} {:.0f} {:.0f} {:.0f}\n", name, tolerances[t], f.count, f.broken, f.worst,
                 f.told_more, f.evaluations / n, f.ns / n, f.reference_evaluations / c, f.reference_ns / c,
                 ltc_ns / std::max(ltc_count, 1));
    }
    std::fflush(stdout);
  }
}
