#include "diffuse_curves.h"

#include "etendue/microfacet_diffuse.h"
#include "eval/quadrature.h"
#include "ratio_rules.h"

#include <cmath>
#include <map>
#include <string>

namespace etendue::bench {

using Json = nlohmann::ordered_json;
using namespace eval;

namespace {

// Over the hemisphere of light: Kronrod's 15 nodes in its cosine, 32 azimuths of which half are mirrored.
double reflectance(const LambertianFacets& facets, const Vec3d& view) {
  constexpr int azimuths = 16;
  double sum = 0;
  for (const KronrodNode& node : kronrod15().nodes) {
    const double z = 0.5 * (1 + node.x), r = std::sqrt(1 - z * z);
    for (int k = 0; k < azimuths; ++k) {
      const double phi = pi * (k + 0.5) / azimuths;
      sum += 0.5 * node.weight * brdf_cos(facets, view, {r * std::cos(phi), r * std::sin(phi), z}, 1e-5).value;
    }
  }
  return 2 * pi * sum / azimuths;
}

}  // namespace

Json diffuse_reflectances(double roughness) {
  Json curves;
  Emitter sky;
  sky.shape = EnvironmentEmitter{};
  sky.radiance = {1, 1, 1};
  const double alpha = roughness * roughness;
  for (int degrees = 0; degrees < 90; degrees += 2) {
    const Vec3d view{std::sin(degrees * pi / 180), 0, std::cos(degrees * pi / 180)};
    const auto add = [&](const std::string& name, double value) { curves[name].push_back(Json::array({degrees, value})); };
    for (const protocol::DiffuseModel& model : protocol::diffuse_models)
      add(std::string(model.name), reference(sky, {{}, {0, 0, 1}, {0, 0, 1}, view, model.of(roughness)}, {1e-5, 0}).value.x);
    add("facets", reflectance({alpha}, view));
    add("facets under Fresnel", reflectance({alpha, Masking::correlated, FacetInterface::both_ways}, view));
  }
  return curves;
}

Json diffuse_rule_errors() {
  Json curves;
  const Brdf brdf = DisneyDiffuse{{1, 1, 1}, 1};
  constexpr int steps = 25, lights = 300;
  for (int i = 0; i < steps; ++i) {
    const double distance = 0.5 * std::pow(40, i / (steps - 1.0));
    protocol::Random random(9);
    std::map<std::string_view, protocol::Aggregate> errors;
    for (int done = 0; done < lights;) {
      const Vec3d towards = random.direction(), normal = random.direction(), view = random.direction();
      const Basis b = basis_around(normal);
      const double roll = random.uniform(0, 2 * pi);
      const Vec3d x = b.tangent * std::cos(roll) + b.bitangent * std::sin(roll);
      const Emitter light = protocol::white(protocol::rectangle(towards * distance, x, cross(normal, x), 1, 1));
      const Vec3d up{0, 0, 1};
      if (dot(normal, towards) > -0.2 || view.z < 0.05 || protocol::lowest(light.shape, {}, up) < 1e-3) continue;
      ++done;
      const ShadingPoint point{{}, up, up, view, brdf};
      const double exact = reference(light, point, {1e-8, 1e-12}).value.x;
      errors["ratio"].add(diffuse_luminance(light, point)->value.x, exact);
      for (const DiffuseRule& rule : diffuse_rules()) errors[rule.name].add(rule.luminance(light, point)->x, exact);
    }
    for (const auto& [name, error] : errors) curves[std::string(name)].push_back(Json::array({distance, error.share()}));
  }
  return curves;
}

}  // namespace etendue::bench
