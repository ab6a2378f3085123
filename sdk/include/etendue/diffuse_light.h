// Diffuse surfaces under extended lights in a few dozen evaluations: the exact illuminance times what the BRDF reflects of it.
//   const auto luminance = diffuse_luminance(emitter, {position, normal, normal, view, OrenNayar{{1, 1, 1}, 0.3}});   // cd/m2
#pragma once

#include "etendue/eval.h"

#include <optional>
#include <span>
#include <string_view>

namespace etendue::eval {

// BRDFs without a specular lobe: Lambert, Disney's, Frostbite's, glTF's, Oren and Nayar's, Gotanda's.
bool is_diffuse(const Brdf& brdf);

// E sum(w f n.l) / sum(w n.l): E the exact illuminance, both sums over the same nodes of the light, clipped at the horizons and cut where
// the BRDF bends: 1 to 16 nodes a side, on the mean 18 for a rectangle and 38 for a disk across the horizon at half to six times their
// size. As an aggregate over such lights, for each of these models at any roughness and view, .02 % off above the horizon and .25 % across
// it (tests/acceptance/area_lights --only ratio). Estimate::error is what the nodes tell of it: an estimate, which 99 of 100 answers keep,
// no bound. Lambert is exact. Without a closed form of E (has_closed_form), with a window, of lines and of directions it is `reference` to
// 1e-4. Nothing for BRDFs that are not diffuse.
std::optional<Estimate> diffuse_luminance(const Emitter& emitter, const ShadingPoint& point);

// What others do, to be measured against it: E times the BRDF for one direction.
struct DiffuseRule {
  std::string_view name;    // lower case, words joined by hyphens
  std::string_view source;  // authors, year, equation
  std::string_view note;    // which direction, where it breaks
  // Unit, world: the direction that stands for the light, and the normal whose illuminance is taken.
  struct Choice {
    Vec3d light, normal;
  };
  std::optional<Choice> (*choose)(const Emitter&, const ShadingPoint&) = nullptr;

  // cd/m2. Nothing for a BRDF or a light that the rule does not take. A direction below the horizon is taken at it.
  std::optional<Rgb> luminance(const Emitter& emitter, const ShadingPoint& point) const;
};
std::span<const DiffuseRule> diffuse_rules();
// Null if no rule has the name.
const DiffuseRule* find_diffuse_rule(std::string_view name);

}  // namespace etendue::eval
