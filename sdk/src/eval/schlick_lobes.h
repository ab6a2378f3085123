// Surfaces as the sum of a round GGX lobe with Schlick's Fresnel and of a diffuse lobe that has no peak.
#pragma once

#include "etendue/eval.h"

#include <optional>

namespace etendue::eval {

struct SchlickLobes {
  GgxLobe specular;
  std::optional<Brdf> diffuse;
};

// Standard, MetalRough, TwoColour, Principled without a dielectric part, round GGX alone; nothing for surfaces that are no such sum.
std::optional<SchlickLobes> schlick_lobes(const Brdf& brdf);

}  // namespace etendue::eval
