// Curves of sdk/docs/specular.md: published specular methods beside ours.
#pragma once

#include <nlohmann/json.hpp>

namespace etendue::bench {

// Luminance of a sphere's highlight against the angle between the mirrored view and the sphere's centre, degrees.
nlohmann::ordered_json sphere_highlights();
// Aggregate error against alpha of rectangles above the horizon, the mirror direction within half of them.
nlohmann::ordered_json rect_method_errors();

}  // namespace etendue::bench
