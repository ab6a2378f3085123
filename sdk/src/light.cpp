#include "light_ratio.h"

#include <array>

namespace etendue {
namespace {

struct Area {
  double mesh_area_m2;
  double operator()(const MeshShape&) const { return mesh_area_m2; }
  template <class S>
  double operator()(const S& shape) const {
    if constexpr (FormedShape<S>) return double(area_of(shape));
    return -1;  // has no surface
  }
};

}  // namespace

const char* name_of(const Shape& shape) {
  static constexpr std::array<const char*, std::variant_size_v<Shape>> names{
      "point", "spot", "frustum", "distant", "sphere", "disk", "rect", "polygon", "tube", "line", "mesh", "photometric", "environment"};
  return names[shape.index()];
}

const char* name_of(const Falloff& falloff) {
  switch (falloff.law) {
    case Falloff::Law::inverse_square:
      break;
    case Falloff::Law::power:
      return falloff == Falloff::linear ? "linear" : falloff == Falloff::gltf ? "gltf" : "power";
    case Falloff::Law::power_squared:
      return "frostbite";
    case Falloff::Law::smoothstep:
      return "smoothstep";
    case Falloff::Law::scale_bias:
      return "scale_bias";
    case Falloff::Law::karis:
      return "karis";
  }
  return "inverse_square";
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

double solid_angle_of(const SpotShape& spot, FluxConvention convention) {
  return double(solid_angle_of(spot, Conventions{.spot_flux = convention}));
}
double solid_angle_of(const FrustumShape& frustum) { return double(solid_angle_of_frustum(frustum)); }

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
