// Solid angles of rectangles: listing 11 of Lagarde and de Rousiers 2014 as printed, and forms that are defined everywhere.
#pragma once

#include "views.h"

namespace etendue::eval {

// Listing 11, a pyramid whose apex stands over the middle of its base: of a light that faces the point at the distance of its centre.
double right_pyramid(const RectView& rect);
// Listing 11, the sum of the four angles between the sides' planes (Girard). No number where a side's plane is not defined (the point on
// a side, a side without length) or where rounding takes a cosine beyond 1; its rounding does not fall with the solid angle.
double solid_angle_printed(const RectView& rect);
// Of a convex polygon, counter-clockwise as seen: the sum over its triangles of 2 atan2(a.(b x c), abc + a (b.c) + b (c.a) + c (a.b))
// (van Oosterom and Strackee 1983), relative rounding for any size, 0 for what is degenerate.
double solid_angle(std::span<const Vec3d> polygon);
// Of what is above the horizon of n.
double solid_angle_above(const RectView& rect, const Vec3d& n);

}  // namespace etendue::eval
