// Drobot, "Physically Based Area Lights", GPU Pro 5 (2014), 1.3.3: one point of a flat light that stands for all of it.
#include "representative_point.h"
#include "solid_angle.h"

namespace etendue::eval {
namespace {

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

// Eq 1.16 with the cosine at the light that eq 1.3 has.
template <class Flat>
double small_area(const Flat& light, const Vec3d& point, const Vec3d& n) {
  const double r2 = dot(point, point);
  return cosine_towards(point, n) * light.area() * light.height() / (r2 * std::sqrt(r2));
}
// Eq 1.16 as its text has it: theta_o is the angle between the surface's normal and the light's.
template <class Flat>
double equation_16(const Flat& light, const Vec3d& n) {
  const Vec3d point = plain_point(light, n);
  return cosine_towards(point, n) * light.area() * saturate(-dot(n, light.normal)) / dot(point, point);
}
template <class Flat>
double equation_16_mended(const Flat& light, const Vec3d& n) {
  return small_area(light, plain_point(light, n), n);
}
template <class Flat>
double equation_16_clamped(const Flat& light, const Vec3d& n) {
  return small_area(light, clamped_point(light, n), n);
}
double point(const RectView& rect, const Vec3d& n) { return solid_angle(rect.corners()) * cosine_towards(clamped_point(rect, n), n); }
double point_above(const RectView& rect, const Vec3d& n) { return solid_angle_above(rect, n) * cosine_towards(clamped_point(rect, n), n); }
double simplified(const RectView& rect, const Vec3d& n) { return solid_angle(rect.corners()) * cosine_towards(plain_point(rect, n), n); }
double simplified_above(const RectView& rect, const Vec3d& n) {
  return solid_angle_above(rect, n) * cosine_towards(plain_point(rect, n), n);
}

constexpr std::string_view chapter = "Drobot 2014 (GPU Pro 5), 1.3.3";
constexpr std::string_view equation = "Drobot 2014 (GPU Pro 5), eq 1.16";
constexpr DiffuseMethod methods[] = {
    {"drobot-point", chapter,
     "The point half way between the light's nearest and its most frontal one, times the solid angle: 15 % off above the horizon, twice "
     "the "
     "light across it.",
     point},
    {"drobot-point-horizon", chapter, "The same with the solid angle above the horizon: 60 % off across it.", point_above},
    {"drobot-simplified", chapter,
     "The point from the plane instead of the light: 20 % off above the horizon, four times the light across it.", simplified},
    {"drobot-simplified-horizon", chapter, "The same with the solid angle above the horizon.", simplified_above},
    {"drobot-1-16", equation,
     "Area times both cosines over r^2 at the simplified point, the light's cosine taken, as printed, between both normals: wrong at any "
     "distance unless the light stands straight above.",
     equation_16<RectView>, equation_16<DiskView>},
    {"drobot-1-16-mended", equation,
     "The same with the cosine at the light, as eq 1.3 has it: right far away; grows without bound near the light, because the area over "
     "r^2 does.",
     equation_16_mended<RectView>, equation_16_mended<DiskView>},
    {"drobot-1-16-clamped-mended", equation, "The same at the point of the first form.", equation_16_clamped<RectView>,
     equation_16_clamped<DiskView>},
};

}  // namespace

std::span<const DiffuseMethod> drobot_methods() { return methods; }

}  // namespace etendue::eval
