#include "specular_curves.h"

#include "etendue/specular_methods.h"
#include "eval_protocol.h"
#include "ratio_rules.h"

#include <array>
#include <cmath>
#include <string>

namespace etendue::bench {

using Json = nlohmann::ordered_json;
using namespace eval;

// Of 15 degrees' half angle, alpha .1, seen at 45 degrees. It moves across the plane of incidence.
Json sphere_highlights() {
  constexpr double alpha = 0.1, half_angle = 15, slope = 45;
  Json curves;
  const Vec3d n{0, 0, 1}, view{std::sin(slope * pi / 180), 0, std::cos(slope * pi / 180)};
  const GgxLobe lobe{alpha, {1, 1, 1}};
  const ShadingPoint point{{}, n, n, view, lobe};
  for (int i = 0; i <= 80; ++i) {
    const double away = 0.5 * i, sine = std::sin(away * pi / 180), cosine = std::cos(away * pi / 180);
    const Vec3d mirror{-view.x, 0, view.z};
    const Emitter light = protocol::white(SphereEmitter{mirror * cosine + Vec3d{0, 1, 0} * sine, std::sin(half_angle * pi / 180)});
    const auto add = [&](const char* name, double value) { curves[name].push_back(Json::array({away, value})); };
    add("reference", reference(light, point, {1e-6, 1e-9}).value.x);
    for (const char* name : {"karis-10", "karis-14", "frostbite-16", "drobot-1-20-fitted", "karis-cone", "moments"})
      add(name, find_specular_method(name)->luminance(light, point)->x);
  }
  return curves;
}

Json rect_method_errors() {
  constexpr int steps = 16, lights = 300;
  constexpr std::array names{"frostbite-point", "drobot-1-20-mended", "drobot-elongated", "karis-billboard",
                             "ltc-unclipped",   "ltc-two-lobes",      "moments"};
  Json curves;
  for (int i = 0; i <= steps; ++i) {
    const double alpha = std::pow(10, -3 + 3.0 * i / steps);
    protocol::Random random(12);
    std::array<protocol::Aggregate, names.size()> errors;
    for (int k = 0; k < lights; ++k) {
      const protocol::Placement p = protocol::place(protocol::Kind::rect, random, true);
      Vec3d view = random.direction();
      if (k % 2 == 0) {
        const Vec3d l = sample_light(p.emitter, p.position, random.square()).direction;
        view = p.normal * (2 * dot(p.normal, l)) - l;
      }
      if (dot(view, p.normal) < 0.05) continue;
      const ShadingPoint point{p.position, p.normal, p.normal, view, GgxLobe{alpha, {0.04, 0.04, 0.04}}};
      const double exact = reference(p.emitter, point, {1e-5, 1e-9}).value.x;
      for (std::size_t m = 0; m < names.size(); ++m) errors[m].add(find_specular_method(names[m])->luminance(p.emitter, point)->x, exact);
    }
    for (std::size_t m = 0; m < names.size(); ++m) curves[names[m]].push_back(Json::array({alpha, errors[m].share()}));
  }
  return curves;
}

}  // namespace etendue::bench
