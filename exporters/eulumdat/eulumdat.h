// EULUMDAT (.ldt).
#pragma once

#include "exporters/photometry/options.h"

#include <memory>

namespace etendue {

// From EULUMDAT: everything as it is, to the last bit. From IES: intensities in cd/klm, each within 1 ulp times the number of factors; flux
// fractions computed, direct ratios written as 0, which is how files say that they are not known. Errors: WEB_INVALID; EXPORT_UNSUPPORTED
// for webs of type A and B.
Result<PhotometricText> write_eulumdat(const IntensityDistribution& distribution, const PhotometricWriteOptions& options = {});

// For a scene with one photometric light.
std::unique_ptr<Exporter> make_eulumdat_exporter();

}  // namespace etendue
