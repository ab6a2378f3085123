// A tube with round caps as the kernels of specular light take it.
#pragma once

#include "light_batch.h"
#include "specular_batch.h"

namespace etendue::eval {

struct PlacedTubeAxis {
  Place a;                 // centre of the first cap
  Direction axis, across;  // unit: to the second one, and any direction across
  float length, radius;
};
// By transformed cosines: SpecularBatch::shares, sizes checked.
std::size_t tube_by_cosines(SpecularRule rule, const PlacedTubeAxis& light, const Emitter& white, const SpecularPoints& points,
                            std::span<float> of_f0, std::span<float> of_f90, float where_none);

}  // namespace etendue::eval
