// Curves and spheres of sdk/docs/materials.md: Lagarde and de Rousiers' figures 7, 9, 10, 12 and 65 from our own functions.
#pragma once

#include <nlohmann/json.hpp>

namespace etendue::bench {

// Figure 12: alpha of smoothness.
nlohmann::ordered_json smoothness_remaps();
// Figure 65: specular occlusion of an ambient occlusion of .5, against n.v, for some roughnesses.
nlohmann::ordered_json specular_occlusions();
// Figure 9: directional albedo against the angle of view in degrees, panel by panel and roughness by roughness: Disney's diffuse lobe, its
// renormalised form, that with GGX of some f0, and the energy-safe variant of the last.
nlohmann::ordered_json standard_albedo_curves();
// Figures 7 and 10: spheres of radiance, rows of models, columns of roughnesses, each size x size values row by row (-1: beside the
// sphere).
nlohmann::ordered_json masking_spheres(int size);
nlohmann::ordered_json diffuse_spheres(int size);
// Two layers, half of each: their light summed up, and their blended parameters and colours. Three numbers a pixel, red, green, blue.
nlohmann::ordered_json layered_spheres(int size);

}  // namespace etendue::bench
