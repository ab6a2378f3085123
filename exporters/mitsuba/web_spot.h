// A web whose light all goes into a cone, as the picture of one spot.
#pragma once

#include "etendue/photometric_bake.h"

#include <optional>
#include <vector>

namespace etendue::mitsuba {

// Mitsuba's spot sends intensity x texture(u, v) inside its cone, with u = 1/2 + x / (2 tan(outer)), v = 1/2 + y / (2 tan(outer)) of the
// direction (x, y, 1) in its own frame. The outermost texel centres lie on the edges of the square. The cone cuts off sharply, so that a
// table that ends brightly keeps its edge.
struct WebSpot {
  double outer_rad = 0, peak_cd = 0;
  std::uint32_t texels = 0;
  std::vector<float> shares;  // of peak_cd, row by row, v from 0
  double error_cd = 0;        // as WebBake's
};

// A web of which a shade leaves nothing outside a cone about the nadir.
struct ShadedWeb {
  const IntensityWeb& web;
  const WebShade* shade = nullptr;  // none: all is left
  double outer_rad = 0;             // with a shade alone

  double towards(const Vec3d& unit) const { return shade != nullptr ? shade->share(unit) * web.towards(unit) : web.towards(unit); }
  double flux_lm() const { return shade != nullptr ? shade->flux_lm : web.flux_lm(); }
};

// Nothing where light leaves a cone of 60 degrees about the nadir, or where the beam is finer than the texels. Sizes as in bake_within().
std::optional<WebSpot> web_spot(const ShadedWeb& web, double wanted_cd, std::uint32_t fewest, std::uint32_t most);

}  // namespace etendue::mitsuba
