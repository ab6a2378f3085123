#include "kernels.h"

namespace etendue::eval {
namespace {

bool both_above(const Vec3d& view, const Vec3d& light) { return view.z > 0 && light.z > 0; }

LobeFacts facts_of(const Brdf& brdf, const Vec3d& view) {
  return with_kernel(brdf, view, [](const auto& kernel) { return kernel.facts(); });
}

// One-sample mixture of the visible-normal density and the cosine.
double mixed_pdf(const LobeFacts& facts, const Vec3d& view, const Vec3d& light) {
  double pdf = (1 - facts.specular_share) * light.z / pi;
  if (facts.specular_share > 0) {
    pdf += facts.specular_share * GgxView(facts.alpha, Masking::separable, view).pdf(half_angle(view, light));
  }
  return pdf;
}

}  // namespace

double oren_nayar_sigma_rad(double alpha) { return std::atan(alpha) / std::sqrt(2.0); }

Rgb brdf_cos(const Brdf& brdf, const Vec3d& view, const Vec3d& light) {
  if (!both_above(view, light)) return {};
  return with_kernel(brdf, view, [&](const auto& kernel) { return kernel(light); });
}

double pdf_brdf(const Brdf& brdf, const Vec3d& view, const Vec3d& light) {
  return both_above(view, light) ? mixed_pdf(facts_of(brdf, view), view, light) : 0;
}

double highest_pdf(const Brdf& brdf, const Vec3d& view) {
  if (!(view.z > 0)) return 0;
  const LobeFacts facts = facts_of(brdf, view);
  double pdf = (1 - facts.specular_share) / pi;
  if (facts.specular_share > 0) pdf += facts.specular_share * GgxView(facts.alpha, Masking::separable, view).highest_pdf();
  return pdf;
}

DirectionSample sample_brdf(const Brdf& brdf, const Vec3d& view, const Vec2d& u) {
  if (!(view.z > 0)) return {};
  const LobeFacts facts = facts_of(brdf, view);
  Vec3d light;
  if (u.x < facts.specular_share) {
    const Vec3d h = sample_visible_normal(facts.alpha, view, {u.x / facts.specular_share, u.y});
    light = h * (2 * dot(view, h)) - view;
  } else {
    const double r2 = (u.x - facts.specular_share) / (1 - facts.specular_share), phi = 2 * pi * u.y;
    light = {std::sqrt(r2) * std::cos(phi), std::sqrt(r2) * std::sin(phi), std::sqrt(std::max(1 - r2, 0.0))};
  }
  light = normalised(light);
  if (!(light.z > 0)) return {};
  const double pdf = mixed_pdf(facts, view, light);
  return pdf > 0 ? DirectionSample{light, pdf} : DirectionSample{};
}

}  // namespace etendue::eval
