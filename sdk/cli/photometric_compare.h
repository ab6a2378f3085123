// etendue ies --compare: two photometric files beside each other.
#pragma once

#include "photometric_file.h"

namespace etendue::cli {

// Figures of both, and their difference: for people, and as JSON.
std::string comparison_of(const PhotometricReading& first, const PhotometricReading& second);
Json comparison_json(const PhotometricReading& first, const PhotometricReading& second);

}  // namespace etendue::cli
