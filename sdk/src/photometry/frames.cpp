// Directions and the angles of the three kinds of web. With u the unit vector and latitudes measured from the plane that holds the beam:
//   C: gamma = angle to -z, C = azimuth about +z from +x;   A: V = latitude towards +x, H = longitude from -z towards +y;
//   B: H = latitude towards +y, V = longitude from -z towards +x, so tan V = cos C tan gamma and sin H = sin C sin gamma.
// An arc tangent of both legs keeps all digits at the poles, where an arc sine loses half of them.
#include <cmath>

#include "etendue/intensity_web.h"

namespace etendue {
namespace {

constexpr double degree = pi / 180;
double degrees_of(double y, double x) { return std::atan2(y, x) / degree; }

// Sine and cosine, exact at multiples of 90 degrees.
struct SineCosine {
  double sine, cosine;
};
SineCosine sine_cosine(double angle_deg) {
  const double quarter = std::nearbyint(angle_deg / 90), rest = (angle_deg - 90 * quarter) * degree;
  const double s = std::sin(rest), c = std::cos(rest);
  switch (static_cast<int>(quarter) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

double wrapped(double angle_deg) {
  const double turn = angle_deg - 360 * std::floor(angle_deg / 360);
  return turn < 360 ? turn : 0;
}

}  // namespace

double turn_between(Orientation file, Orientation wanted) { return file == wanted ? 0 : wanted == Orientation::cie ? 90 : -90; }

WebAngles angles_of(WebType type, const Vec3d& direction, const WebFrame& frame) {
  const double x = direction.x, y = frame.clockwise ? -direction.y : direction.y, z = direction.z;
  switch (type) {
    case WebType::c:
      return {degrees_of(std::hypot(x, y), -z), wrapped(degrees_of(y, x) - frame.turn_deg)};
    case WebType::a:
      return {degrees_of(x, std::hypot(y, z)), degrees_of(y, -z)};
    case WebType::b:
      break;
  }
  return {degrees_of(x, -z), degrees_of(y, std::hypot(x, z))};
}

Vec3d direction_of(WebType type, const WebAngles& angles, const WebFrame& frame) {
  const SineCosine v = sine_cosine(angles.vertical_deg);
  const SineCosine h = sine_cosine(type == WebType::c ? angles.horizontal_deg + frame.turn_deg : angles.horizontal_deg);
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
