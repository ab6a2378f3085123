// Lights, materials and cameras in a reader's words and as JSON.
#pragma once

#include <string>

#include "session.h"

namespace etendue::cli {

// "rect 1.2 m x 0.6 m, 1500 lm, 3000 K"
std::string describe(const Light& light);

// "  = 663.146 cd/m2, 1500 lm, EV 12.37": what that comes to with colour and size. "" where it cannot be said without more.
std::string resolved_text(const Scene& scene, const Light& light);

// As authored, and what it is in the other units where those make sense.
Json to_json(const Scene& scene, const Light& light);

std::string describe(const Scene& scene, const Material& material);
Json to_json(const Scene& scene, const Material& material);
std::string describe(const Camera& camera);
Json to_json(const Camera& camera);

Json to_json(const Vec3d& v);

}  // namespace etendue::cli
