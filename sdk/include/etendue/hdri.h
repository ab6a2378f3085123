// Panoramas of the surroundings (latitude-longitude, linear Rec.709) become physical: pixels in cd/m2, the sun a light of its own.
//   auto factor = factor_for_illuminance(texels, size, {0, 1, 0}, 32000);   // a lux meter on the ground showed 32 klx
//   ...multiply...
//   auto sun = cut_sun(texels, size, 3 * pi / 180);                         // sun->light, and its place painted over
// Lagarde and de Rousiers, section 4.9.1.1.
#pragma once

#include "etendue/light.h"

#include <cstddef>
#include <span>

namespace etendue {

// Rows from the top, +Y; directions as for EnvironmentShape: u = 1/2 - atan2(x, z) / (2 pi), v = acos(y) / pi.
struct PanoramaSize {
  std::size_t width = 0, height = 0;
};
Vec3d direction_of_texel(const PanoramaSize& size, std::size_t column, std::size_t row);  // its middle
// 2 pi / width (cos theta0 - cos theta1), as a product of sines: right to a few ulp at the poles too.
double solid_angle_of_texel(const PanoramaSize& size, std::size_t row);

// Errors of all below: PANORAMA_INVALID (no texels, or as many as width x height does not say; a texel that is not finite, named by column
// and row), DIRECTION_INVALID (zero or not finite).

// Illuminance on a plane with this normal, in lx if texels are cd/m2; channels alike. Texels are taken as constant; those above the plane's
// horizon are integrated exactly, those on it in 8 x 8 parts.
Result<Rgb> illuminance_of_panorama(std::span<const Vec3f> texels, const PanoramaSize& size, const Vec3d& normal);
// Mean over a cone, weighted by solid angle: what a spot meter of that angle shows. A cone between middles of texels reads the texel hit.
Result<Rgb> luminance_of_panorama(std::span<const Vec3f> texels, const PanoramaSize& size, const Vec3d& direction, double radius_rad);

// What relative texels are to be multiplied by, from one measurement: what a lux meter with that normal, or a spot meter, showed.
// CALIBRATION_IMPOSSIBLE where the panorama is black there, or the measured value is not positive and finite.
Result<double> factor_for_illuminance(std::span<const Vec3f> texels, const PanoramaSize& size, const Vec3d& normal, double lux);
Result<double> factor_for_luminance(std::span<const Vec3f> texels, const PanoramaSize& size, const Vec3d& direction, double radius_rad,
                                    double cd_m2);

struct SunCut {
  Light light;                 // distant, of the Sun's mean diameter, by its illuminance; its colour is that of the light cut out
  Vec3d direction;             // towards it
  double illuminance_lx = 0;   // on a plane facing it
  std::size_t texels = 0;      // painted over
  std::size_t at_maximum = 0;  // of these, as bright as the brightest: several speak for a clipped sun, and too few lux
};
// Paints over all texels within `radius_rad` of the sun, with the mean of the ring around them up to 1.5 times as wide, and returns what
// was above it as a light. The sun is found from the brightest texel. Its direction and illuminance are the vector integral of what is cut
// out, so that panorama and light together give every plane that sees the whole of it the luminance-weighted illuminance of before.
// SUN_RADIUS_INVALID (no ring: it must be some texels wide, and less than 60 degrees), SUN_NOT_FOUND (nothing brighter than the ring).
Result<SunCut> cut_sun(std::span<Vec3f> texels, const PanoramaSize& size, double radius_rad);

}  // namespace etendue
