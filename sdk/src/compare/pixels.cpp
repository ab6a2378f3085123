#include "pixels.h"

#include <algorithm>
#include <cmath>

namespace etendue::compare_detail {

PixelStatistics pixel_statistics(const Evidence& e) {
  double chi2 = 0, noisy = 0, squares = 0, noise = 0, total = 0, count = 0;
  // Excess: sum w (D^2 - sigma^2) with weights w that are independent of the pixel's own noise. Both D^2 and sigma^2 are unbiased, so its
  // mean is 0 for noise of any distribution, unlike that of a sum of D^2 / sigma^2. The channels of one pixel share their noise: they are
  // summed first, and the spread of the pixels' sums is the standard error.
  double excess = 0, excess_squares = 0, weighted_ours2 = 0;
  for (std::size_t p = 0; p < e.pixels(); ++p) {
    if (e.emitter[p]) continue;
    double pixel_excess = 0;
    for (std::size_t i = 3 * p; i < 3 * p + 3; ++i) {
      const double d = e.difference(i), v = e.variance[i];
      // What is black in both measures nothing, whatever error it claims.
      if (!(v > 0) || (e.ours[i] == 0 && e.reference[i] == 0)) continue;
      chi2 += d * d / v;
      // E[D^2 / sigma^2] where a part f of sigma^2 is noise and the rest a bound, and a part b of f was measured by K seeds, ours being
      // known: f (1 + 2 b^2 / (K - 3)) to first order in 1/K, which with the factor below is 1 for b = 1 and f (K - 3)/(K - 1) for small b.
      const double f = std::max(0.0, 1 - e.bound[i] / v), b = e.scatter[i] / v;
      noisy += f * (1 + 2.0 / (e.seeds - 3) * b * b);
      squares += d * d;
      noise += v;
      total += e.reference[i];
      count += 1;
      if (!(e.around[i] > 0)) continue;
      const double w = 1 / e.around[i];
      pixel_excess += w * (d * d - v);
      weighted_ours2 += w * e.ours[i] * e.ours[i];
    }
    excess += pixel_excess;
    excess_squares += pixel_excess * pixel_excess;
  }
  PixelStatistics result;
  if (count == 0 || !(total > 0)) return result;
  const double mean = total / count, seeds = e.seeds;
  result.chi2_per_pixel = chi2 / count * (seeds - 3) / (seeds - 1);
  result.chi2_expected = noisy / count * (seeds - 3) / (seeds - 1);
  result.chi2_pixels = static_cast<std::uint64_t>(count / 3);
  result.rms_rel = std::sqrt(squares / count) / mean;
  result.noise_rms_rel = std::sqrt(noise / count) / mean;
  if (excess_squares > 0) result.excess_z = excess / std::sqrt(excess_squares);
  if (excess > 0 && weighted_ours2 > 0) result.excess_rel = std::sqrt(excess / weighted_ours2);
  return result;
}

}  // namespace etendue::compare_detail
