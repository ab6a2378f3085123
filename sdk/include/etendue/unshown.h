// What no picture shows of a material, in numbers.
#pragma once

#include "etendue/io.h"
#include "etendue/material.h"

#include <vector>

namespace etendue {

// What unshown_of() names, in its order, each effect followed by how much it is. Textures are taken for white: a number is the most that it
// can be.
std::vector<Loss> unshown_losses(const Material& material);

// Mean of Schlick's reflectance over the light of a white sky: f0 + (1 - f0) 2 integral of (1 - c)^5 c dc = f0 + (1 - f0) / 21.
double schlick_albedo(double f0);

// Reflectances from ahead of a transparent film between air and a surface of normal-incidence reflectance f0, over all of its thicknesses.
// With r and s the amplitudes of its two faces the rays' sum is (r + s e^it) / (1 + r s e^it) (Born and Wolf 7.6, Airy), so the reflectance
// lies between ((|r| - |s|) / (1 - |r s|))^2 and ((|r| + |s|) / (1 + |r s|))^2.
struct ReflectanceRange {
  double least = 0, most = 0;
};
ReflectanceRange film_reflectance(double film_ior, double f0);

}  // namespace etendue
