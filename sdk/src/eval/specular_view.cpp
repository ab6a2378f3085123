#include "specular_view.h"

#include "facets.h"
#include "microfacet.h"

#include <cmath>

namespace etendue::eval {

std::optional<GgxLobe> round_ggx(const Brdf& brdf) {
  if (const auto* ggx = std::get_if<GgxLobe>(&brdf)) return *ggx;
  const auto* lobe = std::get_if<SpecularLobe>(&brdf);
  if (lobe == nullptr || lobe->distribution != Distribution::ggx || lobe->alpha_x != lobe->alpha_y) return std::nullopt;
  if (lobe->fresnel != Fresnel::schlick || lobe->compensation != nullptr) return std::nullopt;
  return GgxLobe{lobe->alpha_x, lobe->f0, lobe->f90, lobe->masking};
}
std::optional<GgxLobe> correlated_ggx(const Brdf& brdf) {
  const std::optional<GgxLobe> lobe = round_ggx(brdf);
  return lobe && lobe->masking == Masking::correlated ? lobe : std::nullopt;
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

namespace {

SpecularLobe general(const GgxLobe& lobe) {
  return {.alpha_x = lobe.alpha, .alpha_y = lobe.alpha, .masking = lobe.masking, .f0 = lobe.f0, .f90 = lobe.f90};
}
std::optional<SpecularLobe> taken_lobe(const Brdf& brdf, Lobes lobes) {
  if (lobes == Lobes::correlated_ggx) {
    const std::optional<GgxLobe> ggx = correlated_ggx(brdf);
    return ggx ? std::optional(general(*ggx)) : std::nullopt;
  }
  if (const auto* ggx = std::get_if<GgxLobe>(&brdf)) return general(*ggx);
  const auto* lobe = std::get_if<SpecularLobe>(&brdf);
  if (lobe == nullptr || lobe->alpha_x != lobe->alpha_y || lobe->compensation != nullptr) return std::nullopt;
  if (lobes == Lobes::ggx && lobe->distribution != Distribution::ggx) return std::nullopt;
  return *lobe;
}

}  // namespace

LobeView::LobeView(const ShadingPoint& point, const SpecularLobe& of)
    : lobe(of),
      normal(point.normal),
      surface_normal(point.surface_normal),
      view(point.view),
      mirror(point.normal * (2 * dot(point.normal, point.view)) - point.view),
      frame(point) {
  lobe.alpha_x = lobe.alpha_y = std::max(lobe.alpha_x, min_alpha);
}

Rgb LobeView::operator()(const Vec3d& direction) const {
  const double size = length(direction);
  if (!(size > 0 && dot(surface_normal, direction) > 0)) return {};
  return brdf_cos(lobe, frame.vector(view), frame.vector(direction / size));
}

double LobeView::density_ratio(const Vec3d& direction, double other_alpha) const {
  const Vec3d half = frame.vector(view + normalised(direction));
  const auto density = [&](double a) { return Facets(Distribution::ggx, a, a).density(half); };
  return density(other_alpha) / density(alpha());
}

std::optional<Rgb> by_rules(const SpecularRules& rules, const Emitter& emitter, const ShadingPoint& point) {
  const std::optional<SpecularLobe> lobe = taken_lobe(point.brdf, rules.lobes);
  if (!lobe || !is_uniform_area_light(emitter)) return std::nullopt;
  const auto answer = [&](const auto& light, const auto& rule) -> std::optional<Rgb> {
    if (rule == nullptr) return std::nullopt;
    if (!(in_front(light) && dot(point.normal, point.view) > 0)) return Rgb{};
    const Rgb value = luminance_of(emitter) * rule(light, LobeView(point, *lobe));
    return std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z) ? value : Rgb{};
  };
  if (const auto* sun = std::get_if<DistantEmitter>(&emitter.shape))
    return answer(SphereView{sun->towards, std::sin(sun->radius_rad)}, rules.sun);
  const std::optional<LightView> seen = light_view(emitter, point.position);
  if (!seen) return std::nullopt;
  return std::visit([&](const auto& light) { return answer(light, rule_for(rules, light)); }, *seen);
}

}  // namespace etendue::eval
