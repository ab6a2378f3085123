// SpecularWithinBatch over random configurations, as adaptive_errors.cpp draws them. Prints one line a shape and tolerance: shape,
// tolerance, answers, those that were off by more than was asked, the worst error in units of that, that configuration's alpha, n.v and f0,
// and the time of a point over that of the transformed cosines of rectangles in vectors, as batches of 4096 points around one light of
// each: over such configurations, and over those of specular_errors.cpp (alpha from .01, n.v from .05).
//   within_errors [CONFIGURATIONS [SEED [SHAPE]]]
// Each answer that was off by more is told on stderr.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "etendue/specular_light.h"
#include "etendue/specular_within_batch.h"
#include "eval_protocol.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

// Of this thread alone: the machine may be shared.
double seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Emitter sun(const Vec3d& towards, double radius_rad) {
  const double sine = std::sin(radius_rad);
  Emitter light;
  light.shape = DistantEmitter{towards, Rgb{1, 1, 1} * (pi * sine * sine), radius_rad};
  return light;
}
// Of .1 to 5 degrees, above the horizon or across it.
Placement place_sun(Random& random, bool above) {
  for (;;) {
    Placement p;
    p.normal = random.direction(), p.towards = random.direction();
    const double radius = random.log_uniform(0.1, 5) * pi / 180, height = std::asin(dot(p.normal, p.towards));
    if (above ? height < radius : std::abs(height) > radius) continue;
    p.emitter = sun(p.towards, radius);
    return p;
  }
}

// Half of the views have the mirror direction within the light, a quarter has a cosine uniform in [.05, 1], a quarter one that is
// log-uniform from `least` on.
Vec3d view_for(const Placement& p, int turn, Random& random, double least) {
  for (int attempt = 0; turn % 4 < 2 && attempt < 50; ++attempt) {
    const LightSample s = sample_light(p.emitter, p.position, random.square());
    const double cosine = dot(s.direction, p.normal);
    if (s.pdf > 0 && cosine > least) return normalised(p.normal * (2 * cosine) - s.direction);
  }
  const double cosine = turn % 4 == 2 ? random.uniform(0.05, 1) : random.log_uniform(least, 1), around = random.uniform(0, 2 * pi);
  const Basis b = basis_around(p.normal);
  return b.normal * cosine + (b.tangent * std::cos(around) + b.bitangent * std::sin(around)) * std::sqrt((1 - cosine) * (1 + cosine));
}

// What a batch takes, and what its floats say.
struct Views {
  std::array<std::vector<float>, 10> numbers;

  void add(const Vec3d& p, const Vec3d& n, const Vec3d& v, double alpha) {
    const std::array<double, 10> all{p.x, p.y, p.z, n.x, n.y, n.z, v.x, v.y, v.z, alpha};
    for (std::size_t k = 0; k < 10; ++k) numbers[k].push_back(static_cast<float>(all[k]));
  }
  std::size_t size() const { return numbers[0].size(); }
  SpecularPoints points() const {
    const auto& n = numbers;
    return {{n[0], n[1], n[2], n[3], n[4], n[5], {}}, n[6], n[7], n[8], n[9]};
  }
  ShadingPoint point(std::size_t i, double f0) const {
    const auto at = [&](std::size_t k) { return Vec3d{numbers[k][i], numbers[k + 1][i], numbers[k + 2][i]}; };
    const Vec3d normal = normalised(at(3));
    return {at(0), normal, normal, normalised(at(6)), GgxLobe{numbers[9][i], {f0, f0, f0}, 1}};
  }
};

struct Figures {
  int count = 0, broken = 0;
  double worst = 0, alpha = 0, cosine = 0, f0 = 0;
};

// Of no kind: a sun.
Figures errors(std::optional<Kind> kind, double tolerance, int configurations, std::uint64_t seed) {
  Random random(seed * 1000 + 7);
  Figures f;
  for (int i = 0; i < configurations; ++i) {
    const Placement p = kind ? place(*kind, random, i % 2 == 0) : place_sun(random, i % 2 == 0);
    Views views;
    views.add(p.position, p.normal, view_for(p, i / 2, random, 1e-4), random.log_uniform(1e-4, 1));
    float of_f0 = 0, of_f90 = 0;
    if (!SpecularWithinBatch::of(p.emitter, tolerance)->shares(views.points(), {{&of_f0, 1}, {&of_f90, 1}, {}, {}}, 0)) std::abort();
    const double f0 = i % 3 == 0 ? 0.04 : 1, value = f0 * static_cast<double>(of_f0) + static_cast<double>(of_f90);
    const ShadingPoint point = views.point(0, f0);
    const double floor = 1e-3 * illuminance(p.emitter, point.position, point.normal).x;
    Estimate truth = *specular_luminance(p.emitter, point, tolerance / 20);
    const auto off = [&] { return std::abs(value - truth.value.x) / (tolerance * std::max(truth.value.x, floor)); };
    // Where the two disagree the reference is asked.
    if (!(off() <= 0.9)) truth = reference(p.emitter, point, {1e-9, 1e-9 * floor});
    ++f.count;
    const double cosine = dot(point.view, point.normal), alpha = views.numbers[9][0];
    if (off() > f.worst) f.worst = off(), f.alpha = alpha, f.cosine = cosine, f.f0 = f0;
    if (off() <= 1) continue;
    ++f.broken;
    fmt::print(stderr, "number {} asked {:g}: off by {:.3g}; alpha {:.3g} n.v {:.3g} f0 {:g} value {:.6g} E {:.3g}\n", i, tolerance, off(),
               alpha, cosine, f0, truth.value.x, 1e3 * floor);
  }
  return f;
}

constexpr Vec3d sun_towards{0.36, 0.48, 0.8};

// One of a middling size, points around it as the protocol has them; under a sun all that differs is the normal.
Emitter light_of(std::optional<Kind> kind) {
  if (!kind) return sun(sun_towards, 0.53 / 2 * pi / 180);
  if (*kind == Kind::sphere) return white(SphereEmitter{{}, 0.5});
  if (*kind == Kind::star) return white(star({}, {1, 0, 0}, {0, 1, 0}, 1.2, 0.8, 5, 0.5));
  if (*kind == Kind::disk) return white(DiskEmitter{{}, {0, 0, 1}, {1, 0, 0}, 0.5});
  const Caps caps = *kind == Kind::capsule ? Caps::round : *kind == Kind::flat_tube ? Caps::flat : Caps::none;
  if (*kind != Kind::rect) return white(TubeEmitter{{-0.5, 0, 0}, {0.5, 0, 0}, 0.1, caps});
  return white(rectangle({}, {1, 0, 0}, {0, 1, 0}, 1.2, 0.8));
}
Views views_around(const Emitter& light, Random& random, bool grazing) {
  const std::array<double, 9> alphas{0.01, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1};
  Views views;
  const auto* sun_light = std::get_if<DistantEmitter>(&light.shape);
  while (views.size() < 4096) {
    const std::size_t k = views.size();
    const Vec3d position = random.direction() * (1.2 * random.uniform(0.5, 3)), normal = random.direction();
    const Placement p{light, position, normal, {}};
    if (!(lux_at(light, p.position, p.normal) >= (sun_light != nullptr ? 1e-9 : 1e-3))) continue;
    // All of a sun is above but for a hundredth of them.
    if (sun_light == nullptr && (lowest(light.shape, p.position, p.normal) < 0) != (k % 2 == 0)) continue;
    views.add(p.position, p.normal, view_for(p, static_cast<int>(k / 2), random, grazing ? 1e-4 : 0.05),
              grazing ? random.log_uniform(1e-4, 1) : alphas[k * 7 % 9]);
  }
  return views;
}

// ns of a point over those of the transformed cosines of a rectangle, the least of several turns.
double cost(std::optional<Kind> kind, double tolerance, std::uint64_t seed, bool grazing) {
  Random random(seed * 1000 + 8), random_of_rect(seed * 1000 + 8);
  const Emitter light = light_of(kind), rect = light_of(Kind::rect);
  const Views views = views_around(light, random, grazing), rect_views = views_around(rect, random_of_rect, grazing);
  std::vector<float> of_f0(views.size()), of_f90(views.size());
  const auto ours = SpecularWithinBatch::of(light, tolerance);
  const auto ltc = SpecularBatch::of(SpecularRule::ltc, rect);
  constexpr int ltc_turns = 16;
  double least = 1e300, least_ltc = 1e300;
  for (int turn = 0; turn < 30; ++turn) {
    const double start = seconds();
    if (!ours->shares(views.points(), {of_f0, of_f90, {}, {}}, 0)) std::abort();
    const double between = seconds();
    for (int k = 0; k < ltc_turns; ++k)
      if (!ltc->shares(rect_views.points(), of_f0, of_f90, 0)) std::abort();
    least = std::min(least, between - start), least_ltc = std::min(least_ltc, (seconds() - between) / ltc_turns);
  }
  return least / least_ltc;
}

}  // namespace

int main(int argc, char** argv) {
  const int configurations = argc > 1 ? std::atoi(argv[1]) : 20000;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  const std::string_view only = argc > 3 ? argv[3] : "";
  const std::array<std::pair<std::optional<Kind>, const char*>, 8> shapes{{{Kind::rect, "rect"},
                                                                           {Kind::star, "star"},
                                                                           {Kind::sphere, "sphere"},
                                                                           {std::nullopt, "sun"},
                                                                           {Kind::capsule, "tube"},
                                                                           {Kind::disk, "disk"},
                                                                           {Kind::flat_tube, "flat-tube"},
                                                                           {Kind::open_tube, "open-tube"}}};
  for (const auto& [kind, name] : shapes) {
    if (!only.empty() && only != name) continue;
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
      const Figures f = errors(kind, tolerance, configurations, seed);
      fmt::print("{} {:g} {} {} {:.3g} {:.3g} {:.3g} {:g} {:.0f} {:.0f}\n", name, tolerance, f.count, f.broken, f.worst, f.alpha, f.cosine,
                 f.f0, cost(kind, tolerance, seed, true), cost(kind, tolerance, seed, false));
      std::fflush(stdout);
    }
  }
}
