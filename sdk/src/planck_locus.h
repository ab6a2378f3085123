// The Planckian locus as a curve over reciprocal temperature, with its derivatives.
#pragma once

#include "etendue/spectrum.h"
#include "etendue/vec.h"

namespace etendue {

// CIE 1931 2 degree colour-matching functions, 360 nm to 830 nm at 1 nm.
inline constexpr int first_nm = 360;
inline constexpr int wavelength_count = 471;
const Vec3d& colour_matching(int nm);

// CIE 1960 (u, v) of a Planckian radiator and its first two derivatives with respect to M = 1/T (1/K). M = 0 is the limit of infinite T.
struct LocusPoint {
  Vec2d uv, first, second;
};
LocusPoint planck_locus(double reciprocal_K);

}  // namespace etendue
