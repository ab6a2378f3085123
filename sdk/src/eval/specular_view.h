// Lights and surfaces as the specular methods by name take them, and the parts of their list.
#pragma once

#include "etendue/specular_methods.h"

#include <optional>
#include <span>

namespace etendue::eval {

// Round height-correlated GGX with Schlick's Fresnel, under either name; nothing for any other BRDF.
std::optional<GgxLobe> correlated_ggx(const Brdf& brdf);
// An area light of one luminance, without a window.
bool is_uniform_area_light(const Emitter& emitter);
// cd/m2 of such a light: of a sun its illuminance over pi sin^2 of its angular radius.
Rgb luminance_of(const Emitter& emitter);

std::span<const SpecularMethod> ltc_methods();

}  // namespace etendue::eval
