#include "etendue/mitsuba_parts.h"

#include "etendue/material_parameters.h"

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

double index_of(double f0) {
  // eta is infinite at f0 = 1; this bound is an index of 4e6.
  const double root = std::sqrt(std::clamp(f0, 0.0, 0.999999));
  return (1 + root) / (1 - root);
}

// `specular` of Mitsuba's principled for a dielectric f0. It computes eta = 2 / (1 - sqrt(f0)) - 1, so f0 stays below 1; and it renders
// metals black if specular is 0 (Mitsuba issue 443), so they get f0 = 8e-6, which no picture shows.
double specular_of_f0(double f0, double metallic) {
  constexpr double f0_of_full_specular = 0.08;
  const double specular = std::min(f0, 0.999) / f0_of_full_specular;
  return metallic > 0 ? std::max(specular, 1e-4) : specular;
}

struct ToMitsuba {
  SurfaceModel operator()(const Lambert& m) const { return m; }
  SurfaceModel operator()(const Principled& m) const { return m; }
  SurfaceModel operator()(const Conductor& m) const { return m; }
  SurfaceModel operator()(const MetalRough& m) const {
    return Principled{m.base_colour, m.metallic, m.roughness, specular_of_f0(f0_of_ior(m.ior), m.metallic)};
  }
  SurfaceModel operator()(const SpecularGlossiness& m) const { return fit_principled(two_colour_of(m)); }
  SurfaceModel operator()(const Standard& m) const {
    return Principled{m.base_colour, m.metal, m.roughness, specular_of_f0(f0_of_reflectance(m.reflectance), m.metal)};
  }
};

}  // namespace

Conductor conductor_from_f0(const Rgb& f0, double alpha) {
  Conductor conductor;
  conductor.eta = {index_of(f0.x), index_of(f0.y), index_of(f0.z)};
  conductor.k = {0, 0, 0};
  conductor.alpha = alpha;
  return conductor;
}

Material mitsuba_twin(const Material& material, MitsubaParts parts) {
  return parts == MitsubaParts::built_in ? mitsuba_twin(material) : material;
}

Material mitsuba_twin(const Material& material) {
  Material twin = material;
  if (const auto* model = std::get_if<SpecularGlossiness>(&material.model)) {
    if (material.fallback) {
      twin.model = material.fallback->model;
      twin.base_colour_texture = material.fallback->base_colour_texture;
      twin.metal_rough_texture = material.fallback->metal_rough_texture;
    } else if (material.specular_gloss_texture) {
      twin.model = SpecularGlossiness{model->diffuse, {0.04, 0.04, 0.04}, 0.5};
    }
    twin.specular_gloss_texture.reset();
    twin.fallback.reset();
  }
  twin.model = std::visit(ToMitsuba{}, twin.model);
  return twin;
}

std::vector<Unshown> unshown_of(const Material& material) {
  const Lobes& lobes = material.lobes;
  std::vector<Unshown> all;
  const auto name = [&all](bool there, const char* what, const char* effect) {
    if (there) all.push_back({what, effect});
  };
  name(material.blended, "alpha blending", "the surface is opaque, what is behind it is hidden");
  name(lobes.unlit, "unlit", "the surface is lit like any other instead of showing its base colour");
  name(lobes.clearcoat.has_value(), "clearcoat", "the coat's reflection is missing, and what it takes from the layer below");
  name(lobes.sheen.has_value(), "sheen", "the cloth's rim of reflection is missing");
  name(lobes.transmission.has_value(), "transmission", "no light passes through the surface");
  name(lobes.diffuse_transmission.has_value(), "diffuse transmission", "no light passes through the surface");
  name(lobes.volume.has_value(), "volume", "no absorption and no refraction inside the body");
  name(lobes.dispersion.has_value(), "dispersion", "the refraction has no colours");
  name(lobes.specular.has_value(), "specular",
       "the dielectric reflection has the full F0 of its index, without the authored strength and colour");
  name(lobes.iridescence.has_value(), "iridescence", "the thin film's colours are missing");
  name(lobes.anisotropy.has_value(), "anisotropy", "highlights are round");
  return all;
}

}  // namespace etendue
