#include "lobes.h"

#include "etendue/material_parameters.h"
#include "etendue/mitsuba_parts.h"
#include "etendue/unshown.h"
#include "lobe_fits.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace etendue::mitsuba {
namespace {

// What is lost of a lobe that is shown ("": nothing), or none where it is not shown.
using Rest = std::optional<std::string>;

// The parameters that a lobe finds.
struct Ground {
  Principled model;
  bool textured_metal = false, textured_roughness = false;
  double f0 = 0.04, ior = 1.5;
};

Ground ground_of(const Material& authored) {
  const Material twin = mitsuba_twin(authored);
  Ground ground;
  if (const auto* model = std::get_if<Principled>(&twin.model)) ground.model = *model;
  ground.textured_metal = twin.metal_rough_texture && ground.model.metallic != 0;
  ground.textured_roughness = twin.metal_rough_texture.has_value();
  ground.f0 = 0.08 * ground.model.specular;
  ground.ior = ior_of_f0(std::min(ground.f0, 0.999));
  return ground;
}

// A mesh carries the coordinates of the textures that pictures show, or of the first that a lobe has: a lobe with a texture on other ones
// is not shown.
Material with_one_uv_set(Material material) {
  std::optional<int> set;
  const auto other = [&set](const std::optional<Texture>& texture) {
    if (!texture) return false;
    if (!set) set = texture->uv_set;
    return *set != texture->uv_set;
  };
  for (const auto* texture : {&material.base_colour_texture, &material.metal_rough_texture, &material.specular_gloss_texture})
    other(*texture);
  if (material.normal_map) other(material.normal_map->texture);
  if (auto& coat = material.lobes.clearcoat; coat && other(coat->factor_texture)) coat.reset();
  if (auto& pass = material.lobes.transmission; pass && other(pass->factor_texture)) pass.reset();
  if (auto& diffuse = material.lobes.diffuse_transmission; diffuse && (other(diffuse->factor_texture) || other(diffuse->colour_texture)))
    diffuse.reset();
  return material;
}

Rest show_specular(ShownLobes& shown, const Ground& ground, const Specular& specular) {
  if (specular.factor_texture || specular.colour_texture) return {};
  const auto channel = [&](double colour) { return std::min(ground.f0 * colour, 1.0) * specular.factor; };
  const Rgb authored{channel(specular.colour.x), channel(specular.colour.y), channel(specular.colour.z)};
  const double grey = std::min(luminance_of(authored), 0.999);
  shown.specular = grey / 0.08;
  const bool is_grey = authored.x == authored.y && authored.y == authored.z;
  if (is_grey && specular.factor == 1) return "";
  return fmt::format("F0 is {:.3g} instead of ({:.3g}, {:.3g}, {:.3g}), at grazing angles 1 instead of {:.3g}", grey, authored.x,
                     authored.y, authored.z, specular.factor);
}

Rest show_clearcoat(ShownLobes& shown, const Clearcoat& coat) {
  const double alpha = coat.roughness * coat.roughness, width = coat_width(alpha);
  shown.clearcoat = coat.factor;
  shown.clearcoat_texture = coat.factor_texture;
  shown.clearcoat_gloss = (0.1 - width) / 0.099;
  std::string rest = fmt::format(
      "`principled`'s coat reflects as much from ahead, at an angle of incidence t only cos^2 t of that ({:.3g} of a white sky's light "
      "instead of {:.3g}), and takes nothing from the layer below",
      coat.factor * principled_coat_albedo(width), coat.factor * schlick_albedo(0.04));
  const double height = coat_peak(width) * alpha * alpha;
  if (height > 1.01 || height < 0.99) rest += fmt::format("; its highlight is {:.3g} times as high", height);
  if (coat.roughness_texture) rest += "; its roughness is the factor everywhere";
  if (coat.normal_map) rest += "; it follows the normals of the layer below";
  return rest;
}

// A grey share of `principled`'s tint, base colour / its luminance, that comes nearest to the cloth's colour / its luminance.
double tint_of(const Rgb& cloth, const Rgb& base) {
  const double cloth_y = luminance_of(cloth), base_y = luminance_of(base);
  if (!(cloth_y > 0) || !(base_y > 0)) return 0;
  double along = 0, square = 0;
  for (int c = 0; c < 3; ++c) {
    const double tint = base[c] / base_y - 1, wanted = cloth[c] / cloth_y - 1;
    along += tint * wanted;
    square += tint * tint;
  }
  return square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0;
}

Rest show_sheen(ShownLobes& shown, const Ground& ground, const Sheen& sheen) {
  const double cloth_share = 1 - ground.model.metallic, y = luminance_of(sheen.colour);
  if (sheen.colour_texture || sheen.roughness_texture || ground.textured_metal || cloth_share < 0.01 || !(y > 0)) return {};
  const double albedo = cloth_albedo(sheen.roughness);
  shown.sheen = y * albedo / (principled_sheen_albedo() * cloth_share);
  shown.sheen_tint = tint_of(sheen.colour, ground.model.base_colour);
  const double base_y = luminance_of(ground.model.base_colour);
  Rgb tint{1, 1, 1};
  for (int c = 0; c < 3 && base_y > 0; ++c) tint[c] += shown.sheen_tint * (ground.model.base_colour[c] / base_y - 1);
  return fmt::format(
      "`principled`'s rim, of the same share of a white sky's light ({:.3g}), closer to the edge than the cloth's, in ({:.3g}, {:.3g}, "
      "{:.3g}) instead of ({:.3g}, {:.3g}, {:.3g}); the layer below is not dimmed by it",
      y * albedo, y * tint.x, y * tint.y, y * tint.z, sheen.colour.x, sheen.colour.y, sheen.colour.z);
}

// alpha_t = lerp(alpha, 1, strength^2) along the direction, alpha across it (the extension); `principled` has r^2 / s along dp/du and
// r^2 s across it, s = sqrt(1 - .9 anisotropic). So r^4 = alpha_t alpha and s^2 = alpha / alpha_t, or its inverse where the direction is
// turned by 90 degrees. Mitsuba takes values of `anisotropic` beyond 0 to 1.
Rest show_anisotropy(ShownLobes& shown, const Ground& ground, const Anisotropy& anisotropy) {
  if (anisotropy.texture || ground.textured_roughness) return {};
  const double alpha = std::max(ground.model.roughness * ground.model.roughness, 1e-3);
  const double along = alpha + (1 - alpha) * anisotropy.strength * anisotropy.strength;
  const double turned = anisotropy.rotation_rad / (pi / 2), nearest = std::round(turned);
  const bool across = std::fmod(std::abs(nearest), 2) == 1;
  shown.roughness = std::pow(along * alpha, 0.25);
  shown.anisotropic = (1 - (across ? along / alpha : alpha / along)) / 0.9;
  const double off = std::abs(turned - nearest) * 90;
  if (off < 0.05) return "";
  return fmt::format("the direction is {:.3g} degrees off: a multiple of 90 is shown", off);
}

std::string depth_of(int max_depth, int needed, const char* what) {
  return max_depth >= 0 && max_depth < needed
             ? fmt::format("; {} is seen from a depth of {} on (--depth), found {}", what, needed, max_depth)
             : "";
}

// With m metal, t passing and f diffused shares, what the surface is: m metal + (1 - m) (t passing + (1 - t) (f diffused + (1 - f)
// reflecting)). The outer blend takes t (1 - m), the inner one what is f's of the rest, and the metal is more of what then remains.
void show_transmission(ShownLobes& shown, const Ground& ground, const Lobes& lobes, Rest& passing, Rest& diffusing, int max_depth) {
  const Transmission pass = lobes.transmission.value_or(Transmission{});
  const DiffuseTransmission diffuse = lobes.diffuse_transmission.value_or(DiffuseTransmission{});
  const double m = ground.model.metallic;
  const bool both = pass.factor > 0 && diffuse.factor > 0;
  const bool textures = pass.factor_texture.has_value() || diffuse.factor_texture.has_value();
  if (ground.textured_metal || (textures && (m > 0 || both))) return;
  shown.passed = pass.factor * (1 - m);
  const double rest = 1 - shown.passed;
  shown.diffused = rest > 0 ? (1 - m) * (1 - pass.factor) * diffuse.factor / rest : 0;
  const double reflecting = rest * (1 - shown.diffused);
  if (shown.transmits()) shown.metallic = reflecting > 0 ? std::min(1.0, m / reflecting) : 0;
  shown.passed_texture = pass.factor_texture;
  shown.diffused_texture = diffuse.factor_texture;
  shown.diffused_colour = diffuse.colour;
  shown.diffused_colour_texture = diffuse.colour_texture;
  shown.ior = ground.ior;
  shown.solid = lobes.volume && lobes.volume->thickness_m > 0;
  if (lobes.transmission && shown.solid) {
    passing = "the root of the base colour tints light at each of the two surfaces that it passes" +
              depth_of(max_depth, 4, "a surface behind it");
  } else if (lobes.transmission) {
    const double spread = 0.65 * ground.ior - 0.35, alpha = ground.model.roughness * ground.model.roughness;
    passing = fmt::format("what passes is blurred by alpha {:.3g} instead of {:.3g}", alpha * spread * spread, alpha) +
              depth_of(max_depth, 3, "a surface behind it");
  }
  if (lobes.diffuse_transmission)
    diffusing = fmt::format("the part that is diffused to the other side reflects nothing: F0 is {:.3g} instead of {:.3g}",
                            ground.f0 * (1 - diffuse.factor * (1 - pass.factor)), ground.f0);
}

// Beer and Lambert's law: transmittance colour = exp(-absorption distance).
Rest show_volume(ShownLobes& shown, const Volume& volume) {
  if (!(shown.passed > 0) || !shown.solid) return {};
  if (!std::isfinite(volume.attenuation_distance_m)) return "";
  const double distance = std::max(volume.attenuation_distance_m, 1e-9);
  Rgb absorption;
  for (int c = 0; c < 3; ++c) absorption[c] = -std::log(std::clamp(volume.attenuation_colour[c], 1e-6, 1.0)) / distance;
  shown.absorption_per_m = absorption;
  return "";
}

}  // namespace

std::optional<Rgb> absorption_of(const Material& material) {
  ShownLobes shown;
  Rest passing, diffusing;
  if (!material.lobes.volume || !material.lobes.transmission) return {};
  const Material shown_as = with_one_uv_set(material);
  show_transmission(shown, ground_of(shown_as), shown_as.lobes, passing, diffusing, -1);
  show_volume(shown, *material.lobes.volume);
  return shown.absorption_per_m;
}

ShownLobes shown_lobes(const Material& authored, int max_depth) {
  ShownLobes shown;
  const Material material = with_one_uv_set(authored);
  const Ground ground = ground_of(material);
  const Lobes& lobes = material.lobes;
  Rest passing, diffusing, specular, coat, sheen, anisotropy, volume;
  if (lobes.specular) specular = show_specular(shown, ground, *lobes.specular);
  if (lobes.clearcoat) coat = show_clearcoat(shown, *lobes.clearcoat);
  if (lobes.sheen) sheen = show_sheen(shown, ground, *lobes.sheen);
  if (lobes.anisotropy) anisotropy = show_anisotropy(shown, ground, *lobes.anisotropy);
  if (lobes.transmission || lobes.diffuse_transmission) show_transmission(shown, ground, lobes, passing, diffusing, max_depth);
  if (lobes.volume) volume = show_volume(shown, *lobes.volume);
  shown.blended = material.blended;

  const std::pair<const char*, Rest> rests[] = {{"alpha blending", material.blended ? Rest("") : Rest()},
                                                {"clearcoat", coat},
                                                {"sheen", sheen},
                                                {"transmission", passing},
                                                {"diffuse transmission", diffusing},
                                                {"volume", volume},
                                                {"specular", specular},
                                                {"anisotropy", anisotropy}};
  for (Loss& loss : unshown_losses(authored)) {
    const auto found = std::find_if(std::begin(rests), std::end(rests), [&](const auto& rest) { return loss.what == rest.first; });
    if (found == std::end(rests) || !found->second)
      shown.losses.push_back(std::move(loss));
    else if (!found->second->empty())
      shown.losses.push_back({loss.what, *found->second});
  }
  return shown;
}

}  // namespace etendue::mitsuba
