#include "kernels.h"
#include "quadrature.h"

namespace etendue::eval {
namespace {

bool both_above(const Vec3d& view, const Vec3d& light) { return view.z > 0 && light.z > 0; }

// Kernels that know their own density; the others are sampled as their facts say.
template <class Kernel>
concept Sampler = requires(const Kernel& kernel, const Vec3d& light, const Vec2d& u) {
  kernel.pdf(light);
  kernel.highest_pdf();
  kernel.sample(u);
};

// One-sample mixture of the visible-normal density and the cosine.
double mixed_pdf(const LobeFacts& facts, const Vec3d& view, const Vec3d& light) {
  double pdf = (1 - facts.specular_share) * light.z / pi;
  if (facts.specular_share > 0) {
    pdf += facts.specular_share * GgxView(facts.alpha, Masking::separable, view).pdf(half_angle(view, light));
  }
  return pdf;
}

double highest_mixed_pdf(const LobeFacts& facts, const Vec3d& view) {
  double pdf = (1 - facts.specular_share) / pi;
  if (facts.specular_share > 0) pdf += facts.specular_share * GgxView(facts.alpha, Masking::separable, view).highest_pdf();
  return pdf;
}

Vec3d sample_mixed(const LobeFacts& facts, const Vec3d& view, const Vec2d& u) {
  if (u.x < facts.specular_share) {
    const Vec3d h = sample_seen_ggx(facts.alpha, facts.alpha, view, {u.x / facts.specular_share, u.y});
    return h * (2 * dot(view, h)) - view;
  }
  return cosine_direction({(u.x - facts.specular_share) / (1 - facts.specular_share), u.y});
}

template <class Kernel>
double pdf_of(const Kernel& kernel, const Vec3d& view, const Vec3d& light) {
  if constexpr (Sampler<Kernel>) {
    return kernel.pdf(light);
  } else {
    return mixed_pdf(kernel.facts(), view, light);
  }
}

}  // namespace

Basis shading_basis(const ShadingPoint& point) {
  const Vec3d across = point.tangent - point.normal * dot(point.normal, point.tangent);
  const double size = length(across);
  if (!(size > 0)) return basis_around(point.normal);
  return {across / size, cross(point.normal, across / size), point.normal};
}

double oren_nayar_sigma_rad(double alpha) { return std::atan(alpha) / std::sqrt(2.0); }

double micro_occlusion_f90(const Rgb& f0) { return occluded_f90(f0); }

Rgb fresnel_reflectance(const SpecularLobe& lobe, double cosine) {
  const double c = std::clamp(cosine, 1e-150, 1.0);
  const auto each = [&](auto reflectance) {
    const double red = reflectance(lobe.eta.x, lobe.k.x);
    const bool grey = lobe.eta.x == lobe.eta.y && lobe.eta.y == lobe.eta.z && lobe.k.x == lobe.k.y && lobe.k.y == lobe.k.z;
    return grey ? Rgb{red, red, red} : Rgb{red, reflectance(lobe.eta.y, lobe.k.y), reflectance(lobe.eta.z, lobe.k.z)};
  };
  switch (lobe.fresnel) {
    case Fresnel::schlick:
      return schlick(lobe.f0, lobe.f90, schlick_weight(c));
    case Fresnel::schlick_gaussian:
      return schlick(lobe.f0, lobe.f90, gaussian_schlick_weight(c));
    case Fresnel::dielectric:
      return each([c](double eta, double) { return dielectric_reflectance(c, eta); });
    default:
      return each([c](double eta, double k) { return conductor_reflectance(c, eta, k); });
  }
}

// Of light from all over the hemisphere, 2 F c dc: 24 nodes are exact for Schlick's.
Rgb mean_fresnel(const SpecularLobe& lobe) {
  Rgb sum;
  for (const GaussNode& node : gauss24()) {
    const double c = 0.5 * (1 + node.x);
    sum += fresnel_reflectance(lobe, c) * (node.weight * c);
  }
  return sum;
}

Rgb brdf_cos(const Brdf& brdf, const Vec3d& view, const Vec3d& light) {
  if (!both_above(view, light)) return {};
  return with_kernel(brdf, view, [&](const auto& kernel) { return kernel(light); });
}

double pdf_brdf(const Brdf& brdf, const Vec3d& view, const Vec3d& light) {
  if (!both_above(view, light)) return 0;
  return with_kernel(brdf, view, [&](const auto& kernel) { return pdf_of(kernel, view, light); });
}

double highest_pdf(const Brdf& brdf, const Vec3d& view) {
  if (!(view.z > 0)) return 0;
  return with_kernel(brdf, view, [&]<class Kernel>(const Kernel& kernel) {
    if constexpr (Sampler<Kernel>) {
      return kernel.highest_pdf();
    } else {
      return highest_mixed_pdf(kernel.facts(), view);
    }
  });
}

DirectionSample sample_brdf(const Brdf& brdf, const Vec3d& view, const Vec2d& u) {
  if (!(view.z > 0)) return {};
  return with_kernel(brdf, view, [&]<class Kernel>(const Kernel& kernel) -> DirectionSample {
    Vec3d light;
    if constexpr (Sampler<Kernel>) {
      light = normalised(kernel.sample(u));
    } else {
      light = normalised(sample_mixed(kernel.facts(), view, u));
    }
    if (!(light.z > 0)) return {};
    const double pdf = pdf_of(kernel, view, light);
    return pdf > 0 ? DirectionSample{light, pdf} : DirectionSample{};
  });
}

}  // namespace etendue::eval
