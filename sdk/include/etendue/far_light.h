// Flat lights far away: how few places of their area are enough, with a proven bound. Lambert's sum over the edges of a light cancels to
// (size / distance)^2 of each edge's part; these rules add positive terms, so that floats keep their digits at any distance.
#pragma once

#include "etendue/vec.h"

#include <optional>

namespace etendue::eval {

// Gauss and Legendre's rules over a parallelogram: its centre, 2 x 2, 3 x 3, 4 x 4.
enum class FarRule { point, gauss2, gauss3, gauss4 };

// How far the rule may be from the exact cosine integral, relative to it: for every parallelogram whose longer side is `size`, seen from
// its front side at `distance` from its centre, with no corner below the horizon. Whatever its tilt and the surface's. Nothing nearer than
// 3.5 sizes, where the proof ends (sdk/docs/area-lights.md). With e = 1 / (2 distance / size - 1) it begins with
//     4/3 e,  16/9 e^3,  32/25 e^5,  512/735 e^7.
std::optional<double> far_error(FarRule rule, double distance_over_size);

// The cheapest rule within the tolerance; nothing if none of them is. 1e-5: point from 67000 sizes on, 2 x 2 from 29.4, 3 x 3 from 6.2,
// 4 x 4 from 3.5.
std::optional<FarRule> far_rule(double distance_over_size, double relative_tolerance);

// Relative to the shading point. It emits towards cross(half_x, half_y).
template <class T>
struct Parallelogram {
  Vec3<T> centre, half_x, half_y;
};
// The integral of n.l over its directions (sr) by the rule; 0 from behind. Rounding adds at most 12 of the number's epsilons times the
// value with both cosines replaced by 1. Below the horizon n.l counts as negative: nothing is clipped.
double far_projected_solid_angle(FarRule rule, const Parallelogram<double>& light, const Vec3d& normal);
float far_projected_solid_angle(FarRule rule, const Parallelogram<float>& light, const Vec3f& normal);

}  // namespace etendue::eval
