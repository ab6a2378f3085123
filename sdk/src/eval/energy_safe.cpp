#include "etendue/energy_safe.h"

#include "kernels.h"
#include "quadrature.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace etendue::eval {
namespace {

// albedo_parts() of GGX is within that of each part (directional_albedo.h): added, so that what is a bound stays one.
constexpr double table_error = 5e-4;

Vec3d direction(double cosine, double azimuth) {
  const double c = std::min(cosine, 1.0), sine = std::sqrt(1 - c * c);
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), c};
}

Rgb specular_albedo(const GgxLobe& lobe, double f0_part, double f90_part) {
  return lobe.f0 * f0_part + Rgb{1, 1, 1} * (lobe.f90 * f90_part);
}
Rgb specular_albedo(const GgxLobe& ggx, const Vec3d& view, double relative) {
  SpecularLobe lobe;
  lobe.alpha_x = lobe.alpha_y = ggx.alpha;
  const AlbedoParts parts = directional_albedo(lobe, view, relative);
  return specular_albedo(ggx, parts.f0_part, parts.f90_part);
}

}  // namespace

Rgb standard_albedo(const Standard& surface, double cosine, double relative) {
  if (!(cosine > 0)) return {};
  const StandardLobes lobes = lobes_of(surface);
  return lobes.diffuse.base_colour * frostbite_albedo(surface.roughness, std::min(cosine, 1.0)) +
         specular_albedo(lobes.specular, direction(cosine, 0), relative);
}

std::shared_ptr<const AlbedoTable> standard_albedos() { return albedo_table(SpecularLobe{}); }

// With s at most 1 the diffuse lobe gives back s(v) integral of f_d s(l) n.l dl <= s(v) (1 - metal) base E_d(v), which s(v) as below keeps
// at or under base (1 - E_s(v)).
Rgb diffuse_kept(const EnergySafeStandard& safe, double cosine) {
  const StandardLobes lobes = lobes_of(safe.surface);
  const double diffuse = (1 - safe.surface.metal) * frostbite_albedo(safe.surface.roughness, cosine);
  const AlbedoParts parts = albedo_parts(*safe.albedos, lobes.specular.alpha, cosine);
  const Rgb specular = specular_albedo(lobes.specular, parts.f0_part + table_error, parts.f90_part + table_error);
  Rgb kept{1, 1, 1};
  for (int c = 0; c < 3; ++c) {
    const double left = std::max(1 - specular[c], 0.0);
    if (left < diffuse) kept[c] = left / diffuse;
  }
  return kept;
}

// The diffuse lobe is a quadratic of v.l, and so of the cosine of the azimuth: 4 azimuths are exact. Over n.l it has Schlick's weight and
// the bend where s reaches 1, both near grazing.
Rgb standard_albedo(const EnergySafeStandard& safe, double cosine, double relative) {
  if (!(cosine > 0)) return {};
  constexpr double ends[] = {0, 0.01, 0.03, 0.06, 0.1, 0.15, 0.22, 0.3, 0.4, 0.55, 0.75, 1};
  constexpr int azimuths = 4;
  const StandardLobes lobes = lobes_of(safe.surface);
  const Vec3d view = direction(cosine, 0);
  const DisneyDiffuseKernel kernel(lobes.diffuse, view);
  Rgb sum;
  for (std::size_t panel = 1; panel < std::size(ends); ++panel) {
    const double half = 0.5 * (ends[panel] - ends[panel - 1]);
    for (const GaussNode& node : gauss24()) {
      const double light = ends[panel - 1] + half * (1 + node.x);
      Rgb around;
      for (int k = 0; k < azimuths; ++k) around += kernel(direction(light, 2 * pi * (k + 0.5) / azimuths));
      sum += around * diffuse_kept(safe, light) * (2 * pi / azimuths * half * node.weight);
    }
  }
  return sum * diffuse_kept(safe, view.z) + specular_albedo(lobes.specular, view, relative);
}

Rgb brdf_cos(const EnergySafeStandard& safe, const Vec3d& view, const Vec3d& light) {
  if (!(view.z > 0 && light.z > 0)) return {};
  const StandardLobes lobes = lobes_of(safe.surface);
  const Rgb diffuse = DisneyDiffuseKernel(lobes.diffuse, view)(light);
  return diffuse * diffuse_kept(safe, view.z) * diffuse_kept(safe, light.z) + GgxKernel(lobes.specular, view)(light);
}

}  // namespace etendue::eval
