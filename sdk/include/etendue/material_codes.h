// Disney parameters as textures store them, and the codes that come nearest to a diffuse albedo and an f0:
//   StoredFit fit = fit_codes({diffuse, f0}, {.bits = 8});
//   fit.codes.base_colour[0]    // 0 to 255, sRGB
// The best codes are not the rounded optimum: what rounding takes from one channel another can give back.
#pragma once

#include "etendue/material_fit.h"

#include <array>
#include <cstdint>

namespace etendue {

// What a texture holds of the dielectric part's f0: Frostbite's reflectance, f0 = .16 reflectance^2; the factor of KHR_materials_specular
// beside an ior of 7/3, whose f0 is .16, f0 = .16 factor; or nothing, f0 = .04.
enum class DielectricCode { reflectance, specular_factor, none };

// Whole numbers from 0 to 2^bits - 1 stand for 0 to 1; of the base colour for its sRGB encoding, of the others for themselves.
struct MaterialFormat {
  int bits = 8;  // held within 1 to 16
  DielectricCode dielectric = DielectricCode::reflectance;
};

struct MaterialCodes {
  std::array<std::uint16_t, 3> base_colour{};
  std::uint16_t metal = 0, dielectric = 0;
  friend bool operator==(const MaterialCodes&, const MaterialCodes&) = default;
};

DisneyColours decoded(const MaterialCodes& codes, const MaterialFormat& format);
// Each number on its own to its nearest code.
MaterialCodes rounded(const DisneyColours& colours, const MaterialFormat& format);

struct StoredFit {
  MaterialCodes codes;
  DisneyColours value;  // decoded
  double residual = 0;  // of value
};

// A part of [0, 1] within which the metal mask shall be.
struct MetalRange {
  double low = 0, high = 1;
};

// The codes with the least residual, never more than the rounded optimum's (of fit_disney, or in a range that leaves it out of
// fit_disney_at). Up to 8 bits no codes are better; with more, none whose metal mask is within 255 codes of the optimum's. Where no
// code is within the range, its middle's nearest is taken.
StoredFit fit_codes(const ColourPair& pair, const MaterialFormat& format = {}, MetalRange range = {});

}  // namespace etendue
