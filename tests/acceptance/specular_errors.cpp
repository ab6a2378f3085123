// Prints one line a method, shape and f0: name, shape, f0, aggregate error (sum of |x - reference| over that of the reference), 99th
// percentile of the relative, largest absolute, aggregate at the worst alpha, that alpha, and how many answers are no finite light. Half of
// the lights cross the horizon; half of the views have the mirror direction inside the light, half are uniform with a cosine in [.05, 1].
// Lines have 1 cd across. And of suns of 9.3 mrad, wholly above the horizon, on alpha .001.
#include "etendue/specular_methods.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <vector>

#include "eval_protocol.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using namespace etendue::eval::protocol;

constexpr double alphas[] = {0.01, 0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1};

Vec3d view_for(const Placement& p, bool mirrored, Random& random) {
  constexpr int attempts = 1000;  // a line may have nothing but grazing light
  for (int attempt = 0;; ++attempt) {
    Vec3d view = random.direction();
    if (mirrored && attempt < attempts) {
      const LightSample s = sample_light(p.emitter, p.position, random.square());
      if (!(s.pdf > 0) || !(dot(s.direction, p.normal) > 0)) continue;
      view = p.normal * (2 * dot(p.normal, s.direction)) - s.direction;
    }
    if (dot(view, p.normal) >= 0.05) return view;
  }
}

struct Sums {
  double error = 0, reference = 0;
  double agg() const { return reference > 0 ? error / reference : 0; }
};
struct Errors {
  Sums at[std::size(alphas)];
  std::vector<double> relative;
  double largest = 0;
  int bad = 0;

  void add(std::size_t alpha, double value, double expected) {
    if (!(std::isfinite(value) && value >= 0)) ++bad;
    const double off = std::abs(value - expected);
    at[alpha].error += off, at[alpha].reference += expected;
    largest = std::max(largest, off);
    if (expected > 1e-6) relative.push_back(off / expected);
  }
};

// A sun of the luminance 1.
Placement place_sun(Random& random) {
  constexpr double radius = 0.00465;
  for (;;) {
    Placement p{{}, {}, random.direction(), random.direction()};
    if (dot(p.normal, p.towards) < 0.05 + radius) continue;  // so that some view has the cosine .05
    const double lux = pi * std::sin(radius) * std::sin(radius);
    p.emitter.shape = DistantEmitter{p.towards, {lux, lux, lux}, radius};
    return p;
  }
}

struct Group {
  std::string_view name;
  std::optional<Kind> kind;  // none: the sun
  std::vector<double> alphas;
};

}  // namespace

int main(int argc, char** argv) {
  const int geometries = argc > 1 ? std::atoi(argv[1]) : 1000;
  const std::vector<double> every(std::begin(alphas), std::end(alphas));
  const Group groups[] = {{"rect", Kind::rect, every},    {"sphere", Kind::sphere, every}, {"disk", Kind::disk, every},
                          {"tube", Kind::capsule, every}, {"line", Kind::line, every},     {"sun", std::nullopt, {0.001}}};
  for (const Group& group : groups) {
    const auto methods = specular_methods();
    std::vector<Errors> errors(2 * methods.size());
    Random random(2016 + (group.kind ? static_cast<std::uint64_t>(*group.kind) : 100));
    for (int i = 0; i < geometries; ++i) {
      const Placement p = group.kind ? place(*group.kind, random, i % 2 == 0) : place_sun(random);
      for (std::size_t a = 0; a < group.alphas.size(); ++a) {
        const Vec3d view = view_for(p, i % 4 < 2, random);
        for (const std::size_t dielectric : {std::size_t{0}, std::size_t{1}}) {
          const double f0 = dielectric != 0 ? 0.04 : 1;
          const ShadingPoint point{p.position, p.normal, p.normal, view, GgxLobe{group.alphas[a], {f0, f0, f0}}};
          const double expected = reference(p.emitter, point, {1e-5, 1e-9}).value.x;
          for (std::size_t m = 0; m < methods.size(); ++m) {
            if (const auto value = methods[m].luminance(p.emitter, point)) errors[2 * m + dielectric].add(a, value->x, expected);
          }
        }
      }
    }
    for (std::size_t row = 0; row < errors.size(); ++row) {
      Errors& e = errors[row];
      if (e.relative.empty()) continue;
      std::sort(e.relative.begin(), e.relative.end());
      Sums all;
      for (const Sums& s : e.at) all.error += s.error, all.reference += s.reference;
      const auto* worst =
          std::max_element(std::begin(e.at), std::end(e.at), [](const Sums& x, const Sums& y) { return x.agg() < y.agg(); });
      fmt::print("{} {} {} {:.4g} {:.4g} {:.4g} {:.4g} {} {}\n", methods[row / 2].name, group.name, row % 2 == 0 ? "1" : ".04", all.agg(),
                 e.relative[e.relative.size() * 99 / 100], e.largest, worst->agg(),
                 group.alphas[static_cast<std::size_t>(worst - std::begin(e.at))], e.bad);
    }
  }
}
