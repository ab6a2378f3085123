// Where along an outline a lobe over half vectors is highest.
#pragma once

#include "contour.h"
#include "etendue/vec.h"

namespace etendue::eval {

inline double squared(const Vec2d& q) { return q.x * q.x + q.y * q.y; }

// Slopes q = (h.x, h.y) / (alpha h.z) of the half vector h = v + l of the direction l along an arc, and their derivative to the arc's
// parameter.
struct HalfSlopes {
  Vec2d q, speed;
};
HalfSlopes half_slopes(const Vec3d& view, double alpha, const Arc& arc, double s);

// The parameter at which the slopes are least, closely enough to stand where a lobe of this alpha is all but highest.
double nearest_to_lobe(const Vec3d& view, double alpha, const Arc& arc);

}  // namespace etendue::eval
