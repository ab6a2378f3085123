// Specular light of lines: what the methods that know areas come to for a tube without width. sdk/docs/specular.md, "Lines".
#pragma once

#include "etendue/ltc.h"
#include "line.h"
#include "local.h"

#include <optional>

namespace etendue::eval {

// A line without a window; null if it is another light.
const LineEmitter* plain_line(const Emitter& emitter);

// The part of a line that is above the horizons; nothing if there is none. Directions are those of the frame.
std::optional<LineView> seen_line(const LineEmitter& line, const LocalFrame& frame, const Horizons& horizons);

// What a line of 1 cd gives towards the view, by the lobe at places that are even where GGX is a cosine. `lobe` is height-correlated.
Rgb line_by_moments(const LineEmitter& line, const ShadingPoint& point, const GgxLobe& lobe);

// Integral of cos psi D(direction) P / P.z times the view's scale over the part of a line that the cosine D sees, P being the direction in
// the cosine's space: z is the density's own integral, 1 cd's light per albedo. `linear` takes directions of the view's frame there.
Vec3d cosine_along(const LineView& view, const Transform& linear);

}  // namespace etendue::eval
