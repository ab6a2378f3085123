// Directions and the angles of the three kinds of web. With u the unit vector and latitudes measured from the plane that holds the beam:
//   C: gamma = angle to -z, C = azimuth about +z from +x;   A: V = latitude towards +x, H = longitude from -z towards +y;
//   B: H = latitude towards +y, V = longitude from -z towards +x, so tan V = cos C tan gamma and sin H = sin C sin gamma.
// An arc tangent of both legs keeps all digits at the poles, where an arc sine loses half of them.
#include <cmath>

#include "angle.h"
#include "etendue/intensity_web.h"

namespace etendue {
namespace {

using photometry::sine_cosine_deg;
using photometry::two_atan2_deg;

// Of both legs; scaled where their squares would leave the range of a double.
double leg(double a, double b) {
  const double square = a * a + b * b;
  return square > 1e-290 && square < 1e290 ? std::sqrt(square) : std::hypot(a, b);
}

double wrapped(double angle_deg) {
  if (angle_deg >= 0 && angle_deg < 360) return angle_deg;
  if (angle_deg < 0 && angle_deg >= -180) return angle_deg + 360 < 360 ? angle_deg + 360 : 0;
  const double turn = angle_deg - 360 * std::floor(angle_deg / 360);
  return turn < 360 ? turn : 0;
}

}  // namespace

double turn_between(Orientation file, Orientation wanted) { return file == wanted ? 0 : wanted == Orientation::cie ? 90 : -90; }

WebAngles angles_of(WebType type, const Vec3d& direction, const WebFrame& frame) {
  const double x = direction.x, y = frame.clockwise ? -direction.y : direction.y, z = direction.z;
  photometry::Pair both{};
  switch (type) {
    case WebType::c:
      both = two_atan2_deg(leg(x, y), -z, y, x);
      return {both[0], wrapped(both[1] - frame.turn_deg)};
    case WebType::a:
      both = two_atan2_deg(x, leg(y, z), y, -z);
      break;
    case WebType::b:
      both = two_atan2_deg(x, -z, y, leg(x, z));
      break;
  }
  return {both[0], both[1]};
}

Vec3d direction_of(WebType type, const WebAngles& angles, const WebFrame& frame) {
  const photometry::SineCosine v = sine_cosine_deg(angles.vertical_deg);
  const photometry::SineCosine h = sine_cosine_deg(type == WebType::c ? angles.horizontal_deg + frame.turn_deg : angles.horizontal_deg);
  Vec3d u;
  switch (type) {
    case WebType::c:
      u = {v.sine * h.cosine, v.sine * h.sine, -v.cosine};
      break;
    case WebType::a:
      u = {v.sine, v.cosine * h.sine, -v.cosine * h.cosine};
      break;
    case WebType::b:
      u = {h.cosine * v.sine, h.sine, -h.cosine * v.cosine};
      break;
  }
  if (frame.clockwise) u.y = -u.y;
  return u;
}

}  // namespace etendue
