// Disney parameters of a diffuse albedo and a normal-incidence reflectance, and back (Lagarde and de Rousiers, Moving Frostbite to PBR,
// appendix D; the derivation of the global optimum is in sdk/docs/materials.md):
//   DisneyFit fit = fit_disney({diffuse, f0});      // fit.value.base_colour, .metal, .reflectance; fit.residual
//   ColourPair pair = colour_pair_of(fit.value);    // the exact way back
// All colours are linear Rec.709. Five numbers cannot hold six, so a fit has a residual: the sum of the six squared differences of diffuse
// and f0. Its square root over 6, the rms, is what tolerances are about.
// Inputs are held within +-65504, the range of half floats, and NaN counts as 0: nothing that is not finite comes out.
#pragma once

#include "etendue/vec.h"

namespace etendue {

// Diffuse albedo and normal-incidence reflectance: what a TwoColour (material.h) says of a surface apart from its roughness.
struct ColourPair {
  Rgb diffuse, f0;
};

// Frostbite's standard parameters apart from its smoothness; all within [0, 1].
struct DisneyColours {
  Rgb base_colour{0.5, 0.5, 0.5};
  double metal = 0;
  double reflectance = 0.5;
};

// f0 of a dielectric = .16 reflectance^2: .04 at .5, at most .16.
inline constexpr double largest_dielectric_f0 = 0.16;

// diffuse = (1 - metal) base, f0 = .16 reflectance^2 (1 - metal) + metal base (equations D.1, D.2).
ColourPair colour_pair_of(const DisneyColours& colours);
// The sum of the six squared differences between colour_pair_of(colours) and the pair.
double squared_difference(const DisneyColours& colours, const ColourPair& pair);

// Whether the dielectric part's f0 is free within [0, .16], or .04 as in a reader that knows glTF's core alone (reflectance .5).
enum class DielectricF0 { free, core };

// Half a step of an 8-bit channel.
inline constexpr double half_8_bit_step = 1.0 / 510;

struct DisneyFit {
  DisneyColours value;
  double residual = 0;
  // The metal masks around value.metal with which, the other parameters chosen anew, the rms grows by no more than the tolerance. For grey
  // surfaces it is often all of [0, 1]: their metal mask is what the artist says it is.
  double metal_low = 0, metal_high = 1;
};

// The global optimum: no Disney parameters whatever have a smaller residual, but for rounding (1e-15 relative). Among equals metal 0 comes
// first, then 1, then reflectance .5. A permutation of the channels permutes the base colour and changes nothing else.
DisneyFit fit_disney(const ColourPair& pair, DielectricF0 dielectric = DielectricF0::free, double tolerance = half_8_bit_step);

// The best base colour and reflectance for a metal mask that is given, held within [0, 1]. Reflectance is .5 where it has no effect: at 1.
DisneyColours fit_disney_at(double metal, const ColourPair& pair, DielectricF0 dielectric = DielectricF0::free);

// Appendix D's own way: Levenberg and Marquardt's steps with the analytic Jacobian from `start`, the parameters held within [0, 1]. It ends
// in a valley near by, which need not be the deepest: compare its residual with fit_disney's.
struct LocalFit {
  DisneyColours value;
  double residual = 0;
  int steps = 0;  // taken or tried
};
LocalFit fit_disney_from(const DisneyColours& start, const ColourPair& pair);

}  // namespace etendue
