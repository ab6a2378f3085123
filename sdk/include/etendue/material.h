// Surface models as authored, and the twin that Mitsuba can render.
#pragma once

#include "etendue/image.h"
#include "etendue/vec.h"

#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace etendue {

// Lambertian reflection, base_colour / pi.
struct Lambert {
  Rgb base_colour{0.5, 0.5, 0.5};
};

// Mitsuba 3's `principled`, by its own names (facts in sdk/docs/mitsuba.md). F0 of the dielectric part = .08 specular.
struct Principled {
  Rgb base_colour{0.5, 0.5, 0.5};
  double metallic = 0;
  double roughness = 0.5;  // alpha = max(.001, roughness^2)
  double specular = 0.5;
};

// Frostbite's standard model: Disney parameters, renormalised Disney diffuse, height-correlated GGX.
struct Standard {
  Rgb base_colour{0.5, 0.5, 0.5};
  double metal = 0;
  double roughness = 0.5;    // perceptually linear; alpha = roughness^2
  double reflectance = 0.5;  // f0 = .16 reflectance^2
};

// Shadowing and masking of facets: Smith's, height-correlated (the physically consistent one) or the product of both (Mitsuba's), or the
// product in Schlick's form x / (x (1 - k) + k) with k = (roughness + 1)^2 / 8 for lights that have a place, alpha / 2 for pictures all
// around (Karis 2013, eq 4).
enum class Masking { correlated, separable, schlick_direct, schlick_image };

// Metal: GGX and the exact Fresnel reflectance of eta + i k per channel (Mitsuba's roughconductor).
struct Conductor {
  Rgb eta{1, 1, 1}, k{0, 0, 0};
  double alpha = 0.1;
  Masking masking = Masking::separable;
};
// Normal-incidence reflectance as a real index: eta = (1 + sqrt f0) / (1 - sqrt f0), k = 0 (Gulbrandsen 2014 with edge tint 0). f0 is
// clamped to [0, .999999].
Conductor conductor_from_f0(const Rgb& f0, double alpha);

// glTF 2.0 metallic-roughness (appendix B), dielectric f0 = .04 (or KHR_materials_ior).
struct MetalRough {
  Rgb base_colour{1, 1, 1};
  double metallic = 1;
  double roughness = 1;
  double ior = 1.5;
};

// glTF's archived KHR_materials_pbrSpecularGlossiness, as authored. Its diffuse albedo is not `diffuse`: see two_colour_of().
struct SpecularGlossiness {
  Rgb diffuse{1, 1, 1};
  Rgb specular{1, 1, 1};  // f0
  double glossiness = 1;  // 1 - roughness
};

using SurfaceModel = std::variant<Lambert, Principled, Standard, Conductor, MetalRough, SpecularGlossiness>;

// Diffuse albedo and normal-incidence reflectance apart: what both models above come to. f = diffuse (1 - F) / pi + the GGX lobe with
// Schlick's F from f0 to 1, separable masking, alpha = roughness^2.
struct TwoColour {
  Rgb diffuse{0.5, 0.5, 0.5};
  Rgb f0{0.04, 0.04, 0.04};
  double roughness = 0.5;
};
// The extension's factor: albedo = diffuse (1 - max(specular)).
TwoColour two_colour_of(const SpecularGlossiness& m);
// Its inverse, as glTF would write it; where max(f0) is 1 or an albedo is over 1 - max(f0) there is none, and diffuse stops at 1.
SpecularGlossiness specular_glossiness_of(const TwoColour& m);
// Mitsuba's model that comes nearest: least squares over diffuse albedo and f0 with F0 = .08 specular (1 - metallic) + base metallic,
// albedo = (1 - metallic) base. Exact where f0 is grey, and for metals.
Principled fit_principled(const TwoColour& m);

struct NormalMap {
  Texture texture;
  double scale = 1;
};

// ---- What glTF's ratified KHR_materials_* add to a surface, each under the extension's name and with its defaults. ----
// A texture multiplies the factor before it, in the channels named. Colours are linear Rec.709, colour textures sRGB.

struct Clearcoat {
  double factor = 0, roughness = 0;
  std::optional<Texture> factor_texture, roughness_texture;  // red; green
  std::optional<NormalMap> normal_map;
};
struct Sheen {
  Rgb colour{0, 0, 0};
  double roughness = 0;
  std::optional<Texture> colour_texture, roughness_texture;  // RGB; alpha
};
struct Transmission {
  double factor = 0;
  std::optional<Texture> factor_texture;  // red
};
struct DiffuseTransmission {
  double factor = 0;
  Rgb colour{1, 1, 1};
  std::optional<Texture> factor_texture, colour_texture;  // alpha; RGB
};
struct Volume {
  double thickness_m = 0;  // in the mesh's space; 0: thin-walled
  double attenuation_distance_m = std::numeric_limits<double>::infinity();
  Rgb attenuation_colour{1, 1, 1};
  std::optional<Texture> thickness_texture;  // green
};
struct Dispersion {
  double value = 0;  // 20 / Abbe number
};
struct Specular {
  double factor = 1;
  Rgb colour{1, 1, 1};
  std::optional<Texture> factor_texture, colour_texture;  // alpha; RGB
};
struct Iridescence {
  double factor = 0, ior = 1.3;
  double min_thickness_nm = 100, max_thickness_nm = 400;
  std::optional<Texture> factor_texture, thickness_texture;  // red; green, from the minimum to the maximum
};
struct Anisotropy {
  double strength = 0, rotation_rad = 0;
  std::optional<Texture> texture;  // red and green the direction, blue the strength
};
struct Lobes {
  std::optional<Clearcoat> clearcoat;
  std::optional<Sheen> sheen;
  std::optional<Transmission> transmission;
  std::optional<DiffuseTransmission> diffuse_transmission;
  std::optional<Volume> volume;
  std::optional<Dispersion> dispersion;
  std::optional<Specular> specular;
  std::optional<Iridescence> iridescence;
  std::optional<Anisotropy> anisotropy;
  bool unlit = false;  // the base colour is shown as it is
};

struct Occlusion {
  Texture texture;  // red
  double strength = 1;
};

// The metallic-roughness twin that a file gives beside another model, for readers that do not know that one.
struct Fallback {
  MetalRough model;
  std::optional<Texture> base_colour_texture, metal_rough_texture;
};

struct Material {
  std::string name;
  SurfaceModel model;
  // Textures multiply the model's factor of the same meaning. Metallic is the blue, roughness the green channel (glTF).
  std::optional<Texture> base_colour_texture;  // of SpecularGlossiness: its diffuse colour
  std::optional<Texture> metal_rough_texture;
  std::optional<Texture> specular_gloss_texture;  // of SpecularGlossiness: sRGB specular colour, linear glossiness in alpha
  std::optional<NormalMap> normal_map;
  std::optional<double> alpha_cutoff;  // glTF MASK: base colour's alpha below it is a hole
  double base_alpha = 1;               // glTF's baseColorFactor[3]
  bool blended = false;                // glTF BLEND: alpha is coverage
  bool double_sided = true;
  // Emission of a surface in cd/m2 (glTF emissiveFactor x emissiveStrength): its meshes become mesh lights on import.
  Rgb emissive{0, 0, 0};
  std::optional<Texture> emissive_texture;
  std::string source;
  std::optional<Occlusion> occlusion;  // of indirect light alone
  Lobes lobes;
  std::optional<Fallback> fallback;
};

// Every texture with its role, "base_colour", "clearcoat.roughness": visit(const char* role, texture). `M` may be const.
template <class M, class Visit>
void for_each_texture(M& material, Visit visit) {
  const auto one = [&visit](const char* role, auto& texture) {
    if (texture) visit(role, *texture);
  };
  const auto normal = [&visit](const char* role, auto& map) {
    if (map) visit(role, map->texture);
  };
  one("base_colour", material.base_colour_texture);
  one("metal_rough", material.metal_rough_texture);
  one("specular_gloss", material.specular_gloss_texture);
  normal("normal", material.normal_map);
  one("emissive", material.emissive_texture);
  normal("occlusion", material.occlusion);
  auto& lobes = material.lobes;
  if (lobes.clearcoat) {
    one("clearcoat.factor", lobes.clearcoat->factor_texture);
    one("clearcoat.roughness", lobes.clearcoat->roughness_texture);
    normal("clearcoat.normal", lobes.clearcoat->normal_map);
  }
  if (lobes.sheen) {
    one("sheen.colour", lobes.sheen->colour_texture);
    one("sheen.roughness", lobes.sheen->roughness_texture);
  }
  if (lobes.transmission) one("transmission.factor", lobes.transmission->factor_texture);
  if (lobes.diffuse_transmission) {
    one("diffuse_transmission.factor", lobes.diffuse_transmission->factor_texture);
    one("diffuse_transmission.colour", lobes.diffuse_transmission->colour_texture);
  }
  if (lobes.volume) one("volume.thickness", lobes.volume->thickness_texture);
  if (lobes.specular) {
    one("specular.factor", lobes.specular->factor_texture);
    one("specular.colour", lobes.specular->colour_texture);
  }
  if (lobes.iridescence) {
    one("iridescence.factor", lobes.iridescence->factor_texture);
    one("iridescence.thickness", lobes.iridescence->thickness_texture);
  }
  if (lobes.anisotropy) one("anisotropy", lobes.anisotropy->texture);
  if (material.fallback) {
    one("fallback.base_colour", material.fallback->base_colour_texture);
    one("fallback.metal_rough", material.fallback->metal_rough_texture);
  }
}

// What a material says that no picture of ours or of Mitsuba shows, and the effect of leaving it out.
struct Unshown {
  const char* what;    // "clearcoat"
  const char* effect;  // "the coat's reflection is missing, and what it takes from the layer below"
};
std::vector<Unshown> unshown_of(const Material& material);

// The material as Mitsuba's built-ins render it: MetalRough and Standard become Principled (specular = f0 / .08, at least 1e-4 for
// metals, which Mitsuba renders black without), SpecularGlossiness its fallback's twin, or without one fit_principled() of its factors
// (of a dielectric with f0 = .04 and glossiness .5 where they are textured); the others stay as they are.
Material mitsuba_twin(const Material& material);

}  // namespace etendue
