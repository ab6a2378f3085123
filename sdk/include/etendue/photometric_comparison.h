// Two intensity distributions beside each other.
#pragma once

#include "etendue/intensity_web.h"

namespace etendue {

// Differences are the second's intensity less the first's, over all directions of the frame that both share.
struct WebDifference {
  double largest_cd = 0;            // by size; signed
  double c_deg = 0, gamma_deg = 0;  // where
  bool exact = false;               // of two linear webs of type C it is the largest there is: their difference is bilinear between both
                                    // tables' angles. Else the largest at those and at every half degree
  double mean_cd = 0, mean_abs_cd = 0, rms_cd = 0;  // over the sphere, to about 1e-4 of themselves
  double flux_lm = 0;
};
WebDifference difference(const IntensityWeb& first, const IntensityWeb& second);

}  // namespace etendue
