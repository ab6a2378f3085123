// A scene with one photometric light as a photometric file.
#pragma once

#include "exporters/photometry/options.h"

#include <filesystem>

namespace etendue::photometric {

using WritePhotometric = Result<PhotometricText>(const IntensityDistribution&, const PhotometricWriteOptions&);

// Errors: EXPORT_UNSUPPORTED where the scene has not one photometric light that was read; those of `write`.
Result<Exported> write_scene(const Scene& scene, const std::filesystem::path& file, WritePhotometric* write);

}  // namespace etendue::photometric
