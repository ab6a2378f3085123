// Curves of sdk/docs/area-lights.md: outlines that closed forms go around, and what the sources plot, made anew.
#pragma once

#include <nlohmann/json.hpp>

namespace etendue::bench {

// One light of each shape over a point in the origin with the normal z, cut by its horizon: what it is made of, the arcs of its outline
// as unit directions, whole and cut, and its projected solid angle.
nlohmann::ordered_json light_outlines();
// Illuminance from a sphere as it grows, facing it and not, by a given power and by a given luminance, and the luminance itself: figure 31
// of Lagarde and de Rousiers.
nlohmann::ordered_json sphere_units();
// Relative error of pi R^2 / d^2 n.l against the angle between the normal and the sphere's centre in degrees: their figure 36.
nlohmann::ordered_json sphere_without_horizon();
// Relative error of the inverse square law against the distance over the largest dimension: their figure 44.
nlohmann::ordered_json inverse_square_errors();
// Relative error of an edge of Hill and Heitz' integrals against the angle that it spans, in degrees.
nlohmann::ordered_json edge_fit_errors();

}  // namespace etendue::bench
