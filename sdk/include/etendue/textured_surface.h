// A surface model at one place: its factors times what its textures have there.
#pragma once

#include "etendue/material.h"

namespace etendue {

// Linear values of the textures that Material names, 1 where there is none.
struct SurfaceTexels {
  Rgb base_colour{1, 1, 1};  // of SpecularGlossiness: its diffuse colour
  double metallic = 1, roughness = 1;
  Rgb specular{1, 1, 1};
  double glossiness = 1;
};
SurfaceModel textured(const SurfaceModel& model, const SurfaceTexels& texels);

}  // namespace etendue
