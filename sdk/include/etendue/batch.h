// Many values at once, in float, on the best instruction set that the machine has:
//   std::vector<float> ev = ..., nit(ev.size());
//   auto done = luminance_of_ev100(ev, *calibration("frostbite"), nit);
// The double functions of the same names are the definition; each batch states how far it may be from them for the same (float) input.
// Nothing is lost silently: an element outside a function's domain becomes `where_none`, and the number of these is returned. Output spans
// hold as many elements as their inputs, else BATCH_SIZES_DIFFER. An output may be its input where the types are the same.
#pragma once

#include "etendue/camera.h"
#include "etendue/colour.h"
#include "etendue/result.h"
#include "etendue/vec.h"

#include <cstddef>
#include <span>

namespace etendue {

// Elements without a result.
using BatchOutcome = Result<std::size_t>;

// out = in x factor: conversions that are a factor, lumens of a point light to candelas among them. At most 1 ulp from the exact
// product; what is too large for a float becomes the largest.
Status scaled(std::span<const float> in, double factor, std::span<float> out);

// Both with a calibration whose K is positive and finite, else CALIBRATION_INVALID.
// L = 2^EV K/100. Within 3e-7 EV (a relative 2e-7) for L from the smallest normal float to the largest; EV below and above count as the
// ends, to 1e-4 EV. NaN is outside the domain.
BatchOutcome luminance_of_ev100(std::span<const float> ev100, const Calibration& calibration, std::span<float> luminance_cd_m2,
                                float where_none);
// EV = log2(L) - log2(K/100) of positive finite L. Within 2e-7 EV and half an ulp of the result: 7e-7 EV where |EV| < 16.
BatchOutcome ev100_of_luminance(std::span<const float> luminance_cd_m2, const Calibration& calibration, std::span<float> ev100,
                                float where_none);

// Chromaticity of Planckian radiators of 800 K to 100000 K and of infinite temperature, within 6e-7 in (u', v').
BatchOutcome planckian(std::span<const float> temperature_K, std::span<Vec2f> xy, Vec2f where_none);
// Their linear Rec.709, luminance_of = 1, negative channels kept (as to_rgb): within 6e-6 of the largest channel, 8e-7 in (u', v').
BatchOutcome planckian_rgb(std::span<const float> temperature_K, std::span<Vec3f> rgb, Vec3f where_none);

// Correlated colour temperature and Duv, on the domain of the double function: within .0001 K for 1000 K to 40000 K and |Duv| <= .02, a
// relative 3e-8 for 500 K to 100000 K and |Duv| <= .05; Duv within 1e-11.
BatchOutcome to_colour_temperature(std::span<const Chromaticity> xy, std::span<ColourTemperature> temperature,
                                   ColourTemperature where_none);
// Correlated colour temperature alone, quickly and roughly: within .32 % for 1000 K to 40000 K and |Duv| <= .02. Further out it gets worse,
// up to a quarter, until it is refused, somewhere between |Duv| = .02 and .05.
BatchOutcome fit_colour_temperature(std::span<const Vec2f> xy, std::span<float> temperature_K, float where_none);

// IEC 61966-2-1, the transfer functions of srgb.h: a relative 7e-7 for what is no larger than 65504, absolutely 2.5e-7 up to 1.
// Below 0 the straight part goes on. NaN stays NaN.
Status srgb_to_linear(std::span<const float> encoded, std::span<float> linear);
Status linear_to_srgb(std::span<const float> linear, std::span<float> encoded);

}  // namespace etendue
