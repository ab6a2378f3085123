#include "lobe_curves.h"

#include "etendue/directional_albedo.h"

#include <cmath>
#include <string>
#include <utility>

namespace etendue::bench {

using Json = nlohmann::ordered_json;
using namespace eval;

Json specular_albedos(double alpha) {
  struct Kind {
    const char* name;
    Distribution distribution;
    Masking masking;
  };
  constexpr Kind kinds[] = {{"GGX, correlated", Distribution::ggx, Masking::correlated},
                            {"GGX, separable", Distribution::ggx, Masking::separable},
                            {"GGX, Schlick, k = alpha / 2", Distribution::ggx, Masking::schlick_image},
                            {"GGX, Schlick, k = (roughness + 1)^2 / 8", Distribution::ggx, Masking::schlick_direct},
                            {"Beckmann, correlated", Distribution::beckmann, Masking::correlated},
                            {"Blinn-Phong, correlated", Distribution::blinn_phong, Masking::correlated},
                            {"Phong", Distribution::phong, Masking::correlated}};
  Json curves;
  for (int degrees = 0; degrees < 90; ++degrees) {
    const Vec3d view{std::sin(degrees * pi / 180), 0, std::cos(degrees * pi / 180)};
    for (const Kind& kind : kinds) {
      SpecularLobe lobe;
      lobe.distribution = kind.distribution;
      lobe.alpha_x = lobe.alpha_y = alpha;
      lobe.masking = kind.masking;
      curves[kind.name].push_back(Json::array({degrees, directional_albedo(lobe, view, 1e-5).sum()}));
    }
  }
  return curves;
}

Json passed_on_light() {
  Json curves;
  const Vec3d view{std::sqrt(0.5), 0, std::sqrt(0.5)};
  for (int i = 0; i <= 40; ++i) {
    SpecularLobe lobe;
    lobe.alpha_x = lobe.alpha_y = std::max(i / 40.0, 1e-3);
    lobe.f0 = {1, 0.71, 0.29};
    const Rgb once = reflectance(lobe, view, 1e-5).value;
    lobe.compensation = albedo_curve(lobe);
    const Rgb all = reflectance(lobe, view, 1e-5).value;
    constexpr const char* channels[] = {"red", "green", "blue"};
    for (int c = 0; c < 3; ++c) {
      curves[std::string(channels[c]) + ", all light"].push_back(Json::array({lobe.alpha_x, all[c]}));
      curves[std::string(channels[c]) + ", one reflection"].push_back(Json::array({lobe.alpha_x, once[c]}));
    }
  }
  return curves;
}

Json fresnel_terms() {
  SpecularLobe glass, gaussian, exact, gold;
  gaussian.fresnel = Fresnel::schlick_gaussian;
  exact.fresnel = Fresnel::dielectric;
  gold.fresnel = Fresnel::conductor;
  gold.eta = {0.42, 0.42, 0.42};
  gold.k = {2.35, 2.35, 2.35};
  SpecularLobe schlick_gold;
  schlick_gold.f0 = Rgb{1, 1, 1} * fresnel_reflectance(gold, 1).x;
  const std::pair<const char*, const SpecularLobe*> lobes[] = {{"glass, n = 1.5", &exact},
                                                               {"Schlick, f0 = .04", &glass},
                                                               {"its Gaussian form", &gaussian},
                                                               {"gold, .42 + 2.35 i", &gold},
                                                               {"Schlick of gold's f0", &schlick_gold}};
  Json curves;
  for (int half = 0; half <= 180; ++half) {
    for (const auto& [name, lobe] : lobes)
      curves[name].push_back(Json::array({0.5 * half, fresnel_reflectance(*lobe, std::cos(half * pi / 360)).x}));
  }
  return curves;
}

}  // namespace etendue::bench
