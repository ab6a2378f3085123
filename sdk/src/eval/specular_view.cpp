#include "specular_view.h"

#include <cmath>

namespace etendue::eval {

std::optional<GgxLobe> correlated_ggx(const Brdf& brdf) {
  if (const auto* ggx = std::get_if<GgxLobe>(&brdf)) return ggx->masking == Masking::correlated ? std::optional(*ggx) : std::nullopt;
  const auto* lobe = std::get_if<SpecularLobe>(&brdf);
  if (lobe == nullptr || lobe->distribution != Distribution::ggx || lobe->alpha_x != lobe->alpha_y) return std::nullopt;
  if (lobe->masking != Masking::correlated || lobe->fresnel != Fresnel::schlick || lobe->compensation != nullptr) return std::nullopt;
  return GgxLobe{lobe->alpha_x, lobe->f0, lobe->f90, lobe->masking};
}

bool is_uniform_area_light(const Emitter& emitter) {
  if (!has_closed_form(emitter) || is_window(emitter.window)) return false;
  if (const auto* sun = std::get_if<DistantEmitter>(&emitter.shape)) return sun->radius_rad > 0;
  return !std::holds_alternative<PunctualEmitter>(emitter.shape) && !std::holds_alternative<LineEmitter>(emitter.shape);
}

Rgb luminance_of(const Emitter& emitter) {
  const auto* sun = std::get_if<DistantEmitter>(&emitter.shape);
  if (sun == nullptr) return emitter.radiance;
  const double sine = std::sin(sun->radius_rad);
  return sun->illuminance / (pi * sine * sine);
}

}  // namespace etendue::eval
