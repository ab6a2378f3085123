// Lights of any shape as KHR_lights_punctual can say them.
#pragma once

#include "etendue/io.h"
#include "etendue/light.h"

#include <optional>
#include <vector>

namespace etendue::gltf {

struct Punctual {
  const char* type = "point";     // "point", "spot", "directional"
  Rgb rgb;                        // cd (along the axis), or lx for "directional"; none negative
  std::optional<SpotShape> spot;  // for "spot"
  std::optional<double> range_m;
  Transform transform;  // rigid, emits along -Z
};

// One, or two back to back for a flat light that emits to both sides; none where glTF has nothing near it (environments). What is said
// otherwise is reported. `resolved` is what the light emits.
std::vector<Punctual> nearest_punctual(const Light& light, const Resolved& resolved, const Scene& scene, LossReport& losses);

}  // namespace etendue::gltf
