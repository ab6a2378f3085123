// Points of a light that stand for all of it: the illuminance is taken as solid angle times the cosine towards the point.
#pragma once

#include "views.h"

namespace etendue::eval {

// Where cos(theta) / r^2 is highest on the rectangle (the "reference MRP" of table E.1, there searched by brute force): in closed form.
Vec3d most_representative(const RectView& rect, const Vec3d& n);

inline double cosine_towards(const Vec3d& point, const Vec3d& n) { return saturate(dot(n, shader_normalise(point))); }

// Of the corners and the centre (listing 12).
inline double mean_cosine(const RectView& rect, const Vec3d& n) {
  double sum = cosine_towards(rect.centre, n);
  for (const Vec3d& p : rect.corners()) sum += cosine_towards(p, n);
  return sum / 5;
}

}  // namespace etendue::eval
