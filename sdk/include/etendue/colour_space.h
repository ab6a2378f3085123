// RGB colour spaces by their primaries, the matrices between them, and what becomes of the white point, which is always said:
//   Matrix3 to_acescg = *conversion(rec709, acescg, ChromaticAdaptation::bradford);
//   InSpace warm = *to_space(*planckian(2700), rec2020, {});     // as it is: a 2700 K lamp stays orange
//   InSpace white = *to_space(*planckian(2700), rec709, {ChromaticAdaptation::cat02, *planckian(2700)});   // for an eye adapted to it: (1,
//   1, 1)
#pragma once

#include "etendue/colour.h"
#include "etendue/result.h"
#include "etendue/vec.h"

#include <span>
#include <string_view>

namespace etendue {

// A 3x3 matrix by its columns.
struct Matrix3 {
  Vec3d a, b, c;
  friend constexpr Vec3d operator*(const Matrix3& m, const Vec3d& v) { return m.a * v.x + m.b * v.y + m.c * v.z; }
  friend constexpr Matrix3 operator*(const Matrix3& m, const Matrix3& n) { return {m * n.a, m * n.b, m * n.c}; }
};
constexpr Matrix3 transposed(const Matrix3& m) { return {{m.a.x, m.b.x, m.c.x}, {m.a.y, m.b.y, m.c.y}, {m.a.z, m.b.z, m.c.z}}; }
// Of a matrix with a determinant other than 0.
constexpr Matrix3 inverse(const Matrix3& m) {
  const Vec3d bc = cross(m.b, m.c), ca = cross(m.c, m.a), ab = cross(m.a, m.b);
  const double determinant = dot(m.a, bc);
  return transposed({bc / determinant, ca / determinant, ab / determinant});
}

// XYZ with Y = 1.
constexpr Vec3d to_xyz(const Chromaticity& xy) { return {xy.x / xy.y, 1, (1 - xy.x - xy.y) / xy.y}; }

// A linear RGB space; its transfer function is another matter (srgb.h).
struct ColourSpace {
  std::string_view name;
  Chromaticity red, green, blue, white;
  std::string_view source;
};
inline constexpr ColourSpace rec709{"rec709",     {0.64, 0.33},     {0.30, 0.60},
                                    {0.15, 0.06}, {0.3127, 0.3290}, "ITU-R BT.709-6; sRGB has the same"};
inline constexpr ColourSpace rec2020{"rec2020", {0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {0.3127, 0.3290}, "ITU-R BT.2020-2"};
inline constexpr ColourSpace p3_d65{"p3", {0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.3127, 0.3290}, "SMPTE EG 432-1, white D65"};
inline constexpr ColourSpace acescg{"acescg",       {0.713, 0.293},     {0.165, 0.830},
                                    {0.128, 0.044}, {0.32168, 0.33767}, "ACES S-2014-004, AP1; its white is near D60, not D60"};
std::span<const ColourSpace> colour_spaces();
// COLOUR_SPACE_UNKNOWN, with the nearest names.
Result<ColourSpace> colour_space(std::string_view name);

// Columns are the primaries, each scaled so that R = G = B = 1 is the white with Y = 1.
constexpr Matrix3 rgb_to_xyz(const ColourSpace& space) {
  const Matrix3 primaries{to_xyz(space.red), to_xyz(space.green), to_xyz(space.blue)};
  const Vec3d scale = inverse(primaries) * to_xyz(space.white);
  return {primaries.a * scale.x, primaries.b * scale.y, primaries.c * scale.z};
}
constexpr Matrix3 xyz_to_rgb(const ColourSpace& space) { return inverse(rgb_to_xyz(space)); }

// How an observer's adaptation to a white is accounted for: by scaling cone responses (or X, Y, Z) from one white's to the other's.
enum class ChromaticAdaptation {
  none,         // colours stay what they are; what was white before is tinted afterwards
  xyz_scaling,  // X, Y, Z themselves: "wrong von Kries", here because ICC's old profiles have it
  von_kries,    // Hunt-Pointer-Estevez cones, normalised to D65
  bradford,     // Lam 1985, linear as in ICC profiles: what OpenColorIO and most programs mean by an adaptation
  cat02,        // CIECAM02
  cat16,        // CAM16
};
std::string_view name_of(ChromaticAdaptation adaptation);
// ADAPTATION_UNKNOWN, with the nearest names.
Result<ChromaticAdaptation> adaptation_of(std::string_view name);

// XYZ seen under `from` to XYZ that looks the same under `to`. WHITE_POINT_INVALID for a white without luminance, or one that a cone does
// not respond to.
Result<Matrix3> adaptation_matrix(const Chromaticity& from, const Chromaticity& to, ChromaticAdaptation adaptation);
// Linear RGB of one space to that of another.
Result<Matrix3> conversion(const ColourSpace& from, const ColourSpace& to, ChromaticAdaptation adaptation);

// What linear RGB of a space is multiplied by so that a scene's white becomes the space's. WHITE_POINT_INVALID.
Result<Matrix3> white_balance(const Chromaticity& scene_white, const ColourSpace& space, ChromaticAdaptation adaptation);

// A colour in a space. Out of gamut: a channel is negative, and stays so; nothing is clipped.
struct InSpace {
  Rgb rgb;
  bool in_gamut;  // no channel below -1e-9 of the largest, which is rounding
};
InSpace in_space(const Rgb& rgb);

// To which white the observer is adapted before the space's own takes its place.
struct WhitePolicy {
  ChromaticAdaptation adaptation = ChromaticAdaptation::none;
  Chromaticity observer_white{};  // not looked at for `none`
};
// A chromaticity with Y = 1. Errors: CHROMATICITY_INVALID unless it is finite and y > 0; WHITE_POINT_INVALID.
Result<InSpace> to_space(const Chromaticity& xy, const ColourSpace& space, const WhitePolicy& white);

}  // namespace etendue
