// Curves of sdk/docs/brdf.md: what specular lobes give back of a white sky, and Fresnel's reflectances.
#pragma once

#include <nlohmann/json.hpp>

namespace etendue::bench {

// Of lobes that mirror all (F = 1), at one alpha, against the angle of view in degrees.
nlohmann::ordered_json specular_albedos(double alpha);
// Of the same distribution with and without what facets pass on to each other, in gold's three reflectances, against alpha, seen at 45
// degrees.
nlohmann::ordered_json passed_on_light();
// Glass, gold's green and Schlick's approximations of glass against the angle of incidence in degrees.
nlohmann::ordered_json fresnel_terms();

}  // namespace etendue::bench
