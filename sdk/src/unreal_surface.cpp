#include "etendue/unreal_surface.h"

#include "etendue/material_fit.h"
#include "etendue/material_parameters.h"

#include <algorithm>
#include <cmath>

namespace etendue {

Standard standard_of(const UnrealSurface& surface) {
  return with_micro_occlusion({surface.base_colour, surface.metallic, surface.roughness, 0.5}, surface.cavity);
}

// f0 asks for a cavity of f0 / .04 = 4 reflectance^2, albedo for one of the brightest channel at least.
ToUnreal unreal_of(const Standard& surface) {
  const Rgb& base = surface.base_colour;
  const double cavity = std::min(std::max({4 * surface.reflectance * surface.reflectance, base.x, base.y, base.z}), 1.0);
  ToUnreal out;
  out.surface = {cavity > 0 ? base / cavity : Rgb{}, surface.metal, surface.roughness, cavity};
  const Standard back = standard_of(out.surface);
  const ColourPair wanted = colour_pair_of({base, surface.metal, surface.reflectance});
  out.residual_rms = std::sqrt(squared_difference({back.base_colour, back.metal, back.reflectance}, wanted) / 6);
  return out;
}

}  // namespace etendue
