#include "etendue/light.h"

#include <array>
#include <cmath>

namespace etendue {
namespace {

double square(double x) { return x * x; }
// 1 - cos x without cancellation.
double versine(double x) { return 2 * square(std::sin(x / 2)); }

double shoelace_area(const std::vector<Vec2d>& points) {
  double twice = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2d& a = points[i];
    const Vec2d& b = points[(i + 1) % points.size()];
    twice += a.x * b.y - b.x * a.y;
  }
  return std::fabs(twice) / 2;
}

struct Area {
  double mesh_area_m2;
  double operator()(const SphereShape& s) const { return 4 * pi * square(s.radius); }
  double operator()(const DiskShape& s) const { return pi * square(s.radius); }
  double operator()(const RectShape& s) const { return s.width * s.height; }
  double operator()(const PolygonShape& s) const { return shoelace_area(s.points); }
  double operator()(const TubeShape& s) const {
    const double side = 2 * pi * s.radius * s.length;
    switch (s.caps) {
      case Caps::round:
        return side + 4 * pi * square(s.radius);
      case Caps::flat:
        return side + 2 * pi * square(s.radius);
      case Caps::none:
        break;
    }
    return side;
  }
  double operator()(const MeshShape&) const { return mesh_area_m2; }
  template <class Other>
  double operator()(const Other&) const {
    return -1;  // has no surface
  }
};

}  // namespace

const char* name_of(const Shape& shape) {
  static constexpr std::array<const char*, std::variant_size_v<Shape>> names{
      "point", "spot", "frustum", "distant", "sphere", "disk", "rect", "polygon", "tube", "line", "mesh", "photometric", "environment"};
  return names[shape.index()];
}

bool emits_both_sides(const Light& light) {
  return light.two_sided && (std::holds_alternative<DiskShape>(light.shape) || std::holds_alternative<RectShape>(light.shape) ||
                             std::holds_alternative<PolygonShape>(light.shape) || std::holds_alternative<MeshShape>(light.shape));
}

Result<double> emitting_area(const Light& light, double mesh_area_m2) {
  const double area = std::visit(Area{mesh_area_m2}, light.shape);
  const std::string shape = name_of(light.shape);
  if (area == -1) return Error{"UNIT_UNSUITABLE", "a " + shape + " light has no surface", {"", 0, 0, light.source}, {}, {}};
  if (!(area > 0) || !std::isfinite(area))
    return Error{"SIZE_MISSING",
                 "the " + shape + " light \"" + light.name + "\" has no area: expected sizes greater than zero",
                 {"", 0, 0, light.source},
                 {},
                 {}};
  return area;
}

// The falloff between the half angles i and o is s^2 with s = (cos t - cos o) / (cos i - cos o), 1 inside i:
//   2 pi [(1 - cos i) + integral over c of ((c - cos o) / (cos i - cos o))^2 from cos o to cos i] = 2 pi [(1 - cos i) + (cos i - cos o) /
//   3].
double solid_angle_of(const SpotShape& spot, FluxConvention convention) {
  switch (convention) {
    case FluxConvention::cone:
      return 2 * pi * versine(spot.outer_rad);
    case FluxConvention::frostbite_pi:
      return pi;
    case FluxConvention::isotropic:
      return 4 * pi;
    case FluxConvention::falloff:
      break;
  }
  const double cosine_difference = 2 * std::sin((spot.outer_rad + spot.inner_rad) / 2) * std::sin((spot.outer_rad - spot.inner_rad) / 2);
  return 2 * pi * (versine(spot.inner_rad) + cosine_difference / 3);
}

// 4 asin(sin(a/2) sin(b/2)), in the form that keeps its digits near 180 degrees.
double solid_angle_of(const FrustumShape& frustum) {
  const double a = frustum.width_rad / 2, b = frustum.height_rad / 2;
  return 4 * std::atan2(std::sin(a) * std::sin(b), std::hypot(std::cos(a), std::sin(a) * std::cos(b)));
}

Result<Rgb> rgb_of(const LightColour& colour) {
  if (const auto* temperature = std::get_if<TemperatureColour>(&colour)) {
    const Result<Chromaticity> xy = planckian(temperature->kelvin);
    if (!xy) return xy.error();
    return to_rgb(*xy);
  }
  if (const auto* temperature = std::get_if<DaylightColour>(&colour)) {
    const Result<Chromaticity> xy = daylight(temperature->kelvin);
    if (!xy) return xy.error();
    return to_rgb(*xy);
  }
  const Rgb& rgb = std::get<RgbColour>(colour).rgb;
  const double luminance = luminance_of(rgb);
  const Rgb scaled = rgb / luminance;
  if (!(luminance > 0) || !std::isfinite(scaled.x) || !std::isfinite(scaled.y) || !std::isfinite(scaled.z))
    return Error{"COLOUR_INVALID",
                 "expected a finite colour with a luminance .2126 R + .7152 G + .0722 B greater than zero",
                 {},
                 "for a light that is off, set its emission to zero",
                 {}};
  return scaled;
}

}  // namespace etendue
