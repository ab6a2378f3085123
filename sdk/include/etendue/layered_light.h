// What layers reflect as they are, each for itself: what blended() stands for and is measured against.
#pragma once

#include "etendue/eval.h"
#include "etendue/layered_surface.h"

#include <span>

namespace etendue::eval {

// BRDF times cosine, 1/sr, of layers that cover these shares of the place (layer_weights()), each by its own normal. Directions in tangent
// space. A normal is that of the layer, already blended with those below where it is meant to be.
Rgb brdf_cos(std::span<const LayerValue> layers, std::span<const double> weights, const Vec3d& view, const Vec3d& light);

// How far blending is from that: over views at 64 and lights at 1024 directions even over the hemisphere, the root mean square of the
// difference of both over that of the layers' light.
double blending_error(std::span<const LayerValue> layers, std::span<const double> masks, LayerBlend blend);

}  // namespace etendue::eval
