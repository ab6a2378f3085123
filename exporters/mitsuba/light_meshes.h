// Lights that Mitsuba has no shape for, as triangles in the light's own frame.
#pragma once

#include "etendue/light.h"
#include "etendue/scene.h"

namespace etendue::mitsuba {

// The front (counter-clockwise) faces -Z. A simple polygon of either winding.
Mesh polygon_mesh(const PolygonShape& polygon);

// 256 sides; round caps of 64 rings each. The radius is scaled so that the area is that of the true surface.
Mesh tube_mesh(const TubeShape& tube);

// Every triangle twice, gap / 2 to either side of where it was, facing away.
Mesh two_sided(const Mesh& mesh, double gap);

// Positions scaled along the axes; normals left out; a mirroring scale keeps the front the front.
Mesh scaled_mesh(const Mesh& mesh, const Vec3d& scale);

}  // namespace etendue::mitsuba
