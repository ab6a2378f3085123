// glTF's lobes by Mitsuba's built-in surfaces: what `principled` and `principledthin` have for them, and what is lost all the same.
#pragma once

#include "etendue/io.h"
#include "etendue/material.h"

#include <optional>
#include <vector>

namespace etendue::mitsuba {

// A surface is bsdf_0 = `principled`, blended with what lets light through: what is diffused into the other side, and over both what
// passes in a direction. A texture multiplies its weight.
struct ShownLobes {
  // Of `principled`; where there is no value the twin's own stays.
  std::optional<double> specular, roughness, metallic;
  double anisotropic = 0;
  double clearcoat = 0, clearcoat_gloss = 0;
  std::optional<Texture> clearcoat_texture;  // red
  double sheen = 0, sheen_tint = 0;

  double diffused = 0;  // weight of a `principledthin` that sends all diffuse light to the other side
  Rgb diffused_colour{1, 1, 1};
  std::optional<Texture> diffused_texture, diffused_colour_texture;  // alpha; RGB
  double passed = 0;                                                 // weight of what lets light pass
  std::optional<Texture> passed_texture;                             // red
  bool solid = false;                                                // it has an inside, `principled`; else `principledthin`
  double ior = 1.5;
  std::optional<Rgb> absorption_per_m;  // of the inside
  bool blended = false;                 // alpha is coverage

  std::vector<Loss> losses;  // unshown_losses() without what is shown as it is; of the others what is lost all the same

  bool transmits() const { return diffused > 0 || passed > 0; }
};
// `max_depth`: Mitsuba's, of the path; -1 has no end.
ShownLobes shown_lobes(const Material& material, int max_depth);
// Its absorption_per_m alone.
std::optional<Rgb> absorption_of(const Material& material);

}  // namespace etendue::mitsuba
