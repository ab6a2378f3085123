#include "etendue/material_parameters.h"

#include "etendue/material_fit.h"

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

double unit(double x) { return std::clamp(x, 0.0, 1.0); }

}  // namespace

std::string_view name_of(SmoothnessRemap remap) {
  switch (remap) {
    case SmoothnessRemap::linear:
      return "linear";
    case SmoothnessRemap::squared:
      return "squared";
    case SmoothnessRemap::quartic:
      return "quartic";
    case SmoothnessRemap::ryse:
      break;
  }
  return "ryse";
}

std::optional<SmoothnessRemap> smoothness_remap_named(std::string_view name) {
  for (const SmoothnessRemap remap : smoothness_remaps)
    if (name == name_of(remap)) return remap;
  return std::nullopt;
}

double alpha_of_smoothness(double smoothness, SmoothnessRemap remap) {
  const double s = unit(smoothness), rest = 1 - s;
  switch (remap) {
    case SmoothnessRemap::linear:
      return rest;
    case SmoothnessRemap::squared:
      return rest * rest;
    case SmoothnessRemap::quartic:
      return rest * rest * rest * rest;
    case SmoothnessRemap::ryse:
      break;
  }
  return std::pow(1 - 0.7 * s, 6);
}

double smoothness_of_alpha(double alpha, SmoothnessRemap remap) {
  const double a = unit(alpha);
  switch (remap) {
    case SmoothnessRemap::linear:
      return 1 - a;
    case SmoothnessRemap::squared:
      return 1 - std::sqrt(a);
    case SmoothnessRemap::quartic:
      return 1 - std::sqrt(std::sqrt(a));
    case SmoothnessRemap::ryse:
      break;
  }
  return unit((1 - std::pow(a, 1.0 / 6)) / 0.7);
}

double f0_of_reflectance(double reflectance) { return largest_dielectric_f0 * unit(reflectance) * unit(reflectance); }

double f0_of_ior(double ior) {
  if (ior == 0) return 1;
  const double root = (std::max(ior, 1.0) - 1) / (std::max(ior, 1.0) + 1);
  return root * root;
}

double ior_of_f0(double f0) {
  const double root = std::sqrt(unit(f0));
  return root == 1 ? 0 : (1 + root) / (1 - root);
}

Clamped reflectance_of_f0(double f0) {
  const double reflectance = std::sqrt(std::max(f0, 0.0) / largest_dielectric_f0);
  return {unit(reflectance), reflectance > 1 || f0 < 0};
}

Standard with_micro_occlusion(const Standard& surface, double visible) {
  Standard out = surface;
  out.base_colour = surface.base_colour * unit(visible);
  out.reflectance = surface.reflectance * std::sqrt(unit(visible));
  return out;
}

double specular_occlusion(double n_dot_v, double ambient_occlusion, double roughness) {
  const double ao = unit(ambient_occlusion);
  return unit(std::pow(unit(n_dot_v) + ao, std::exp2(-16 * unit(roughness) - 1)) - 1 + ao);
}

IndirectOcclusion indirect_occlusion(double baked, double screen_space, double n_dot_v, double roughness) {
  const double least = std::min(unit(baked), unit(screen_space));
  return {least, specular_occlusion(n_dot_v, least, roughness)};
}

FromOld standard_of(const OldMaterial& old) {
  ColourPair pair{old.diffuse, old.specular};
  const Rgb sum = pair.diffuse + pair.f0;
  const double brightest = std::max({sum.x, sum.y, sum.z});
  FromOld out;
  out.energy_limited = brightest > 1;
  if (out.energy_limited) pair = {pair.diffuse / brightest, pair.f0 / brightest};
  const DisneyColours fit = fit_disney(pair).value;
  const double alpha = std::sqrt(2 / (std::max(old.exponent, 0.0) + 2));
  out.surface = {fit.base_colour, fit.metal, std::sqrt(alpha), fit.reflectance};
  out.residual_rms = std::sqrt(squared_difference(fit, {old.diffuse, old.specular}) / 6);
  return out;
}

}  // namespace etendue
