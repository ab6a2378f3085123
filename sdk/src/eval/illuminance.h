// Closed forms of the cosine integral in the shading point's own coordinates.
#pragma once

#include "local.h"

#include <optional>

namespace etendue::eval {

// Cosine integral of the light's luminance above both horizons (lux). Nothing where there is no closed form: with a pattern or an
// environment map, and where window_part() has none.
std::optional<Rgb> closed_illuminance(const Emitter& emitter, const Vec3d& position, const LocalFrame& frame, const Horizons& horizons);

// Projected solid angle of a planar polygon on the plane z = 0, vertices relative to the point, clipped at the horizons. Signed: positive
// if the vertices run counter-clockwise about the directions to them.
double projected_solid_angle(std::span<const Vec3d> vertices, const Horizons& horizons);

}  // namespace etendue::eval
