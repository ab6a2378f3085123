// Unreal Engine 4's surface (Karis 2013, Real Shading in Unreal Engine 4), to Frostbite's and back.
#pragma once

#include "etendue/material.h"

namespace etendue {

// Base colour, metallic and roughness are Disney's; f0 of non-metals is .04. Cavity stands for shadows of what is too small for shadow
// maps: what multiplies all that is reflected. (The notes do not say what it multiplies: this is Frostbite's micro-occlusion.)
struct UnrealSurface {
  Rgb base_colour{0.5, 0.5, 0.5};
  double metallic = 0;
  double roughness = 0.5;
  double cavity = 1;
};

// Exact: with_micro_occlusion({base colour, metallic, roughness, .5}, cavity), so f0 of non-metals is .04 cavity and f90 falls below .02.
Standard standard_of(const UnrealSurface& surface);

struct ToUnreal {
  UnrealSurface surface;
  // Root mean square over the six differences of diffuse and f0: there is one where a non-metal's f0 is not .04 cavity, so above .04, or
  // below it with a base colour too bright for that cavity. Then albedo is kept and f0 is not.
  double residual_rms = 0;
};
// What came from standard_of() comes back.
ToUnreal unreal_of(const Standard& surface);

}  // namespace etendue
