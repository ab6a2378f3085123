// What artists' sliders mean: smoothness, reflectance, index of refraction, occlusion; each with its way back.
#pragma once

#include "etendue/material.h"

#include <array>
#include <optional>
#include <string_view>

namespace etendue {

// ---- Smoothness s to the alpha of a lobe (Lagarde and de Rousiers 2014, figure 12) ----

enum class SmoothnessRemap {
  linear,   // 1 - s
  squared,  // (1 - s)^2: Burley's and Frostbite's
  quartic,  // (1 - s)^4
  ryse,     // (1 - .7 s)^6: Crytek's (Schulz 2014); alpha ends at .000729
};
inline constexpr std::array<SmoothnessRemap, 4> smoothness_remaps{SmoothnessRemap::linear, SmoothnessRemap::squared,
                                                                  SmoothnessRemap::quartic, SmoothnessRemap::ryse};
std::string_view name_of(SmoothnessRemap remap);
std::optional<SmoothnessRemap> smoothness_remap_named(std::string_view name);
// Smoothness within [0, 1].
double alpha_of_smoothness(double smoothness, SmoothnessRemap remap = SmoothnessRemap::squared);
// The way back; an alpha that the remap does not reach becomes its nearest.
double smoothness_of_alpha(double alpha, SmoothnessRemap remap = SmoothnessRemap::squared);

// ---- Reflectance at normal incidence ----

// f0 = .16 reflectance^2, reflectance within [0, 1].
double f0_of_reflectance(double reflectance);
// From air: ((n - 1) / (n + 1))^2. n from 1; 0 means a mirror, f0 = 1, as in KHR_materials_ior.
double f0_of_ior(double ior);
double ior_of_f0(double f0);  // the one from 1 on; 0 for f0 = 1

// A slider that ends before what is asked of it: diamond's f0 of .172 becomes .16.
struct Clamped {
  double value = 0;
  bool clamped = false;
};
Clamped reflectance_of_f0(double f0);

// ---- Occlusion (Lagarde and de Rousiers 2014, 4.10) ----

// Cavities too small for shadow maps, for direct and indirect light alike; `visible`, what of the light gets in, within [0, 1]. Albedo and
// f0 are multiplied by it: the base colour, and for dielectrics reflectance^2. Where f0 falls below .02, less than any real surface has,
// f90 = 50 f0 falls with it (micro_occlusion_f90, eval.h).
Standard with_micro_occlusion(const Standard& surface, double visible);

// Of indirect light alone. Several ambient occlusions make the least of them.
struct IndirectOcclusion {
  double diffuse = 1, specular = 1;
};
IndirectOcclusion indirect_occlusion(double baked, double screen_space, double n_dot_v, double roughness);
// Listing 26: saturate((n.v + ao)^(2^(-16 roughness - 1)) - 1 + ao), an empirical one. Rough surfaces keep ao.
double specular_occlusion(double n_dot_v, double ambient_occlusion, double roughness);

// ---- Older materials ----

// A diffuse colour, a specular colour and the exponent of Blinn-Phong's lobe, as engines before physically based ones had them,
// unnormalised.
struct OldMaterial {
  Rgb diffuse{0.5, 0.5, 0.5}, specular{0.2, 0.2, 0.2};
  double exponent = 32;
};
struct FromOld {
  Standard surface;
  // Root mean square over the six differences of diffuse and f0 to what the old material says.
  double residual_rms = 0;
  bool energy_limited = false;  // the two colours summed up to more than 1, and were scaled down together
};
// alpha = sqrt(2 / (n + 2)), the specular colour as f0: what is told by no number is that artists chose both by eye, under lights of
// another scale.
FromOld standard_of(const OldMaterial& old);

}  // namespace etendue
