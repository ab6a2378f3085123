// Disney parameters of many diffuse albedos and f0s at once, in float, on the best instruction set that the machine has.
#pragma once

#include "etendue/material_fit.h"
#include "etendue/result.h"

#include <span>

namespace etendue {

// Where the results go: as many elements as there are pairs, else BATCH_SIZES_DIFFER.
struct DisneyColumns {
  std::span<Vec3f> base_colour;
  std::span<float> metal, reflectance;
};

// fit_disney (material_fit.h) is the definition. The rms of what comes out is within 1e-4 of the optimum's for at least 99.99 % of inputs
// of six random numbers from 0 to 1 and of the texels of every specular-glossiness asset measured, and half an 8-bit step (1/510) above
// it has not been found (tests/acceptance/materials measures both). NaN counts as 0, numbers beyond +-65504 as those. Metal 0 is
// preferred, then 1, where their rms is within about 1e-5 of the best.
Status fit_disney(std::span<const Vec3f> diffuse, std::span<const Vec3f> f0, DisneyColumns out,
                  DielectricF0 dielectric = DielectricF0::free);

}  // namespace etendue
