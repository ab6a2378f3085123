// A cone about the mirror direction in the place of a lobe (Drobot 2014, 1.3.4), and what of it meets a light.
#pragma once

#include "views.h"

#include <array>
#include <cmath>
#include <optional>

namespace etendue::eval {

// Half of the apex angle of eq 1.18, 2 sqrt(2 / (g + 2)), with Walter et al.'s exponent g = 2 / alpha^2 - 2 for whatever lobe has that
// alpha: alpha itself.
double printed_cone(double alpha);
// The angle from the mirror direction at which the lobe, seen along the normal, falls to 1 / e of what it is there: for Phong's that is
// what eq 1.18 fits, with Phong's exponent (1 / e = cos^g of it, so that its square is 2 / g). pi at most.
double fitted_cone(Distribution distribution, double alpha);

// Two disks, of angles on the sphere or in a plane: what they share as a part of the smaller one (Oat 2006: a smooth step between where one
// contains the other and where they only touch), and how far the middle of what they share is from the first one's centre.
struct DiskOverlap {
  double share = 0, middle = 0;
};
DiskOverlap disk_overlap(double first, double second, double apart);

// sr of a cone of that half angle.
inline double cone_solid_angle(double half_angle) { return 4 * pi * std::pow(std::sin(0.5 * half_angle), 2); }

// What meets a flat light of it: its area and middle.
struct LightPart {
  double area;
  Vec3d middle;
};
// Of the pyramid of four rays of any length, in turn; some may lead away from the light's plane. Nothing if they do not meet.
std::optional<LightPart> pyramid_on(const RectView& rect, const std::array<Vec3d, 4>& rays);

}  // namespace etendue::eval
