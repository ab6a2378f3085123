// Surface models as authored, and the twin that Mitsuba can render.
#pragma once

#include "etendue/image.h"
#include "etendue/vec.h"

#include <optional>
#include <string>
#include <variant>

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

// Smith's shadowing and masking of GGX: height-correlated (the physically consistent one) or the product of both (Mitsuba's).
enum class Masking { correlated, separable };

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

using SurfaceModel = std::variant<Lambert, Principled, Standard, Conductor, MetalRough>;

struct NormalMap {
  Texture texture;
  double scale = 1;
};

struct Material {
  std::string name;
  SurfaceModel model;
  // Textures multiply the model's factor of the same meaning. Metallic is the blue, roughness the green channel (glTF).
  std::optional<Texture> base_colour_texture;
  std::optional<Texture> metal_rough_texture;
  std::optional<NormalMap> normal_map;
  std::optional<double> alpha_cutoff;  // glTF MASK: base colour's alpha below it is a hole
  double base_alpha = 1;               // glTF's baseColorFactor[3]
  bool double_sided = true;
  // Emission of a surface in cd/m2 (glTF emissiveFactor x emissiveStrength): its meshes become mesh lights on import.
  Rgb emissive{0, 0, 0};
  std::optional<Texture> emissive_texture;
  std::string source;
};

// The material as Mitsuba's built-ins render it: MetalRough and Standard become Principled (specular = f0 / .08, at least 1e-4 for
// metals, which Mitsuba renders black without), the others stay as they are.
Material mitsuba_twin(const Material& material);

}  // namespace etendue
