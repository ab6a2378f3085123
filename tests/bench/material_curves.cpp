#include "material_curves.h"

#include "etendue/energy_safe.h"
#include "etendue/layered_light.h"
#include "etendue/material_parameters.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace etendue::bench {

using Json = nlohmann::ordered_json;
using namespace eval;

namespace {

constexpr double roughnesses[] = {0, 0.25, 0.5, 0.75, 1};

// A sphere seen from afar along z: shade(normal) of its pixels.
template <class Shade>
Json sphere(int size, Shade shade) {
  Json pixels = Json::array();
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const double x = (2 * column + 1.0) / size - 1, y = 1 - (2 * row + 1.0) / size, r2 = x * x + y * y;
      shade(r2 < 1 ? Vec3d{x, y, std::sqrt(1 - r2)} : Vec3d{}, pixels);
    }
  }
  return pixels;
}
// To 1e-4; the zero vector is beside the sphere.
double kept(double luminance, const Vec3d& normal) { return normal == Vec3d{} ? -1 : std::round(1e4 * luminance) / 1e4; }

// f(view, light) in the frame of the normal, under a distant light of pi lx: white Lambert facing it has the luminance 1.
template <class BrdfCos>
Rgb lit(const Vec3d& normal, BrdfCos brdf_cos_of) {
  const Basis basis = basis_around(normal);
  const auto local = [&basis](const Vec3d& d) { return Vec3d{dot(d, basis.tangent), dot(d, basis.bitangent), dot(d, basis.normal)}; };
  return pi * brdf_cos_of(local({0, 0, 1}), local(normalised(Vec3d{-0.5, 0.7, 0.5})));
}
Json lit_sphere(int size, const Brdf& brdf) {
  return sphere(size, [&](const Vec3d& normal, Json& pixels) {
    pixels.push_back(kept(lit(normal, [&](const Vec3d& v, const Vec3d& l) { return brdf_cos(brdf, v, l); }).x, normal));
  });
}
Json lit_sphere(int size, std::span<const LayerValue> layers, std::span<const double> weights) {
  return sphere(size, [&](const Vec3d& normal, Json& pixels) {
    const Rgb colour = lit(normal, [&](const Vec3d& v, const Vec3d& l) { return brdf_cos(layers, weights, v, l); });
    for (int c = 0; c < 3; ++c) pixels.push_back(kept(colour[c], normal));
  });
}

}  // namespace

Json smoothness_remaps() {
  Json curves;
  for (int i = 0; i <= 100; ++i) {
    for (const SmoothnessRemap remap : etendue::smoothness_remaps)
      curves[std::string(name_of(remap))].push_back(Json::array({i / 100.0, alpha_of_smoothness(i / 100.0, remap)}));
  }
  return curves;
}

Json specular_occlusions() {
  Json curves;
  for (const double roughness : {0.0, 0.05, 0.1, 0.2, 1.0}) {
    for (int i = 0; i <= 100; ++i)
      curves[fmt::format("roughness {:g}", roughness)].push_back(Json::array({i / 100.0, specular_occlusion(i / 100.0, 0.5, roughness)}));
  }
  return curves;
}

Json standard_albedo_curves() {
  Json panels;
  const auto albedos = standard_albedos();
  for (const double roughness : roughnesses) {
    const std::string name = fmt::format("roughness {:g}", roughness);
    for (int degrees = 0; degrees < 90; degrees += 2) {
      const double cosine = std::cos(degrees * pi / 180);
      const auto add = [&](const char* panel, double value) { panels[panel][name].push_back(Json::array({degrees, value})); };
      add("Disney's diffuse lobe", disney_albedo(roughness, cosine));
      add("renormalised", frostbite_albedo(roughness, cosine));
      const Standard common{{1, 1, 1}, 0, roughness, 0.5}, most{{1, 1, 1}, 0, roughness, 1};
      add("with GGX, f0 = .04", standard_albedo(common, cosine, 1e-5).x);
      add("with GGX, f0 = .16", standard_albedo(most, cosine, 1e-5).x);
      for (const auto& [panel, surface] : {std::pair{"f0 = .04, energy-safe", common}, std::pair{"f0 = .16, energy-safe", most}})
        add(panel, standard_albedo({surface, albedos}, cosine, 1e-5).x);
    }
  }
  return panels;
}

Json masking_spheres(int size) {
  Json rows;
  for (const auto& [material, f0] : {std::pair{"black dielectric", 0.04}, std::pair{"chromium", 0.55}}) {
    for (const auto& [form, masking] : {std::pair{"uncorrelated", Masking::separable}, std::pair{"correlated", Masking::correlated}}) {
      SpecularLobe lobe;
      lobe.masking = masking;
      const auto table = albedo_table(lobe);
      for (const double roughness : {0.2, 0.4, 0.6, 0.8, 1.0}) {
        const double alpha = roughness * roughness, reflectance = f0;
        rows[fmt::format("{}, {}", material, form)][fmt::format("roughness {:g}", roughness)] =
            sphere(size, [&](const Vec3d& normal, Json& pixels) {
              const AlbedoParts parts = albedo_parts(*table, alpha, normal.z);
              pixels.push_back(kept(reflectance * parts.f0_part + parts.f90_part, normal));
            });
      }
    }
  }
  return rows;
}

Json diffuse_spheres(int size) {
  Json rows;
  for (const double roughness : roughnesses) {
    const std::string name = fmt::format("roughness {:g}", roughness);
    rows["Lambert"][name] = lit_sphere(size, Lambert{{0.8, 0.8, 0.8}});
    rows["Disney"][name] = lit_sphere(size, DisneyDiffuse{{0.8, 0.8, 0.8}, roughness});
    rows["renormalised"][name] = lit_sphere(size, FrostbiteDiffuse{{0.8, 0.8, 0.8}, roughness});
  }
  return rows;
}

Json layered_spheres(int size) {
  const auto layer = [](const Rgb& base, double metal, double roughness) {
    LayerValue value;
    value.surface = {base, metal, roughness, 0.5};
    return value;
  };
  const std::pair<const char*, std::array<LayerValue, 2>> pairs[] = {
      {"white, red paint", {layer({0.8, 0.8, 0.8}, 0, 0.5), layer({0.5, 0.05, 0.05}, 0, 0.5)}},
      {"gold, black paint", {layer({1, 0.766, 0.336}, 1, 0.5), layer({0.02, 0.02, 0.02}, 0, 0.5)}},
      {"gold, blue paint", {layer({1, 0.766, 0.336}, 1, 0.5), layer({0.05, 0.1, 0.6}, 0, 0.5)}},
      {"steel, rust", {layer({0.56, 0.57, 0.58}, 1, 0.3), layer({0.25, 0.09, 0.04}, 0, 0.8)}}};
  Json rows;
  const double masks[] = {1, 0.5};
  const std::vector<double> weights = layer_weights(masks);
  constexpr double whole[] = {1};
  for (const auto& [name, layers] : pairs) {
    rows["light of each"][name] = lit_sphere(size, layers, weights);
    const LayerValue parameters[] = {blended(layers, masks)};
    rows["parameters"][name] = lit_sphere(size, parameters, whole);
    const LayerValue colours[] = {blended(layers, masks, NormalBlend::replace, LayerBlend::colours)};
    rows["colours"][name] = lit_sphere(size, colours, whole);
  }
  return rows;
}

}  // namespace etendue::bench
