#include "etendue/unshown.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

const MetalRough* metal_rough_of(const Material& material) {
  if (const auto* model = std::get_if<MetalRough>(&material.model)) return model;
  return material.fallback ? &material.fallback->model : nullptr;
}

double ior_of(const Material& material) {
  const MetalRough* const model = metal_rough_of(material);
  return model != nullptr ? model->ior : 1.5;
}

// Of the dielectric part; an index of 0 stands for a reflectance of 1 (KHR_materials_ior).
double f0_of(const Material& material) {
  const double ior = ior_of(material);
  const double root = (ior - 1) / (ior + 1);
  return ior == 0 ? 1 : root * root;
}

double alpha_of(const Material& material) {
  if (const auto* model = std::get_if<SpecularGlossiness>(&material.model)) return (1 - model->glossiness) * (1 - model->glossiness);
  const MetalRough* const model = metal_rough_of(material);
  return model != nullptr ? model->roughness * model->roughness : 0.25;
}

// Of a conductor, which has none, white.
Rgb base_colour_of(const Material& material) {
  if (const auto* model = std::get_if<Lambert>(&material.model)) return model->base_colour;
  if (const auto* model = std::get_if<Principled>(&material.model)) return model->base_colour;
  if (const auto* model = std::get_if<Standard>(&material.model)) return model->base_colour;
  if (const auto* model = std::get_if<SpecularGlossiness>(&material.model)) return model->diffuse;
  const MetalRough* const model = metal_rough_of(material);
  return model != nullptr ? model->base_colour : Rgb{1, 1, 1};
}

std::string text_of(const Rgb& colour) { return fmt::format("({:.3g}, {:.3g}, {:.3g})", colour.x, colour.y, colour.z); }

// The extension's coat: F0 .04, over a layer that loses what the coat reflects.
std::string amount_of(const Clearcoat& coat) {
  return fmt::format("{:.3g} of light from ahead, {:.3g} of a white sky's, up to {:.3g} at grazing angles", 0.04 * coat.factor,
                     schlick_albedo(0.04) * coat.factor, coat.factor);
}

std::string amount_of(const Sheen& sheen) { return fmt::format("up to {} of the light", text_of(sheen.colour)); }

std::string amount_of(const Transmission& transmission, double f0) {
  return fmt::format("{:.3g} of light from ahead is diffused instead", transmission.factor * (1 - f0));
}

std::string amount_of(const DiffuseTransmission& transmission) {
  return fmt::format("{:.3g} of the diffuse light leaves on the wrong side", transmission.factor);
}

// Beer and Lambert's law along the thickness.
std::string amount_of(const Volume& volume) {
  const double lengths = volume.thickness_m / volume.attenuation_distance_m;
  const Rgb& c = volume.attenuation_colour;
  return fmt::format("{} of light would pass {:.3g} m", text_of({std::pow(c.x, lengths), std::pow(c.y, lengths), std::pow(c.z, lengths)}),
                     volume.thickness_m);
}

// Abbe's number is (n - 1) / (n_F - n_C).
std::string amount_of(const Dispersion& dispersion, double ior) {
  return fmt::format("an index {:.3g} higher in blue (486 nm) than in red (656 nm)", (ior - 1) * dispersion.value / 20);
}

std::string amount_of(const Specular& specular, double f0) {
  const auto channel = [&](double colour) { return std::min(f0 * colour, 1.0) * specular.factor; };
  const Rgb authored{channel(specular.colour.x), channel(specular.colour.y), channel(specular.colour.z)};
  return fmt::format("F0 is {:.3g} instead of {}, at grazing angles 1 instead of {:.3g}", f0, text_of(authored), specular.factor);
}

std::string amount_of(const Iridescence& film, double f0) {
  const ReflectanceRange range = film_reflectance(film.ior, f0);
  const auto mixed = [&](double reflectance) { return f0 + film.factor * (reflectance - f0); };
  return fmt::format("F0 is {:.3g} instead of {:.3g} to {:.3g}, by the wavelength", f0, mixed(range.least), mixed(range.most));
}

std::string amount_of(const Anisotropy& anisotropy, double alpha) {
  return fmt::format("alpha is {:.3g} in all directions, {:.3g} along the authored one", alpha,
                     alpha + (1 - alpha) * anisotropy.strength * anisotropy.strength);
}

}  // namespace

double schlick_albedo(double f0) { return f0 + (1 - f0) / 21; }

ReflectanceRange film_reflectance(double film_ior, double f0) {
  const double root = std::sqrt(std::clamp(f0, 0.0, 1.0));
  // The surface's index is (1 + root) / (1 - root).
  const double r = std::abs((film_ior - 1) / (film_ior + 1));
  const double s = std::abs((1 + root - film_ior * (1 - root)) / (1 + root + film_ior * (1 - root)));
  const double apart = r * s < 1 ? (r - s) / (1 - r * s) : 0, together = (r + s) / (1 + r * s);
  return {apart * apart, together * together};
}

std::vector<Loss> unshown_losses(const Material& material) {
  const Lobes& lobes = material.lobes;
  const double f0 = f0_of(material);
  // In the order of unshown_of().
  std::vector<std::string> amounts;
  if (material.blended) amounts.push_back(fmt::format("authored to cover {:.3g} of it", material.base_alpha));
  if (lobes.unlit) amounts.push_back(text_of(base_colour_of(material)));
  if (lobes.clearcoat) amounts.push_back(amount_of(*lobes.clearcoat));
  if (lobes.sheen) amounts.push_back(amount_of(*lobes.sheen));
  if (lobes.transmission) amounts.push_back(amount_of(*lobes.transmission, f0));
  if (lobes.diffuse_transmission) amounts.push_back(amount_of(*lobes.diffuse_transmission));
  if (lobes.volume) amounts.push_back(amount_of(*lobes.volume));
  if (lobes.dispersion) amounts.push_back(amount_of(*lobes.dispersion, ior_of(material)));
  if (lobes.specular) amounts.push_back(amount_of(*lobes.specular, f0));
  if (lobes.iridescence) amounts.push_back(amount_of(*lobes.iridescence, f0));
  if (lobes.anisotropy) amounts.push_back(amount_of(*lobes.anisotropy, alpha_of(material)));

  std::vector<Loss> losses;
  for (const Unshown& unshown : unshown_of(material)) {
    losses.push_back({unshown.what, std::string(unshown.effect) + ": " + amounts[losses.size()]});
  }
  return losses;
}

}  // namespace etendue
