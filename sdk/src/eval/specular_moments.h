// Specular light by moments over the space in which GGX is a clamped cosine. Derivation: sdk/docs/specular.md.
#pragma once

#include "etendue/eval.h"

namespace etendue::eval {

// What an area light of the luminance 1 everywhere, which has an outline (local.h), gives towards the view. `lobe` is height-correlated.
Rgb by_moments(const Emitter& emitter, const ShadingPoint& point, const GgxLobe& lobe);

}  // namespace etendue::eval
