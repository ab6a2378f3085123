// The point of a flat light that stands for all of its diffuse light: Drobot 2014 (GPU Pro 5), 1.3.3. Relative to the shading point.
#pragma once

#include "views.h"

namespace etendue::eval {

// Where the factors of cos(theta) / r^2 are highest on the light's plane.
struct EndPoints {
  Vec3d nearest;  // p'': the point's projection; from below the horizon it is moved up to it
  Vec3d frontal;  // p': the plane's intersection with the normal; one that leads away from the plane is skewed to be barely not parallel to
                  // it
};
template <class Flat>
EndPoints end_points(const Flat& light, const Vec3d& n) {
  constexpr double skew = 1e-6;
  const double facing = -dot(n, light.normal);
  const Vec3d foot = light.normal * -light.height();
  const Vec3d up = facing > skew ? n : n + light.normal * (facing - skew);
  return {facing < 0 ? foot - n * dot(n, foot) : foot, up * (light.height() / -dot(up, light.normal))};
}

// The direction half way between two, cut with the light's plane.
template <class Flat>
Vec3d halfway(const Flat& light, const Vec3d& a, const Vec3d& b) {
  const Vec3d half = shader_normalise(a) + shader_normalise(b);
  return light.closest(half * (light.height() / -dot(half, light.normal)));
}
// The article's first form, between the light's own points p_r and p_c.
template <class Flat>
Vec3d clamped_point(const Flat& light, const Vec3d& n) {
  const EndPoints e = end_points(light, n);
  return halfway(light, light.closest(e.nearest), light.closest(e.frontal));
}
// The simplified one, between the plane's points.
template <class Flat>
Vec3d plain_point(const Flat& light, const Vec3d& n) {
  const EndPoints e = end_points(light, n);
  return halfway(light, e.nearest, e.frontal);
}

}  // namespace etendue::eval
