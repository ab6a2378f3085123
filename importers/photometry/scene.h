// A photometric file as a scene: one light at the origin.
#pragma once

#include "etendue/io.h"
#include "importers/photometry/options.h"

#include <span>

namespace etendue::photometric {

using ReadPhotometric = Result<PhotometricFile>(std::span<const std::byte>, const std::string& file, const PhotometricOptions&);

Result<Imported> read_scene(const std::filesystem::path& file, const ImportOptions& options, const char* format, ReadPhotometric* read);

// Reads the file that TILT names, if it is a plain name beside `file`.
PhotometricOptions with_neighbours(PhotometricOptions options, const std::filesystem::path& file, std::uint64_t max_bytes);

}  // namespace etendue::photometric
