// Pictures of light filtered with a lobe beforehand, as published: environments for image-based light, and lookups into the card of a
// rectangular light. Baselines by name; by_patches of light_card.h is what they are measured beside.
#pragma once

#include "etendue/diffuse_card.h"
#include "etendue/light_card.h"

#include <functional>
#include <optional>
#include <span>
#include <string_view>

namespace etendue::eval {

// Radiance from a direction (unit), averaged over about 4^level texels around it; level 0 is the picture itself.
using FilteredRadiance = std::function<Rgb(const Vec3d& direction, double level)>;

// First sum of the split integral for a lobe of GGX seen along its normal r = n = v: the mean of the radiance over directions drawn from
// the lobe, weighted by n.l (Karis 2013, PrefilterEnvMap). Points of Hammersley. An error of the isotropic assumption remains at any
// number.
Rgb prefiltered_karis(const FilteredRadiance& radiance, const Vec3d& r, double alpha, unsigned samples);
// The same from averages as wide as a sample's part of the lobe, 1 / (samples pdf), each of which stands for that many texels of
// `texel_sr`, at least 0 and at most `last_level` (Lagarde and de Rousiers 2014, listing 19, with pdf = D / 4 for n = v).
Rgb prefiltered_frostbite(const FilteredRadiance& radiance, const Vec3d& r, double alpha, unsigned samples, double texel_sr,
                          double last_level);

// What a method looks up in: the card, and for some a volume made of it.
struct CardLookups {
  const LightCard* card;  // not null
  std::optional<DiffuseCard> over_distance;
};

// One lookup into the card, times the light of a uniform rectangle.
struct CardMethod {
  std::string_view name;    // lower case, words joined by hyphens
  std::string_view source;  // authors, year
  std::string_view note;
  // Towards the view, cd/m2. Nothing for other lights than rectangles without a window and other lobes than the method's: round correlated
  // GGX, or Lambert of `drobot-diffuse-card`.
  std::optional<Rgb> (*luminance)(const Emitter&, const CardLookups&, const ShadingPoint&) = nullptr;
  bool over_distance = false;  // looks up in the volume
  // Once a light, whose card stays where it is.
  CardLookups lookups(const Emitter& emitter, const LightCard& card) const;
};
std::span<const CardMethod> card_methods();
// Null if no method has the name.
const CardMethod* find_card_method(std::string_view name);

}  // namespace etendue::eval
