// What multiplies a light's radiance from place to place: its pattern and its distance window.
#pragma once

#include "etendue/eval.h"

namespace etendue::eval {

// True if the radiance is not the same everywhere on the light.
bool is_modulated(const Emitter& emitter);

// Pattern and window at the point of the emitter that a ray from `position` meets, for outline `index` (each_outline). Planar lights are
// continued over their whole plane, so that this is a function of direction without steps at the light's edge.
Rgb modulation_along(const Emitter& emitter, std::size_t index, const Vec3d& position, const Vec3d& direction);

// Pattern at a point of a planar light or of triangle `index` of a mesh, 1 where there is none.
Rgb pattern_at(const Emitter& emitter, std::size_t index, const Vec3d& point);

}  // namespace etendue::eval
