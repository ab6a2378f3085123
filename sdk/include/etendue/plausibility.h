// Whether the colours of a surface can be those of a real one: what texture artists' charts say, as numbers.
//   const Doubts doubts = doubts_of(described(Standard{{0.9, 0.9, 0.9}, 0, 0.5}));   // has(Doubt::bright_albedo)
#pragma once

#include "etendue/material.h"
#include "etendue/material_fit.h"
#include "etendue/vec.h"

#include <array>
#include <optional>
#include <string_view>

namespace etendue {

// What a surface model comes to at one point, all linear.
struct SurfaceColours {
  ColourPair pair;
  // Nothing for models that do not say (two colours): it is then what Disney parameters could make of them.
  std::optional<double> metal;
  bool mirrors = true;  // false: there is no specular lobe, and no f0 to be judged
};
// Of each model with its parameters resolved; Conductor by its reflectance at normal incidence.
SurfaceColours described(const SurfaceModel& model);

// Colours are judged by their largest channel (a saturated red is no dark grey), energy by each.
struct PlausibleRanges {
  // Albedo of dielectrics: sRGB 30 and 240 (McDermott, The PBR Guide, vol. 2, Allegorithmic 2018); coal has .04, fresh snow .7 to .9.
  double albedo_least = 0.013, albedo_greatest = 0.871;
  // f0 of dielectrics: below water (n = 1.333) is micro-occlusion (Lagarde and de Rousiers 2014, 3.2.1), above diamond (n = 2.42) nothing.
  double f0_least = 0.02, f0_greatest = 0.172;
  // f0 of metals: sRGB 180 (McDermott 2018); titanium and chromium have .55.
  double metal_f0_least = 0.456;
  // Metal masks between these are neither: right where a texel covers both, wrong all over.
  double dielectric_mask = 0.05, metal_mask = 0.95;
};

// Worst first. The last two occur on real surfaces: at edges between metal and paint, and in cavities.
enum class Doubt { gains_energy, bright_albedo, dark_albedo, dim_metal, high_f0, half_metal, low_f0 };
inline constexpr std::array<Doubt, 7> all_doubts{Doubt::gains_energy, Doubt::bright_albedo, Doubt::dark_albedo, Doubt::dim_metal,
                                                 Doubt::high_f0,      Doubt::half_metal,    Doubt::low_f0};
struct DoubtInfo {
  std::string_view name;     // "gains_energy"
  std::string_view meaning;  // "albedo and f0 sum up to more than 1"
  Rgb colour;                // of a view, linear
};
const DoubtInfo& info_of(Doubt doubt);

class Doubts {
 public:
  bool has(Doubt doubt) const { return (bits_ >> static_cast<unsigned>(doubt) & 1u) != 0; }
  bool none() const { return bits_ == 0; }
  void add(Doubt doubt) { bits_ |= 1u << static_cast<unsigned>(doubt); }
  std::optional<Doubt> worst() const;

 private:
  unsigned bits_ = 0;
};
// A metal has no albedo to be judged, a dielectric no metal's f0; half a metal has energy alone. Two colours are a metal or a dielectric if
// they can be one within half an 8-bit step (DisneyFit::metal_low, metal_high).
Doubts doubts_of(const SurfaceColours& colours, const PlausibleRanges& ranges = {});

}  // namespace etendue
