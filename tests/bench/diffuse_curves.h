// Curves of sdk/docs/evaluation.md and area-lights.md: diffuse models, and rules for them under extended lights.
#pragma once

#include <nlohmann/json.hpp>

namespace etendue::bench {

// What a white surface of that roughness reflects of a uniform sky against the angle of view in degrees: figure 9 of Lagarde and de
// Rousiers, with more models and the facets that they stand for.
nlohmann::ordered_json diffuse_reflectances(double roughness);
// Aggregate error of each rule over a unit square's distance, turned and tilted at random with all of it above the horizon, Disney's lobe
// of roughness 1 (what figures 45 and 46 show as pictures).
nlohmann::ordered_json diffuse_rule_errors();

}  // namespace etendue::bench
