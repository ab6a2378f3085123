// The standard model and its energy-safe variant over a dense grid of their parameters and views, white: one JSON document. Argument:
// steps of roughness (100).
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "../eval_protocol.h"
#include "etendue/energy_safe.h"
#include "etendue/material_parameters.h"

namespace {

using namespace etendue;
using namespace etendue::eval;
using Json = nlohmann::ordered_json;

struct Most {
  double value = 0, roughness = 0, f0 = 0, cosine = 0;
  void look(double albedo, const Standard& s, double at) {
    if (albedo > value) value = albedo, roughness = s.roughness, f0 = f0_of_reflectance(s.reflectance), cosine = at;
  }
  Json json() const { return {{"albedo", value}, {"roughness", roughness}, {"f0", f0}, {"cosine", cosine}}; }
};

// Worst relative difference of f(v, l) and f(l, v).
template <class BrdfCos>
double irreciprocity(int count, BrdfCos brdf_cos_of) {
  protocol::Random random(5);
  double worst = 0;
  for (int i = 0; i < count; ++i) {
    Vec3d v = random.direction(), l = random.direction();
    v.z = std::abs(v.z) + 1e-4, l.z = std::abs(l.z) + 1e-4;
    v = normalised(v), l = normalised(l);
    Standard surface;
    for (int c = 0; c < 3; ++c) surface.base_colour[c] = random.uniform(0, 1);
    surface.metal = random.uniform(0, 1);
    surface.roughness = random.uniform(0.02, 1);
    surface.reflectance = random.uniform(0, 1);
    const Rgb there = brdf_cos_of(surface, v, l) / l.z, back = brdf_cos_of(surface, l, v) / v.z;
    for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(there[c] - back[c]) / std::max(there[c], 1e-12));
  }
  return worst;
}

}  // namespace

int main(int argc, char** argv) {
  const int steps = argc > 1 ? std::atoi(argv[1]) : 100;
  const auto albedos = standard_albedos();
  std::vector<double> cosines{1e-4, 3e-4, 1e-3, 3e-3, 0.01, 0.02, 0.03, 0.04};
  for (int i = 5; i <= 100; i += i < 20 ? 1 : 4) cosines.push_back(i / 100.0);
  Most plain, grazing, safe, metallic;
  for (int i = 0; i <= steps; ++i) {
    for (const double reflectance : {0.0, 0.125, 0.25, 0.35, 0.5, 0.65, 0.8, 0.9, 1.0}) {
      for (const double metal : {0.0, 0.02, 0.1, 0.3, 0.6, 0.9}) {
        const EnergySafeStandard surface{{{1, 1, 1}, metal, static_cast<double>(i) / steps, reflectance}, albedos};
        for (const double cosine : cosines) {
          safe.look(standard_albedo(surface, cosine, 1e-5).x, surface.surface, cosine);
          const double albedo = standard_albedo(surface.surface, cosine, 1e-5).x;
          if (metal > 0) {
            metallic.look(albedo, surface.surface, cosine);
          } else {
            (cosine < 0.05 ? grazing : plain).look(albedo, surface.surface, cosine);
          }
        }
      }
    }
  }
  const Json all{
      {"plain", plain.json()},
      {"grazing", grazing.json()},
      {"metallic", metallic.json()},
      {"safe", safe.json()},
      {"irreciprocity", irreciprocity(1000000, [](const Standard& s, const Vec3d& v, const Vec3d& l) { return brdf_cos(Brdf(s), v, l); })},
      {"safe_irreciprocity", irreciprocity(1000000,
                                           [&](const Standard& s, const Vec3d& v, const Vec3d& l) {
                                             return brdf_cos(EnergySafeStandard{s, albedos}, v, l);
                                           })},
      {"f0", {{"water", f0_of_ior(1.333)}, {"reflectance_half", f0_of_reflectance(0.5)}, {"diamond", f0_of_ior(2.417)}}},
      {"diamond_by_reflectance", f0_of_reflectance(reflectance_of_f0(f0_of_ior(2.417)).value)},
      {"diamond_clamped", reflectance_of_f0(f0_of_ior(2.417)).clamped}};
  std::printf("%s\n", all.dump().c_str());
  return 0;
}
