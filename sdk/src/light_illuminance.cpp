// Uniform luminance L gives E = (L/2) closed integral over the silhouette of (p x dp) . n / |p|^2, n the receiver's normal (Lambert, 1760;
// Arvo 1995, Applications of Irradiance Tensors, eq 2). p runs counter-clockwise as the receiver sees it. Here n = +Z and the receiver is
// the origin, so the light's own origin is at (0, 0, d).
#include "light_illuminance.h"

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

double square(double x) { return x * x; }

// Round cap at x = h: half of the silhouette of its sphere, a circle of half angle alpha around the cap's centre, which lies delta off the
// normal. The half ends where the tube's straight edges touch the sphere, at the azimuths +-phi around the centre's direction, counted
// from outward. With w = cos(alpha) c + sin(alpha) (cos(phi) u + sin(phi) v), n.c = cos(delta), n.u = -sin(delta):
// half the integral of n . (w x dw) = phi sin^2(alpha) cos(delta) + sin(phi) sin(alpha) cos(alpha) sin(delta).
double round_cap(double radius, double h, double d) {
  const double to_centre = std::hypot(d, h), tangent = std::sqrt(square(to_centre) - square(radius));
  const double sin_alpha = radius / to_centre, cos_alpha = tangent / to_centre;
  const double sin_delta = h / to_centre, cos_delta = d / to_centre;
  const double cos_phi = std::min(1.0, radius * sin_delta * to_centre / (d * tangent));
  const double phi = std::acos(cos_phi);
  return phi * square(sin_alpha) * cos_delta + std::sqrt(1 - square(cos_phi)) * sin_alpha * cos_alpha * sin_delta;
}

// Flat or open end at x = h: the near half of its rim, p = (h, r sin(psi), d - r cos(psi)), psi within +-acos(r/d). With
// |p|^2 = A - B cos(psi), A = h^2 + r^2 + d^2, B = 2 d r, half the integral of h r cos(psi) / (A - B cos(psi)) follows from
// integral dpsi / (A - B cos(psi)) = 2 / sqrt(A^2 - B^2) atan(sqrt((A + B) / (A - B)) tan(psi/2)).
double rim(double radius, double h, double d) {
  const double a = square(h) + square(radius) + square(d), b = 2 * d * radius;
  const double psi = std::acos(radius / d);
  const double root = std::sqrt((a - b) * (a + b));
  const double integral = 4 / root * std::atan(std::sqrt((a + b) / (a - b)) * std::tan(psi / 2));
  return h * radius / 2 * (a * integral - 2 * psi) / b;
}

}  // namespace

Wide facing_factor(const SphereShape& sphere, double d) { return wide_pi * squared(Wide(sphere.radius) / d); }

Wide facing_factor(const DiskShape& disk, double d) {
  // r^2 / (r^2 + d^2) = 1 / (1 + (d/r)^2): no square of a size alone.
  return wide_pi / (1 + squared(Wide(d) / disk.radius));
}

// Four edges, each at distance hypot(d, half width) from the receiver and seen under 2 atan(half height / that distance).
double facing_factor(const RectShape& rect, double d) {
  const double a = rect.width / 2, b = rect.height / 2;
  const double to_a = std::hypot(a, d), to_b = std::hypot(b, d);
  return 2 * (a / to_a * std::atan(b / to_a) + b / to_b * std::atan(a / to_b));
}

// Each edge: the angle under which it is seen times the normal's part along the plane through the edge and the receiver.
double facing_factor(const PolygonShape& polygon, double d) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.points.size(); ++i) {
    const Vec2d& from = polygon.points[i];
    const Vec2d& to = polygon.points[(i + 1) % polygon.points.size()];
    const Vec3d p{from.x, from.y, d}, q{to.x, to.y, d};
    const Vec3d across = cross(p, q);
    const double sine = length(across);
    if (sine > 0) sum += std::atan2(sine, dot(p, q)) * across.z / sine;
  }
  return std::fabs(sum) / 2;  // any winding
}

// Two straight edges, where the planes through the receiver touch the cylinder, sqrt(d^2 - r^2) away; their planes' normals have the part
// r/d along n. Then two ends.
double facing_factor(const TubeShape& tube, double d) {
  const double h = tube.length / 2, r = tube.radius;
  const double straight = 2 * r / d * std::atan(h / std::sqrt(square(d) - square(r)));
  return straight + 2 * (tube.caps == Caps::round ? round_cap(r, h, d) : rim(r, h, d));
}

// dI = (I/l) sin(theta) dx with sin(theta) = d/s seen under the cosine d/s at s^2 = d^2 + x^2:
// E = (I/l) integral of d^2 / (d^2 + x^2)^2 over the line = (I/l) [h / (d^2 + h^2) + atan(h/d) / d], h = l/2.
double facing_factor(const LineShape& line, double d) {
  const double h = line.length / 2;
  return (h / (square(d) + square(h)) + std::atan(h / d) / d) / line.length;
}

}  // namespace etendue
