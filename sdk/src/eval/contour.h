// The outline of a light as directions from the shading point: closed chains of conic arcs.
// Derivations: sdk/docs/evaluation.md.
#pragma once

#include "etendue/units.h"
#include "etendue/vec.h"

#include <array>
#include <optional>
#include <vector>

namespace etendue::eval {

// Directions b(s) = centre + u cos s + v sin s, begin <= s <= end, of any length. `u` is perpendicular to `v` and as long.
//   great circle: centre = 0, |u| = 1;   circle of a cap: |b| = 1, centre perpendicular to u and v;   rim of a disk: a circle in space.
struct Arc {
  Vec3d centre, u, v;
  double begin = 0, end = 0;
  bool unit = true;  // |b(s)| = 1 everywhere

  Vec3d at(double s) const { return centre + u * std::cos(s) + v * std::sin(s); }
  bool great_circle() const { return unit && centre == Vec3d{}; }
};

// Arcs head to tail; counter-clockwise about the directions that they enclose: det(c, b, b') > 0 for c inside. Several outlines may
// stand one after the other.
using Contour = std::vector<Arc>;

// Parameters within (begin, end) at which the arc crosses the plane through the point with the normal n, ascending: at most two in a turn.
struct Crossings {
  std::array<double, 2> s{};
  std::size_t count = 0;
};
Crossings crossings(const Arc& arc, const Vec3d& n);

// Squared chords from the unit vector c to directions of the arc at `count` equal steps from its begin, ends included.
std::vector<double> squared_chords(const Arc& arc, const Vec3d& c, int count);

// The closest point of the arc to the unit vector c (on rims to a hundredth of a sixteenth of the arc).
struct Nearest {
  double s = 0, distance = 0;  // parameter, and the chord from c to the direction there
  double speed = 1;            // |d direction / ds| there
};
Nearest nearest_to(const Arc& arc, const Vec3d& c);

// The great circle from the direction of p to that of q, less than half a turn; nothing if they coincide.
std::optional<Arc> great_circle(const Vec3d& p, const Vec3d& q);
// The horizon of the unit vector n.
Arc horizon_circle(const Vec3d& n);
// Circle of the directions at an angle with the given cosine and sine about a unit axis.
Arc cap_circle(const Vec3d& axis, double cosine, double sine);

// The part of one outline with n.b >= 0. What is cut off is replaced by an arc of the horizon of n (unit).
Contour clipped(const Contour& outline, const Vec3d& n);

// Half the closed integral of b x db / |b|^2: the integral of the direction over what the contour encloses (Lambert's formula), whose
// component along a normal is the projected solid angle.
Vec3d direction_integral(const Arc& arc);
Vec3d direction_integral(const Contour& contour);

}  // namespace etendue::eval
