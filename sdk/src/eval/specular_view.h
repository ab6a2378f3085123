// Lights and surfaces as the specular methods by name take them, and the parts of their list.
#pragma once

#include "etendue/specular_methods.h"
#include "local.h"
#include "views.h"

#include <optional>
#include <span>

namespace etendue::eval {

// Round GGX with Schlick's Fresnel, under either name; nothing for any other BRDF.
std::optional<GgxLobe> round_ggx(const Brdf& brdf);
std::optional<GgxLobe> correlated_ggx(const Brdf& brdf);  // of height-correlated masking
// An area light of one luminance, without a window.
bool is_uniform_area_light(const Emitter& emitter);
// cd/m2 of such a light: of a sun its illuminance over pi sin^2 of its angular radius.
Rgb luminance_of(const Emitter& emitter);

// One lobe at one point, in world space. Mirrored, the view goes along `mirror`.
struct LobeView {
  LobeView(const ShadingPoint& point, const SpecularLobe& lobe);

  // BRDF times cosine (1/sr) of a direction of any length; 0 if it has none or is below a horizon.
  Rgb operator()(const Vec3d& direction) const;
  double alpha() const { return lobe.alpha_x; }
  // D of GGX with another alpha over D with the lobe's own.
  double density_ratio(const Vec3d& direction, double other_alpha) const;

  SpecularLobe lobe;  // round
  Vec3d normal, surface_normal, view, mirror;
  LocalFrame frame;
};

// The shading point turned so that the view lies in the plane x >= 0, y = 0 of its normal; any plane will do for a view along the normal.
struct ViewFrame {
  Vec3d x, y, z;
  double cosine;
  ViewFrame(const Vec3d& normal, const Vec3d& view) : z(normal), cosine(dot(normal, view)) {
    const Vec3d across = view - normal * cosine;
    x = dot(across, across) > 1e-30 ? normalised(across) : basis_around(normal).tangent;
    y = cross(z, x);
  }
  Vec3d vector(const Vec3d& v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
};

// Round lobes of one reflection that a method takes.
enum class Lobes { correlated_ggx, ggx, every };

// A published method: one function a shape that it takes, given the light of 1 cd/m2 relative to the point.
struct SpecularRules {
  Rgb (*rect)(const RectView&, const LobeView&) = nullptr;
  Rgb (*disk)(const DiskView&, const LobeView&) = nullptr;
  Rgb (*sphere)(const SphereView&, const LobeView&) = nullptr;
  Rgb (*tube)(const TubeView&, const LobeView&) = nullptr;
  Rgb (*sun)(const SphereView&, const LobeView&) = nullptr;  // of the distance 1
  Lobes lobes = Lobes::ggx;
};
// As SpecularMethod::luminance. Where a printed form divides by zero or leaves the domain of its functions the answer is 0.
std::optional<Rgb> by_rules(const SpecularRules& rules, const Emitter& emitter, const ShadingPoint& point);
template <const SpecularRules& rules>
std::optional<Rgb> published(const Emitter& emitter, const ShadingPoint& point) {
  return by_rules(rules, emitter, point);
}

std::span<const SpecularMethod> frostbite_specular_methods();
std::span<const SpecularMethod> drobot_specular_methods();
std::span<const SpecularMethod> karis_specular_methods();
std::span<const SpecularMethod> eden_specular_methods();
std::span<const SpecularMethod> hill_heitz_specular_methods();
std::span<const SpecularMethod> ltc_methods();
std::span<const SpecularMethod> covered_specular_methods();

}  // namespace etendue::eval
