// IES LM-63, every year.
#pragma once

#include "exporters/photometry/options.h"

#include <memory>

namespace etendue {

// From an IES distribution: values, factors and angles as they are, to the last bit; only what the other version cannot say changes. From
// EULUMDAT: values as they are, its factors as the multiplier. Errors: WEB_INVALID.
Result<PhotometricText> write_ies(const IntensityDistribution& distribution, const PhotometricWriteOptions& options = {});

// For a scene with one photometric light.
std::unique_ptr<Exporter> make_ies_exporter();

}  // namespace etendue
