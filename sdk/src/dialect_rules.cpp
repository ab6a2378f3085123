#include "dialect_rules.h"
#include "article.h"
#include "parameter_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace etendue {
namespace {

using D = Dialect;
constexpr double blender_lm_W = 683;  // PBR_WATTS_TO_LUMENS of Blender's glTF exporter; V-Ray's documentation has the same

template <class... Shapes>
bool is_any(const Shape& shape) {
  return (std::holds_alternative<Shapes>(shape) || ...);
}
bool is_punctual(const Shape& s) { return is_any<PointShape, SpotShape, FrustumShape>(s); }
bool is_flat(const Shape& s) { return is_any<DiskShape, RectShape>(s); }

// Solid angle by which a program divides lumens of a punctual light.
double flux_solid_angle(Dialect dialect, const StatedLight& stated) {
  if (const auto* frustum = std::get_if<FrustumShape>(&stated.shape)) return stated.form.reflector ? solid_angle_of(*frustum) : 4 * pi;
  const auto* spot = std::get_if<SpotShape>(&stated.shape);
  if (spot == nullptr) return 4 * pi;
  const double cone = solid_angle_of(*spot, FluxConvention::cone);
  switch (dialect) {
    case D::hdrp:
      return stated.form.reflector ? cone : 4 * pi;
    case D::filament:
      return stated.form.reflector ? cone : pi;
    case D::unreal:
      return cone;
    case D::pbrt: {
      // Over its smoothstep: 2 pi [(1 - cos i) + (cos i - cos o) / 2], as a mean of two caps.
      const double inner_cap = solid_angle_of(SpotShape{spot->inner_rad, spot->inner_rad}, FluxConvention::cone);
      return (inner_cap + cone) / 2;
    }
    case D::frostbite:
    case D::godot:
    case D::threejs:
      return pi;
    default:
      return 4 * pi;
  }
}

double projected_solid_angle(const DistantShape& distant) {
  const double sine = std::sin(distant.diameter_rad / 2);
  return pi * sine * sine;
}

Result<double> per_lumen(Dialect dialect, const StatedLight& stated) {
  if (is_punctual(stated.shape)) {
    const double solid_angle = flux_solid_angle(dialect, stated);
    if (solid_angle > 0) return 1 / solid_angle;
    return parameter_error("outer", "SIZE_MISSING", "lumens need an opening angle greater than zero");
  }
  if (std::holds_alternative<LineShape>(stated.shape)) return 1 / (4 * pi);  // HDRP's tube: the same cd in all directions
  const Result<double> area = area_of_stated(stated.shape);
  if (!area) return area.error();
  return 1 / (pi * *area * (dialect == D::pbrt && stated.two_sided && is_flat(stated.shape) ? 2 : 1));
}

Result<double> per_candela(const StatedLight& stated) {
  if (is_punctual(stated.shape)) return 1.0;
  // Unreal's lights with a size: L = I over the area seen along the axis.
  if (const auto* sphere = std::get_if<SphereShape>(&stated.shape)) return 1 / (pi * sphere->radius * sphere->radius);
  const Result<double> area = area_of_stated(stated.shape);
  if (!area) return area.error();
  return 1 / *area;
}

Result<double> per_usd_amount(const StatedLight& stated) {
  const DialectForm& form = stated.form;
  if (const auto* distant = std::get_if<DistantShape>(&stated.shape)) {
    const double projected = projected_solid_angle(*distant);
    if (form.normalize) return 1.0;
    if (projected > 0) return projected;  // E of a disc of 1 cd/m2
    return parameter_error("angular_diameter", "SIZE_MISSING", "a DistantLight without normalize needs an angle greater than zero");
  }
  if (std::holds_alternative<EnvironmentShape>(stated.shape)) return 1.0;
  const Result<double> metres = metres_per_unit(D::usd, stated.shape, form);
  if (!metres) return metres.error();
  const double stage_area_m2 = *metres * *metres;
  // A sphere of radius r with normalize has L = amount / (4 pi r^2), r in stage units, and I = pi r^2 L whatever r.
  if (std::holds_alternative<PointShape>(stated.shape)) {
    if (form.normalize) return stage_area_m2 / 4;
    return parameter_error("shape", "SIZE_MISSING",
                           "a SphereLight with treatAsPoint and without normalize needs its radius: make it a sphere");
  }
  const Result<double> area = area_of_stated(stated.shape);
  if (!area) return area.error();
  return form.normalize ? stage_area_m2 / *area : 1.0;
}

// Blender: W of points and spots over 4 pi, of area lights L = P / (4 A), so that they emit pi/4 of their watts.
Result<double> per_blender_amount(const StatedLight& stated) {
  if (is_any<DistantShape, EnvironmentShape>(stated.shape)) return 1.0;
  if (is_punctual(stated.shape)) return 1 / (4 * pi);
  const Result<double> area = area_of_stated(stated.shape);
  if (!area) return area.error();
  if (std::holds_alternative<SphereShape>(stated.shape)) return 1 / (pi * *area);  // a point light with a radius: I = P / 4 pi
  return 1 / (4 * *area);
}

}  // namespace

Emission::Given natural_quantity(const Shape& shape) {
  if (is_punctual(shape) || std::holds_alternative<LineShape>(shape)) return Emission::Given::intensity;
  return std::holds_alternative<DistantShape>(shape) ? Emission::Given::illuminance : Emission::Given::luminance;
}

Result<double> area_of_stated(const Shape& shape) {
  Light light;
  light.shape = shape;
  return emitting_area(light);
}

std::vector<std::string_view> units_of(Dialect dialect, const Shape& shape) {
  const bool point_or_spot = is_any<PointShape, SpotShape>(shape), distant = std::holds_alternative<DistantShape>(shape);
  const bool sphere = std::holds_alternative<SphereShape>(shape), rect = std::holds_alternative<RectShape>(shape), flat = is_flat(shape);
  const bool environment = std::holds_alternative<EnvironmentShape>(shape), tube = std::holds_alternative<TubeShape>(shape);
  switch (dialect) {
    case D::blender:
      if (point_or_spot || sphere || flat) return {"W"};
      if (distant) return {"W/m2"};
      if (environment) return {"W/m2/sr"};
      return {};
    case D::gltf_spec:
      if (point_or_spot) return {"cd"};
      if (distant) return {"lx"};
      return {};
    case D::gltf_compat:
      if (point_or_spot) return {"W/sr"};
      if (distant) return {"W/m2"};
      return {};
    case D::gltf_raw:
      if (point_or_spot) return {"W"};
      if (distant) return {"W/m2"};
      return {};
    case D::usd:
      if (std::holds_alternative<PointShape>(shape) || sphere || flat || tube || distant || environment) return {"nit"};
      return {};
    case D::hdrp:
      if (point_or_spot) return {"cd", "lm", "EV"};
      if (std::holds_alternative<FrustumShape>(shape)) return {"cd", "lm", "EV"};
      if (flat) return {"nit", "lm", "EV"};
      if (std::holds_alternative<LineShape>(shape)) return {"nit", "lm"};
      if (distant) return {"lx"};
      if (environment) return {"nit", "lx", "EV"};
      return {};
    case D::unreal:
      if (point_or_spot || sphere || rect) return {"cd", "lm", "unitless"};
      if (distant) return {"lx"};
      return {};
    case D::filament:
      if (point_or_spot) return {"cd", "lm"};
      if (distant) return {"lx"};
      return {};
    case D::frostbite:
      if (point_or_spot) return {"lm"};
      if (sphere || flat || tube) return {"lm", "nit", "EV"};
      if (distant) return {"lx"};
      if (environment) return {"nit"};
      return {};
    case D::godot:
      if (point_or_spot) return {"lm"};
      if (distant) return {"lx"};
      if (environment) return {"nit"};
      return {};
    case D::threejs:
      if (point_or_spot) return {"cd", "lm"};
      if (rect) return {"nit", "lm"};
      if (distant) return {"lx"};
      return {};
    case D::pbrt:
      if (point_or_spot) return {"cd", "lm"};
      if (sphere || flat) return {"nit", "lm"};
      if (distant) return {"lx"};
      if (environment) return {"nit", "lx"};
      return {};
    case D::vray:
      if (std::holds_alternative<PointShape>(shape)) return {"lm", "W"};
      if (sphere || flat) return {"nit", "lm", "W", "W/m2/sr"};
      return {};
  }
  return {};
}

Result<std::string> unit_of(Dialect dialect, const Shape& shape, std::string_view asked_for) {
  const DialectInfo& info = dialects()[static_cast<std::size_t>(dialect)];
  const std::vector<std::string_view> units = units_of(dialect, shape);
  if (units.empty())
    return parameter_error("shape", "DIALECT_HAS_NO_SUCH_LIGHT", fmt::format("{} has no {} light", info.program, name_of(shape)));
  if (asked_for.empty()) return std::string(units.front());
  if (std::find(units.begin(), units.end(), asked_for) != units.end()) return std::string(asked_for);
  return parameter_error("unit", "UNIT_UNSUITABLE",
                         fmt::format("{} states {} light in {}, not in \"{}\"", info.program, with_article(name_of(shape)),
                                     fmt::join(units, ", "), asked_for));
}

Result<double> natural_per_amount(Dialect dialect, const StatedLight& stated) {
  const std::string_view unit = stated.form.unit;
  switch (dialect) {
    case D::usd:
      return per_usd_amount(stated);
    case D::blender:
      return per_blender_amount(stated);
    case D::gltf_compat:
      return blender_lm_W;
    case D::gltf_raw:
      return blender_lm_W / (unit == "W" ? 4 * pi : 1);
    default:
      break;
  }
  if (unit == "lm") return per_lumen(dialect, stated);
  if (unit == "cd" || unit == "unitless") {
    Result<double> factor = per_candela(stated);
    if (!factor || unit == "cd") return factor;
    return *factor * 16 / (100 * 100);  // Unreal: 16 cm2 to the unit, 1 cd = 625
  }
  if (unit == "W" || unit == "W/m2/sr") {  // V-Ray
    if (unit == "W/m2/sr") return blender_lm_W;
    Result<double> factor = per_lumen(dialect, stated);
    if (!factor) return factor;
    return blender_lm_W * *factor;
  }
  if (unit == "lx" && std::holds_alternative<EnvironmentShape>(stated.shape)) return 1 / pi;
  if (const auto* line = std::get_if<LineShape>(&stated.shape)) return line->length;  // HDRP's "nits" are cd per metre
  return 1.0;                                                                         // nit, lx, EV
}

double linear_amount(const StatedLight& stated) {
  if (stated.form.unit == "EV") return luminance_of_ev100(stated.amount);
  return stated.amount * std::exp2(stated.form.exposure_stop);
}
double stated_amount(double linear, const DialectForm& form) {
  if (form.unit == "EV") return ev100_of_luminance(linear);
  return linear * std::exp2(-form.exposure_stop);
}

Result<double> metres_per_unit(Dialect dialect, const Shape& shape, const DialectForm& form) {
  if (dialect == D::unreal) return 0.01;
  if (dialect != D::usd || is_any<DistantShape, EnvironmentShape>(shape)) return 1.0;
  if (!form.metres_per_unit)
    return parameter_error(
        "metres_per_unit", "METRES_PER_UNIT_MISSING",
        "a USD light needs its stage's metersPerUnit: sizes are in stage units, and normalize divides by an area in them",
        "USD's default is .01, centimetres; a wrong one is a factor of 10000");
  if (*form.metres_per_unit > 0 && std::isfinite(*form.metres_per_unit)) return *form.metres_per_unit;
  return parameter_error("metres_per_unit", "NUMBER_INVALID",
                         fmt::format("expected metersPerUnit above 0 and finite, found {}", *form.metres_per_unit));
}

Shape scaled_shape(const Shape& shape, double factor) {
  Shape scaled = shape;
  if (auto* sphere = std::get_if<SphereShape>(&scaled)) sphere->radius *= factor;
  if (auto* disk = std::get_if<DiskShape>(&scaled)) disk->radius *= factor;
  if (auto* rect = std::get_if<RectShape>(&scaled)) rect->width *= factor, rect->height *= factor;
  if (auto* tube = std::get_if<TubeShape>(&scaled)) tube->length *= factor, tube->radius *= factor;
  if (auto* line = std::get_if<LineShape>(&scaled)) line->length *= factor;
  return scaled;
}

}  // namespace etendue
