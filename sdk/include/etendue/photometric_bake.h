// Pictures of a web for programs that look intensities up in textures. Each layout says how a direction becomes a place in its pictures;
// between texels lies the bilinear interpolant, whose integral over all directions is the web's flux.
#pragma once

#include "etendue/intensity_web.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace etendue {

// u runs along a row from its first texel, v from the first row to the last, both 0 to 1. Directions (x, y, z) are unit vectors in the
// luminaire's frame (intensity_web.h). Texel (i, j) of W x H has its centre at u = (i + 1/2) / W, v = (j + 1/2) / H, but on a cube.
enum class BakeLayout {
  // u = azimuth / 360 deg about z from x towards y, repeated; v = (1 + z) / 2, held at the border. Every texel has the same solid angle.
  // Lagarde and de Rousiers 2014, Moving Frostbite to PBR, section 4.5, listing 5.
  profile,
  // The square of Clarberg 2008, Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD, with +z in its middle, as pbrt-v4 takes it; beyond
  // a
  // border lies its other half. Every texel has the same solid angle.
  octahedral,
  // u = C / 360 deg, repeated; v = gamma / 180 deg, held at the border.
  c_gamma,
  // Six pictures, one a face of a cube (cube_faces()): texels hold the illuminance (lx) that the web gives the face at a distance of 1 m,
  // I cos^3; the outermost centres lie on the face's edges, u = i / (W - 1). Nothing is interpolated beyond an edge.
  cube
};

// left x up = forward. A direction (x left + y up + forward) on the face, |x|, |y| <= 1, is at u = (1 - x) / 2, v = (1 - y) / 2.
struct CubeFace {
  Vec3d left, up, forward;
  const char* name;  // "nadir"
};
std::span<const CubeFace> cube_faces();  // nadir, zenith, C0, C90, C180, C270

// What stands before a luminaire: the share of the web's intensity that is left towards a unit vector, and the flux that is left. It may
// have one bend or edge between texels, as a table has.
struct WebShade {
  std::function<double(const Vec3d&)> share;
  double flux_lm = 0;
};

struct WebBake {
  BakeLayout layout = BakeLayout::profile;
  std::uint32_t width = 0, height = 0, pictures = 1;
  std::vector<float> values;  // cd; cube: lx. Picture by picture, row by row
  // lm of the interpolant: the web's, to a float's rounding (6e-8).
  double flux_lm = 0;
  // cd: at most so far from the web, in any direction. It is 4/3 of the largest deviation found a quarter of a texel apart, at the nodes of
  // the web's table, half-way between them and on both sides of its ends. Between two such places lies at most one bend or edge; a bend
  // h/4 apart from the next place on either side has its height there to 3/4.
  double error_cd = 0;

  // cd, as a program finds it that follows the layout.
  double towards(const Vec3d& direction) const;  // of any length but 0
  double flux_of_picture(std::uint32_t picture) const;
};

// Pictures of `size` rows; the layouts about an axis have twice as many columns, one if the web is rotational. Texels are samples of the
// web, all multiplied by one factor that brings the interpolant to the web's flux. Errors: BAKE_SIZE (2 to 8192), BAKE_TOO_COARSE (a beam
// lies between the texels).
Result<WebBake> bake(const IntensityWeb& web, BakeLayout layout, std::uint32_t size);

// The coarsest of sizes `fewest`, 2 `fewest`, ... `most` that is within `wanted_cd`. Where doubling gains less than a tenth, as at the
// bright end of a table, whose blur keeps its height at any size, or at `most`, the last one tried; its error says so. With a shade, of
// what it leaves.
Result<WebBake> bake_within(const IntensityWeb& web, BakeLayout layout, double wanted_cd, std::uint32_t fewest, std::uint32_t most,
                            const WebShade* shade = nullptr);

// The values as a mask of mean 1 over all directions (cube: divided by the web's mean intensity too): a lamp of `flux` lm, I = mask x
// flux / (4 pi), emits exactly its own flux. Frostbite's mask divides by the largest intensity instead, which loses flux / (4 pi mean).
std::vector<float> mask_of(const WebBake& bake);

}  // namespace etendue
