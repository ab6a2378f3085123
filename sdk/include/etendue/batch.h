// Many values at once, in float, on the best instruction set that the machine has:
//   std::vector<float> ev = ..., nit(ev.size());
//   auto done = luminance_of_ev100(ev, *calibration("frostbite"), nit);
// The double functions of the same names are the definition; each batch states how far it may be from them for the same (float) input.
// Nothing is lost silently: an element outside a function's domain becomes `where_none`, and the number of these is returned. Output spans
// hold as many elements as their inputs, else BATCH_SIZES_DIFFER. An output may be its input where the types are the same.
#pragma once

#include "etendue/camera.h"
#include "etendue/result.h"

#include <cstddef>
#include <span>

namespace etendue {

// Elements without a result.
using BatchOutcome = Result<std::size_t>;

// out = in x factor: conversions that are a factor, lumens of a point light to candelas among them. At most 1 ulp from the exact
// product; what is too large for a float becomes the largest.
Status scaled(std::span<const float> in, double factor, std::span<float> out);

// L = 2^EV K/100. Within 5e-7 EV (a relative 3.5e-7) for L from the smallest normal float to the largest; EV below and above count as the
// ends. NaN is outside the domain.
BatchOutcome luminance_of_ev100(std::span<const float> ev100, const Calibration& calibration, std::span<float> luminance_cd_m2,
                                float where_none);
// EV = log2(L) - log2(K/100) of positive finite L. Within 2e-7 EV and half an ulp of the result: 7e-7 EV where |EV| < 16.
BatchOutcome ev100_of_luminance(std::span<const float> luminance_cd_m2, const Calibration& calibration, std::span<float> ev100,
                                float where_none);

}  // namespace etendue
