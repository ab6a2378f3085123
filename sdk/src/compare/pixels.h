// Whether single pixels differ by more than the noise, however the regions' means agree.
#pragma once

#include "evidence.h"

namespace etendue::compare_detail {

struct PixelStatistics {
  double chi2_per_pixel = 0;  // facts: mean of (difference / sigma)^2, (K-3)/(K-1) of it; noise alone gives 1
  double chi2_expected = 0;   // what it is where sigma is partly a bound and no noise (Evidence::bound)
  std::uint64_t chi2_pixels = 0;
  double rms_rel = 0, noise_rms_rel = 0;
  double excess_rel = 0, excess_z = 0;
};

PixelStatistics pixel_statistics(const Evidence& evidence);

}  // namespace etendue::compare_detail
