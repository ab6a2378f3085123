// Lights as authored: shape, emission in the unit it was given in, colour; and their resolution to what they emit.
#pragma once

#include "etendue/colour.h"
#include "etendue/image.h"
#include "etendue/result.h"
#include "etendue/units.h"
#include "etendue/vec.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace etendue {

// Every light emits along its own -Z (glTF). Lengths in metres, angles in radians.
struct PointShape {};
struct SpotShape {
  double inner_rad = 0, outer_rad = pi / 4;  // half angles, 0 <= inner <= outer <= pi/2
};
struct FrustumShape {
  double width_rad = 0, height_rad = 0;  // full angles, each < pi
};
struct DistantShape {
  double diameter_rad = 0;  // angular diameter; 0 is a true direction
};
struct SphereShape {
  double radius = 0;
};
struct DiskShape {
  double radius = 0;
};
struct RectShape {
  double width = 0, height = 0;  // along X and Y
};
struct PolygonShape {
  std::vector<Vec2d> points;  // simple, in the light's XY plane, any winding: it emits towards -Z
};
enum class Caps { round, flat, none };
struct TubeShape {
  double length = 0, radius = 0;  // between the centres of the caps, along X
  Caps caps = Caps::round;
};
struct LineShape {
  double length = 0;  // along X; I(theta) = flux sin(theta) / pi^2
};
struct MeshShape {
  std::uint32_t mesh = 0;  // index into Scene::meshes; emits on the counter-clockwise side
  Vec3d scale{1, 1, 1};    // applied before the light's transform, so that this stays rigid
};
struct IntensityDistribution;  // photometry.h
struct PhotometricShape {
  std::string file;           // .ies or .ldt; "" if embedded
  SharedBytes embedded = {};  // the text of such a file, inside an asset
  // What it says; null until somebody reads it (read_photometric_lights()).
  std::shared_ptr<const IntensityDistribution> distribution = {};
  // Of a spot with its profile: what multiplies the file's candelas, 1 inside and 0 outside. A stated flux is what passes it.
  std::optional<SpotShape> cone = {};
};
struct EnvironmentShape {
  // Index into Scene::images; none: constant. Latitude-longitude as in OpenEXR and Mitsuba: the direction (x, y, z) in the light's frame is
  // at u = 1/2 - atan2(x, z) / (2 pi), v = acos(y) / pi.
  std::optional<std::uint32_t> image;
  // Instead of `image`: the faces of a cube, +X -X +Y -Y +Z -Z in the light's frame (glTF's EXT_lights_image_based). Kept as a reference:
  // nothing here evaluates it yet.
  std::vector<std::uint32_t> cube = {};
};
using Shape = std::variant<PointShape, SpotShape, FrustumShape, DistantShape, SphereShape, DiskShape, RectShape, PolygonShape, TubeShape,
                           LineShape, MeshShape, PhotometricShape, EnvironmentShape>;
const char* name_of(const Shape& shape);  // the rig file's "type"

// What was given for the light's total or its density.
struct Emission {
  enum class Given { flux, intensity, luminance, illuminance, ev, as_file } given = Given::as_file;
  double value = 0;      // photometric or radiometric SI; EV100 for `ev`
  bool radiant = false;  // value is the radiometric twin: efficacy is then required
  std::optional<double> efficacy_lm_W{};
  std::optional<double> distance_m{};  // for `illuminance` of anything but a distant light
  // Multiplies the luminance of flat and mesh lights; the value is that of a white texture. v = 0 is the top row as seen from the side that
  // is emitted towards, +Y up: the viewer looks along +Z, its right is Z x Y = -X. Rect: u = 1/2 - x/width, v = 1/2 - y/height; disk: the
  // same with the diameter; polygon: its bounding rectangle; mesh: its uvs.
  std::optional<Texture> texture{};
};

struct RgbColour {
  Rgb rgb{1, 1, 1};
};
struct TemperatureColour {
  double kelvin = 6500;
};
struct DaylightColour {
  double kelvin = 6504;
};
// Chromaticity alone: scaled to Y = 1 when the light is resolved.
using LightColour = std::variant<RgbColour, TemperatureColour, DaylightColour>;

// What multiplies 1/d^2 with the distance d, and the radiance of area lights by the distance of each of their points: w of x = d / range, 0
// from the range on. None of them sends more than the light without it but `scale_bias`.
struct Falloff {
  enum class Law {
    inverse_square,  // 1
    power,           // 1 - x^n              Lagarde and de Rousiers 2014, eq 22 (n = 1) and 23 (n = 20); KHR_lights_punctual (n = 4)
    power_squared,   // (1 - x^n)^2          their eq 26, n = 4 in Frostbite
    smoothstep,      // 1 - x^2 (3 - 2 x)    their figure 25, window 3
    // (1/d^2 - t) / (1 - t), t = 1/range^2 with lengths in metres (their eq 24, 25): w = (1 - x^2) / (1 - t), 1 at 1 m, more than 1 before
    // it. The range has to be above 1 m.
    scale_bias,
    // (1 - x^4)^2 / (d^2 + 1 m^2)           Karis 2013, eq 9, which Eden takes: w = (1 - x^4)^2 d^2 / (d^2 + 1 m^2). Without a range
    // 1 / (d^2 + 1 m^2) alone.
    karis
  } law = Law::inverse_square;
  double exponent = 4;  // n of both powers, 1 to 64

  static constexpr double least_exponent = 1, most_exponent = 64;
  static const Falloff inverse_square, linear, gltf, frostbite, smoothstep, scale_bias, karis;
  bool operator==(const Falloff&) const = default;
};
inline constexpr Falloff Falloff::inverse_square{};
inline constexpr Falloff Falloff::linear{Law::power, 1};  // Eden's
inline constexpr Falloff Falloff::gltf{Law::power, 4};
inline constexpr Falloff Falloff::frostbite{Law::power_squared, 4};
inline constexpr Falloff Falloff::smoothstep{Law::smoothstep};
inline constexpr Falloff Falloff::scale_bias{Law::scale_bias};
inline constexpr Falloff Falloff::karis{Law::karis};
const char* name_of(const Falloff& falloff);  // the rig file's "falloff"

// How the flux of a spot becomes intensity (CLI.md, --spot-flux).
enum class FluxConvention { falloff, cone, frostbite_pi, isotropic };

struct Light {
  std::string name;
  Shape shape;
  Emission emission;
  LightColour colour;
  Rgb filter{1, 1, 1};
  bool two_sided = false;
  bool visible = true;  // the camera sees an area light, and it occludes
  std::optional<double> range_m;
  Falloff falloff;
  FluxConvention flux_convention = FluxConvention::falloff;
  Transform transform;  // rigid
  // A mesh light that is also a surface (glTF's emissive materials): index into Scene::materials of what it reflects; none: black.
  // There is no Object beside it. Front and texture coordinates are those of the mesh.
  std::optional<std::uint32_t> surface_material;
  std::string source;  // where it came from: "/extensions/KHR_lights_punctual/lights/0"
};

// What the light sends out once units, colour and filter are applied, as linear Rec.709 whose Y is photometric.
struct Resolved {
  enum class Kind {
    intensity,    // cd, on the axis (point, spot), along the normal direction (frustum: anywhere inside)
    luminance,    // cd/m2 at the surface, or of the sky; a sun disk's too
    illuminance,  // lx on a plane facing a true direction
    line          // cd, perpendicular to a line light
  } kind = Kind::luminance;
  Rgb rgb;
  double flux_lm = 0;  // total, Y of it; infinite never: 0 where a total makes no sense (distant, environment)
  double area_m2 = 0;  // emitting area, both sides if two-sided; 0 for punctual lights
};

// Area of one side of a shape (mesh lights: `mesh_area` of the scaled mesh), steradians of a spot's or frustum's emission for its axial
// intensity.
// Errors: UNIT_UNSUITABLE (no surface), SIZE_MISSING.
Result<double> emitting_area(const Light& light, double mesh_area_m2 = 0);
double solid_angle_of(const SpotShape& spot, FluxConvention convention);
double solid_angle_of(const FrustumShape& frustum);

// Whether `two_sided` doubles the emitting area: planar and mesh lights alone. The inside of a sphere or a tube is never seen.
bool emits_both_sides(const Light& light);

// Units to what is emitted. Missing information is an error that names it: SIZE_MISSING, DISTANCE_MISSING, EFFICACY_MISSING,
// UNIT_UNSUITABLE, EMISSION_MISSING, NUMBER_INVALID, COLOUR_INVALID, TEMPERATURE_OUT_OF_RANGE. `intensity` is the one along the light's
// axis, of tubes and lines perpendicular to theirs. `illuminance` is at `distance_m` from the light's origin along that direction, on a
// plane facing it, exact for every shape, without the distance window; meshes have neither. `mesh_area_m2` is needed for mesh lights in
// lumens. Environment with `as_file`: rgb is the factor on the file's cd/m2; with an image and a value: rgb is the mean over the sphere
// that the image is to be scaled to. Photometric: rgb is the factor on the file's candelas, flux_lm the total that it is to be scaled to
// (0: the file's own).
Result<Resolved> resolve(const Light& light, double mesh_area_m2 = 0);

// The colour alone: linear Rec.709 with Y = 1.
Result<Rgb> rgb_of(const LightColour& colour);

}  // namespace etendue
